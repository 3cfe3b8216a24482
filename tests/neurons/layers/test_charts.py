import numpy as np
import pytest
import torch
from scipy.linalg import subspace_angles
from sklearn.neighbors import NearestNeighbors
from torch import Tensor

from neurons.layers.charts import Charts


def manifold(views: int, seed: int = 0) -> Tensor:
    """Poses (x, y, θ) seen through smooth random Fourier features, 20 in all."""
    rng = np.random.default_rng(seed)
    x, y, heading = rng.uniform(size=(3, views)) * np.array([[1.0], [1.0], [2 * np.pi]])
    place = np.column_stack([x, y, 0.5 * np.cos(heading), 0.5 * np.sin(heading)])
    features = np.random.default_rng(99)
    waves, phases = features.normal(size=(4, 20)), features.uniform(0, 2 * np.pi, 20)
    return torch.from_numpy(np.cos(place @ waves + phases)).float()


def blank(charts: int, components: int = 20) -> Charts:
    return Charts(charts, components, generator=torch.Generator().manual_seed(0))


@pytest.fixture(scope="module")
def views() -> Tensor:
    return manifold(5000)


@pytest.fixture(scope="module")
def charts(views: Tensor) -> Charts:
    grown = blank(150)
    order = torch.Generator().manual_seed(1)
    for winners in (12, 10, 8, 6, 5, 4, 4):
        for batch in views[torch.randperm(len(views), generator=order)].split(250):
            grown.partial_fit(batch, winners=winners, window=float(len(views)))
    grown.freeze()
    return grown


def test_tangents_same_as_local_pca(charts: Charts, views: Tensor) -> None:
    seen = views.double().numpy()
    neighbours = NearestNeighbors(n_neighbors=60).fit(seen)
    nearest = neighbours.kneighbors(charts.centres.double().numpy(), return_distance=False)
    cosines = []
    for tangents, group in zip(charts.tangents.double().numpy(), seen[nearest], strict=True):
        _, _, trusted = np.linalg.svd(group - group.mean(axis=0), full_matrices=False)
        cosines.append(np.cos(subspace_angles(tangents.T, trusted[:3].T)).min())
    assert np.median(cosines) > 0.95


def test_frozen_tangents_are_orthonormal(charts: Charts) -> None:
    gram = charts.tangents @ charts.tangents.mT
    torch.testing.assert_close(gram, torch.eye(3).expand(150, 3, 3), atol=1e-5, rtol=0)


def test_freezing_keeps_the_span() -> None:
    grown = blank(5)
    grown.tangents = torch.randn(5, 3, 20, generator=torch.Generator().manual_seed(4))
    before = grown.tangents.double().numpy().copy()
    grown.freeze()
    for old, new in zip(before, grown.tangents.double().numpy(), strict=True):
        assert np.cos(subspace_angles(old.T, new.T)).min() > 0.9999


def test_centres_tile_the_manifold(charts: Charts, views: Tensor) -> None:
    drawn = NearestNeighbors(n_neighbors=1).fit(views[:150])
    settled = NearestNeighbors(n_neighbors=1).fit(charts.centres)
    assert np.mean(settled.kneighbors(views)[0] ** 2) < 0.8 * np.mean(drawn.kneighbors(views)[0] ** 2)


def test_first_codes_become_the_centres(views: Tensor) -> None:
    grown = blank(30)
    for batch in views[:30].split(8):
        grown.partial_fit(batch, winners=4, window=100.0)
    assert torch.equal(grown.centres, views[:30])
    assert len(grown) == int(grown.initialised) == 30


def test_placing_over_batches_leaves_the_rest_to_compete(views: Tensor) -> None:
    once, bit_by_bit = blank(30), blank(30)
    once.partial_fit(views[:50], winners=4, window=100.0)
    for batch in views[:50].split([7, 11, 32]):
        bit_by_bit.partial_fit(batch, winners=4, window=100.0)
    assert not torch.equal(once.centres, views[:30])
    for name, buffer in once.named_buffers():
        assert torch.equal(buffer, bit_by_bit.get_buffer(name)), name


def test_lone_chart_learns_mean_and_principal_components() -> None:
    rng = np.random.default_rng(3)
    basis = np.linalg.qr(rng.normal(size=(6, 6)))[0]
    spread = np.array([2.0, 1.4, 0.9, 0.2, 0.1, 0.1])
    x = rng.normal(size=(8000, 6)) * spread @ basis.T + 1.0
    lone = blank(1, 6)
    for _ in range(4):
        for batch in torch.from_numpy(x).float().split(100):
            lone.partial_fit(batch, winners=1, window=1e9)
    np.testing.assert_allclose(lone.centres[0], x.mean(axis=0), atol=1e-3)
    assert (np.abs(np.diag(lone.tangents[0].double().numpy() @ basis)) > 0.99).all()
    np.testing.assert_allclose(lone.variances[0], spread[:3] ** 2, rtol=0.15)


