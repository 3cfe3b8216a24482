import numpy as np
import pytest
import torch
from torch import Tensor

from neurons.layers.afferents import Afferents
from neurons.layers.readout import ChartActivity

CHARTS, CELLS, VIEWS = 30, 7, 400


def activity(excited: ChartActivity) -> np.ndarray:
    """Chart activity as a dense matrix, views × charts."""
    dense = np.zeros((len(excited.chart), CHARTS))
    np.put_along_axis(dense, excited.chart.numpy(), excited.weight.double().numpy(), axis=1)
    return dense


@pytest.fixture
def excited() -> ChartActivity:
    generator = torch.Generator().manual_seed(0)
    chart = torch.rand(VIEWS, CHARTS - 1, generator=generator).topk(4, dim=1).indices
    return ChartActivity(chart, torch.rand(VIEWS, 4, generator=generator).softmax(dim=1))


@pytest.fixture
def rates() -> Tensor:
    return 20 * torch.rand(VIEWS, CELLS, generator=torch.Generator().manual_seed(1))


def test_weights_are_mean_rates_weighted_by_activity(excited: ChartActivity, rates: Tensor) -> None:
    afferents = Afferents(CHARTS, CELLS)
    afferents.partial_fit(excited, rates)
    dense = activity(excited)[:, :-1]
    trusted = [np.average(rates.numpy(), axis=0, weights=column) for column in dense.T]
    np.testing.assert_allclose(afferents.weights[:-1], trusted, rtol=1e-4)
    assert not afferents.weights[-1].any()


def test_halves_add_up(excited: ChartActivity, rates: Tensor) -> None:
    whole, parts = Afferents(CHARTS, CELLS), Afferents(CHARTS, CELLS)
    whole.partial_fit(excited, rates)
    for half in (slice(0, 150), slice(150, None)):
        parts.partial_fit(ChartActivity(excited.chart[half], excited.weight[half]), rates[half])
    torch.testing.assert_close(parts.weights, whole.weights)
    torch.testing.assert_close(parts.activity, whole.activity)


def test_rates_are_activity_times_weights(excited: ChartActivity, rates: Tensor) -> None:
    afferents = Afferents(CHARTS, CELLS)
    afferents.partial_fit(excited, rates)
    trusted = activity(excited) @ afferents.weights.double().numpy()
    np.testing.assert_allclose(afferents(excited), trusted, rtol=1e-4)


def test_before_learning_silent(excited: ChartActivity) -> None:
    assert not Afferents(CHARTS, CELLS)(excited).any()
