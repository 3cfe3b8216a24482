import numpy as np
import pytest
import torch
from scipy.stats import vonmises
from torch import Tensor

from neurons.layers.heading_cells import HeadDirectionCells


def blank(cells: int, seed: int = 0, **tuning: float) -> HeadDirectionCells:
    return HeadDirectionCells(cells, 1, generator=torch.Generator().manual_seed(seed), **tuning)


def headings(count: int, seed: int = 1) -> Tensor:
    return 2 * torch.pi * torch.rand(count, generator=torch.Generator().manual_seed(seed)) - torch.pi


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_directions_end_up_evenly_spaced(seed: int) -> None:
    layer = blank(24, seed)
    for epoch in range(20):
        for batch in headings(2000, epoch).split(100):
            layer.compete(batch, window=2000.0)
    gaps = np.diff(np.sort(layer.preferred), append=layer.preferred.min() + 2 * np.pi)
    assert gaps.max() < 1.8 * 2 * np.pi / 24
    assert gaps.std() < 0.5 * gaps.mean()


@pytest.mark.parametrize(("concentration", "peak"), [(5.0, 20.0), (2.0, 7.0)])
def test_tuning_same_as_scipys_von_mises(concentration: float, peak: float) -> None:
    layer, probes = blank(10, concentration=concentration, peak=peak), headings(200)
    for unit, preferred in enumerate(layer.preferred.tolist()):
        bell = vonmises(concentration, loc=preferred)
        trusted = peak * bell.pdf(probes) / bell.pdf(preferred)
        np.testing.assert_allclose(layer.tuning(probes)[:, unit], trusted, atol=1e-3)
    torch.testing.assert_close(layer.tuning(layer.preferred).diagonal(), torch.full((10,), peak))


@pytest.mark.parametrize("concentration", [5.0, 1000.0])
def test_shares_are_rates_over_their_sum_however_narrow_the_tuning(concentration: float) -> None:
    layer, probes = blank(10, concentration=concentration), headings(200)
    shares = layer.share(probes)
    torch.testing.assert_close(shares.sum(dim=1), torch.ones(200))
    rates = layer.tuning(probes).double()
    felt = rates.sum(dim=1) > 1e-20
    trusted = rates[felt] / rates[felt].sum(dim=1, keepdim=True)
    torch.testing.assert_close(shares[felt].double(), trusted, atol=1e-4, rtol=1e-3)


def test_width_at_half_height() -> None:
    layer = blank(1)
    half = layer.preferred + torch.deg2rad(torch.tensor([61.0])) / 2
    assert layer.tuning(half).item() == pytest.approx(layer.peak / 2, rel=0.01)


def test_whole_turns_do_not_matter() -> None:
    layer, probes = blank(10), headings(50)
    torch.testing.assert_close(layer.tuning(probes + 4 * torch.pi), layer.tuning(probes), atol=1e-3, rtol=0)
    once, turned = blank(10), blank(10)
    once.compete(probes, window=100.0)
    turned.compete(probes + 2 * torch.pi, window=100.0)
    torch.testing.assert_close(turned.preferred, once.preferred, atol=1e-4, rtol=0)


def test_unit_behind_follows_across_the_cut() -> None:
    layer = blank(1)
    layer.preferred = torch.tensor([3.1])
    layer.compete(torch.full((50,), -3.1), window=1e9)
    assert layer.preferred.item() == pytest.approx(-3.1, abs=1e-4)


@pytest.mark.parametrize("window", [100.0, 200.0])
def test_the_window_is_a_number_of_views(window: float) -> None:
    first, second = (0.2 * headings(200)).split(100)
    layer = blank(1)
    layer.preferred = torch.zeros(1)
    layer.compete(first, window=window)
    layer.compete(second, window=window)
    kept = 1 - 100 / window
    trusted = (kept * first + second).mean() / (1 + kept)
    assert layer.preferred.item() == pytest.approx(trusted.item(), abs=1e-5)


@pytest.mark.parametrize(("setting", "learnt"), [({}, [3, 4, 5]), ({"winners": 2}, [3, 4])])
def test_only_the_nearest_units_learn(setting: dict[str, int], learnt: list[int]) -> None:
    layer = blank(8)
    layer.preferred = torch.linspace(-3, 3, 8)
    before = layer.preferred.clone()
    layer.compete(torch.tensor([0.1]), window=100.0, **setting)
    moved = ((layer.preferred - before).abs() > 1e-4).nonzero().flatten().tolist()
    assert moved == learnt


def test_same_generator_same_bits() -> None:
    first, again, other = blank(12), blank(12), blank(12, 5)
    for layer in (first, again, other):
        layer.compete(headings(100), window=100.0)
    assert torch.equal(first.preferred, again.preferred)
    assert not torch.equal(first.preferred, other.preferred)