def test_memory_is_a_number_of_views() -> None:
    x = torch.randn(301, 20, generator=torch.Generator().manual_seed(5))
    first, second, third = x[1:].split(100)
    for window, mean in {
        100.0: third.mean(dim=0),
        200.0: (0.25 * first + 0.5 * second + third).mean(dim=0) / 1.75,
    }.items():
        lone = blank(1)
        lone.partial_fit(x[:1], winners=1, window=window)
        for batch in (first, second, third):
            lone.partial_fit(batch, winners=1, window=window)
        torch.testing.assert_close(lone.centres[0], mean, atol=1e-5, rtol=1e-4)


def test_second_rank_learns_with_weight_exp_minus_one() -> None:
    left, right = torch.full((4, 20), -1.0), torch.full((6, 20), 1.0)
    pair = blank(2)
    pair.partial_fit(torch.cat([left[:1], right[:1]]), winners=2, window=1e9)
    pair.partial_fit(torch.cat([left, right]), winners=2, window=1e9)
    h = np.exp(-1.0)
    np.testing.assert_allclose(pair.centres[0], (-4 + 6 * h) / (4 + 6 * h), rtol=1e-5)
    np.testing.assert_allclose(pair.centres[1], (6 - 4 * h) / (6 + 4 * h), rtol=1e-5)


def test_ranks_share_sangers_rule(views: Tensor) -> None:
    """One batch on drawn centres, view by view: variances start at nought, so U is the drive alone."""
    layer = blank(6)
    layer.partial_fit(views[:6], winners=3, window=1e9)
    before, codes = layer.tangents.double().numpy(), views[6:60]
    centres = layer.centres.double().numpy().copy()
    drive, responsibility = np.zeros_like(before), np.zeros(6)
    for z in codes.double().numpy():
        for rank, k in enumerate(np.argsort(np.linalg.norm(z - centres, axis=1))[:3]):
            h, residual = np.exp(-2 * rank / 3), z - centres[k]
            y = before[k] @ residual
            drive[k] += h * (np.outer(y, residual) - np.tril(np.outer(y, y), -1) @ before[k])
            responsibility[k] += h
    layer.partial_fit(codes, winners=3, window=1e9)
    variances = np.linalg.norm(drive, axis=2) / responsibility[:, None]
    np.testing.assert_allclose(layer.variances, variances, rtol=1e-3, atol=1e-6)
    np.testing.assert_allclose(
        layer.tangents, drive / (variances * responsibility[:, None])[..., None], atol=1e-3
    )


def test_nearest_same_as_scikit_learn(charts: Charts, views: Tensor) -> None:
    chart, squared = charts.excite(views[:200], 7)
    trusted = NearestNeighbors(n_neighbors=7).fit(charts.centres.double().numpy())
    distance, index = trusted.kneighbors(views[:200].double().numpy())
    assert np.mean(chart.numpy() == index) > 0.999
    np.testing.assert_allclose(squared, distance**2, rtol=1e-4, atol=1e-6)


def test_no_more_winners_than_charts(views: Tensor) -> None:
    grown = blank(3)
    grown.partial_fit(views[:3], winners=12, window=100.0)
    assert grown.excite(views[:5], 12).chart.shape == (5, 3)


def test_coordinates_are_tangents_times_residual(charts: Charts, views: Tensor) -> None:
    codes = views[:20]
    chart = charts.excite(codes, 4).chart
    coordinates = charts.coordinates(codes, chart).numpy()
    for view in range(20):
        for rank, k in enumerate(chart[view].tolist()):
            direct = charts.tangents[k].numpy() @ (codes[view] - charts.centres[k]).numpy()
            np.testing.assert_allclose(coordinates[view, rank], direct, atol=1e-5)


def test_grows_halfway_along_the_longest_overlaps() -> None:
    charts = Charts(4, 5, generator=torch.Generator().manual_seed(0))
    charts.centres = torch.tensor([[0.0], [1.0], [4.0], [14.0]]) * torch.eye(5)[1]
    before, overlapping = charts.state_dict(), torch.tensor([[0, 1], [1, 2], [2, 3], [0, 2]])
    before = {name: value.clone() for name, value in before.items()}
    charts.grow(overlapping, 2)
    assert charts.centres[4:, 1].tolist() == [9.0, 2.0]
    assert charts.tangents[4:].equal(before["tangents"][[2, 0]])
    assert not charts.responsibility[4:].any()
    assert not charts.variances[4:].any()
    assert charts.initialised == len(charts) == 6
    for name in ("centres", "tangents", "responsibility", "variances"):
        assert charts.get_buffer(name)[:4].equal(before[name])
    charts.partial_fit(
        torch.randn(50, 5, generator=torch.Generator().manual_seed(1)), winners=6, window=100.0
    )
    assert charts.responsibility.all()
    charts.grow(overlapping, 9)
    assert len(charts) == 10
