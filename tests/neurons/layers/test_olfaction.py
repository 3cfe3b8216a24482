import numpy as np
import pytest
import torch
from sklearn.linear_model import Ridge
from torch import Tensor

from neurons.layers.olfaction import Olfaction

CHARTS, ODORANTS, VIEWS = 6, 5, 900
Batch = tuple[Tensor, Tensor, Tensor, Tensor]


@pytest.fixture
def truth() -> tuple[Tensor, Tensor]:
    generator = torch.Generator().manual_seed(0)
    intercepts = torch.randn(CHARTS, ODORANTS, generator=generator)
    return intercepts, torch.randn(CHARTS, 3, ODORANTS, generator=generator)


@pytest.fixture
def batch(truth: tuple[Tensor, Tensor]) -> Batch:
    """Each view excites one of the first five charts, whose affine map is its odour exactly."""
    generator = torch.Generator().manual_seed(1)
    chart = torch.randint(CHARTS - 1, (VIEWS, 1), generator=generator)
    weight = torch.rand(VIEWS, 1, generator=generator) + 0.1
    coordinates = 0.3 * torch.randn(VIEWS, 1, 3, generator=generator) + torch.tensor([0.1, 0.0, -0.05])
    intercepts, jacobians = (part[chart[:, 0]] for part in truth)
    return chart, weight, coordinates, intercepts + torch.einsum("nwd,ndo->no", coordinates, jacobians)


def smelt(*batches: Batch, **prior: float) -> Olfaction:
    layer = Olfaction(CHARTS, ODORANTS, 3, **prior)
    for each in batches:
        layer.partial_fit(*each)
    return layer


def test_recovers_an_affine_map(batch: Batch, truth: tuple[Tensor, Tensor]) -> None:
    layer = smelt(batch)
    intercepts, jacobians = layer.solve()
    bias = 2 * layer.ridge * truth[1].abs().max().item()
    torch.testing.assert_close(intercepts[:-1], truth[0][:-1], atol=bias, rtol=0)
    torch.testing.assert_close(jacobians[:-1], truth[1][:-1], atol=bias, rtol=0)


@pytest.mark.parametrize("ridge", [1e-3, 1.0])
def test_same_as_ridge_regression(batch: Batch, ridge: float) -> None:
    chart, weight, coordinates, clean = batch
    odour = clean + 0.2 * torch.randn(clean.shape, generator=torch.Generator().manual_seed(2))
    intercepts, jacobians = smelt((chart, weight, coordinates, odour), ridge=ridge).solve()
    for k in range(CHARTS - 1):
        mine = (chart == k).flatten().numpy()
        x, y = coordinates[mine, 0].double().numpy(), odour[mine].double().numpy()
        w = weight[mine, 0].double().numpy()
        penalty = ridge * np.mean(w @ x**2)
        trusted = Ridge(alpha=penalty).fit(x, y, sample_weight=w)
        np.testing.assert_allclose(intercepts[k], trusted.intercept_, atol=1e-5)
        np.testing.assert_allclose(jacobians[k].T, trusted.coef_, atol=1e-4)


def test_a_view_tells_every_chart_it_excites(batch: Batch) -> None:
    chart, weight, coordinates, odour = batch
    other = (chart + 1) % CHARTS
    wide = smelt(
        (
            torch.cat([chart, other], dim=1),
            torch.cat([weight, 2 * weight], dim=1),
            torch.cat([coordinates, -coordinates], dim=1),
            odour,
        )
    )
    apart = smelt(batch, (other, 2 * weight, -coordinates, odour))
    torch.testing.assert_close(wide.gram, apart.gram)
    torch.testing.assert_close(wide.cross, apart.cross)


def test_sums_that_are_taken_along_are_those_of_views_in_other_coordinates(batch: Batch) -> None:
    chart, weight, coordinates, odour = batch
    change = torch.eye(4, dtype=torch.double).repeat(CHARTS, 1, 1)
    change += 0.2 * torch.randn(CHARTS, 4, 4, generator=torch.Generator().manual_seed(3))
    change[:, 0] = torch.tensor([1.0, 0.0, 0.0, 0.0])  # what is 1 stays 1
    f = torch.cat([torch.ones(VIEWS, 1, 1), coordinates], dim=2)
    other = torch.einsum("nij,nwj->nwi", change[chart[:, 0]].float(), f)[:, :, 1:]
    layer, moved = smelt(batch), smelt((chart, weight, other, odour))
    layer.carry(change)
    torch.testing.assert_close(layer.gram, moved.gram, rtol=1e-4, atol=1e-4)
    torch.testing.assert_close(layer.cross, moved.cross, rtol=1e-4, atol=1e-4)


def test_halves_add_up(batch: Batch) -> None:
    whole = smelt(batch)
    first, second = (smelt(half) for half in zip(*(part.split(VIEWS // 2) for part in batch), strict=True))
    first.gram += second.gram
    first.cross += second.cross
    for mine, all_of_it in zip(first.solve(), whole.solve(), strict=True):
        torch.testing.assert_close(mine, all_of_it, atol=1e-5, rtol=1e-5)


def test_chart_never_excited_smells_of_nothing(batch: Batch) -> None:
    intercepts, jacobians = smelt(batch).solve()
    assert intercepts.isfinite().all()
    assert jacobians.isfinite().all()
    assert not intercepts[-1].any()
    assert not jacobians[-1].any()
