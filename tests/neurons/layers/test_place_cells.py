import numpy as np
import pytest
import torch
from scipy.stats import multivariate_normal
from torch import Tensor

from neurons.layers.place_cells import BLOCK, PlaceCells


def smells(count: int, stretch: tuple[float, float] = (1.0, 1.0), seed: int = 0) -> Tensor:
    uniform = torch.rand(count, 2, generator=torch.Generator().manual_seed(seed))
    return uniform * torch.tensor(stretch)


def grown(cells: int, odours: Tensor, *, epochs: int = 4, **settings: float) -> PlaceCells:
    layer = PlaceCells(cells, 1, odours.shape[1], **settings)
    for _ in range(epochs):
        for batch in odours.split(200):
            layer.compete(batch, window=float(len(odours)))
    return layer


def test_units_spread_over_the_smells() -> None:
    odours = smells(3000)
    layer = grown(60, odours)
    nearest = torch.cdist(odours, layer.centres).min(dim=1).values
    pitch = (1 / 60) ** 0.5
    assert nearest.median() < 0.6 * pitch
    assert nearest.max() < 2.2 * pitch


def test_centres_spread_evenly() -> None:
    """Distance to the nearest centre over that of as many random points: 1 at random, 2 at most."""
    centres = grown(100, smells(4000)).centres
    apart = torch.cdist(centres, centres).fill_diagonal_(torch.inf).min(dim=1).values
    assert apart.mean() * 2 * 100**0.5 > 1.4


def test_peak_at_the_centre() -> None:
    layer = grown(60, smells(3000))
    torch.testing.assert_close(layer.tuning(layer.centres).diagonal(), torch.full((60,), 20.0))
    assert layer.tuning(smells(500, seed=1)).max() <= 20


@pytest.mark.parametrize(("peak", "flatness"), [(20.0, 0.05), (7.0, 0.5)])
def test_tuning_same_as_scipys_gaussian(peak: float, flatness: float) -> None:
    layer = grown(20, smells(2000, (1.0, 0.4)), peak=peak, flatness=flatness)
    probes = smells(50, (1.0, 0.4), seed=5)
    rates = layer.tuning(probes).numpy()
    for unit in range(20):
        covariance = layer.covariances[unit].double().numpy()
        flat = flatness * np.trace(covariance) / 2
        bell = multivariate_normal(layer.centres[unit].double().numpy(), covariance + flat * np.eye(2))
        trusted = peak * bell.pdf(probes.double().numpy()) / bell.pdf(bell.mean)
        np.testing.assert_allclose(rates[:, unit], trusted, atol=1e-3)


def test_tuning_far_from_the_origin_is_as_exact_as_doubles() -> None:
    odours = 0.1 * torch.randn(2 * BLOCK + 7, 3, generator=torch.Generator().manual_seed(0)) - 30
    layer = grown(20, odours)
    doubled = PlaceCells(20, 1, 3).double()
    doubled.load_state_dict(layer.state_dict())
    deviation = odours.double()[:, None] - doubled.centres
    flat = layer.flatness / 3 * torch.einsum("coo->c", doubled.covariances)[:, None, None] * torch.eye(3)
    exponent = torch.einsum("nco,cop,ncp->nc", deviation, (doubled.covariances + flat).inverse(), deviation)
    torch.testing.assert_close(
        layer.tuning(odours).double(), layer.peak * torch.exp(-exponent / 2), atol=1e-4, rtol=0
    )


def test_a_strange_smell_excites_nothing_and_leaves_no_subnormal_rate() -> None:
    rates = grown(20, smells(500)).tuning(smells(10) + 1e3)
    assert (rates < 1e-19).all()
    assert (rates > torch.finfo(torch.float32).tiny).all()


@pytest.mark.parametrize(("setting", "winners"), [({}, 6), ({"winners": 2}, 2)])
def test_the_nearest_unit_moves_and_the_nearest_few_learn_their_width(
    setting: dict[str, int], winners: int
) -> None:
    odours = smells(31)
    layer = PlaceCells(30, 1, 2)
    layer.compete(odours, window=100.0, **setting)
    nearest = np.argsort(np.linalg.norm(odours[:30] - odours[30], axis=1))[:winners].tolist()
    moved = (layer.centres - odours[:30]).norm(dim=1).nonzero().flatten().tolist()
    assert moved == nearest[:1]
    widened = (layer.covariances - torch.eye(2)).flatten(1).norm(dim=1).nonzero().flatten().tolist()
    assert widened == sorted(nearest)


def test_lone_unit_learns_mean_and_covariance() -> None:
    rng = np.random.default_rng(0)
    spread = np.array([[1.0, 0.6], [0.6, 0.9]])
    x = rng.multivariate_normal([3.0, -1.0], spread, size=8000)
    layer = PlaceCells(1, 1, 2)
    for batch in torch.from_numpy(x).float().split(100):
        layer.compete(batch, window=1e9)
    np.testing.assert_allclose(layer.centres[0], x[1:].mean(axis=0), atol=1e-3)
    np.testing.assert_allclose(layer.covariances[0], np.cov(x.T), rtol=0.1)


def test_fields_follow_the_geometry_of_smells() -> None:
    sparse_and_dense = torch.cat([smells(400), smells(2600, (0.3, 1.0), seed=1) + torch.tensor([1.0, 0])])
    order = torch.randperm(3000, generator=torch.Generator().manual_seed(2))
    layer = grown(60, sparse_and_dense[order])
    width = torch.linalg.det(layer.covariances)
    sparse = layer.centres[:, 0] < 0.9
    assert sparse.sum() > 3
    assert width[sparse].median() > 2 * width[~sparse].median()
    corridor = grown(12, smells(2000, (10.0, 0.05)))
    variance = torch.diagonal(corridor.covariances, dim1=1, dim2=2)
    assert (variance[:, 0] > 100 * variance[:, 1]).all()


@pytest.mark.parametrize("window", [100.0, 200.0])
def test_the_window_is_a_number_of_views(window: float) -> None:
    x = smells(301)
    first, second, third = x[1:].split(100)
    layer = PlaceCells(1, 1, 2)
    for batch in (x[:1], first, second, third):
        layer.compete(batch, window=window)
    kept = 1 - 100 / window
    trusted = (kept**2 * first + kept * second + third).mean(dim=0) / (1 + kept + kept**2)
    torch.testing.assert_close(layer.centres[0], trusted, atol=1e-5, rtol=0)


def test_first_smells_become_the_centres_over_batches() -> None:
    odours = smells(50)
    once, bit_by_bit = PlaceCells(30, 1, 2), PlaceCells(30, 1, 2)
    for batch in odours[:25].split(10):
        bit_by_bit.compete(batch, window=100.0)
    assert torch.equal(bit_by_bit.centres[:25], odours[:25])
    assert not bit_by_bit.centres[25:].any()
    assert int(bit_by_bit.initialised) == 25
    bit_by_bit.compete(odours[25:], window=100.0)
    once.compete(odours, window=100.0)
    for name, buffer in once.named_buffers():
        assert torch.equal(buffer, bit_by_bit.get_buffer(name)), name
