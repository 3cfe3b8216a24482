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


def blank(charts: int, components: int = 20, **settings: float) -> Charts:
    return Charts(charts, components, 2, generator=torch.Generator().manual_seed(0), **settings)


def smells(views: Tensor) -> Tensor:
    """A nose that never smells anything: sight alone decides."""
    return torch.zeros(len(views), 2)


@pytest.fixture(scope="module")
def views() -> Tensor:
    return manifold(5000)


@pytest.fixture(scope="module")
def charts(views: Tensor) -> Charts:
    grown = blank(150)
    order = torch.Generator().manual_seed(1)
    for winners in (12, 10, 8, 6, 5, 4, 4):
        for batch in views[torch.randperm(len(views), generator=order)].split(250):
            grown.partial_fit(batch, smells(batch), winners=winners, window=float(len(views)))
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
        grown.partial_fit(batch, smells(batch), winners=4, window=100.0)
    assert torch.equal(grown.centres, views[:30])
    assert len(grown) == int(grown.initialised) == 30


def test_placing_over_batches_leaves_the_rest_to_compete(views: Tensor) -> None:
    once, bit_by_bit = blank(30), blank(30)
    once.partial_fit(views[:50], smells(views[:50]), winners=4, window=100.0)
    for batch in views[:50].split([7, 11, 32]):
        bit_by_bit.partial_fit(batch, smells(batch), winners=4, window=100.0)
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
            lone.partial_fit(batch, smells(batch), winners=1, window=1e9)
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
        lone.partial_fit(x[:1], smells(x[:1]), winners=1, window=window)
        for batch in (first, second, third):
            lone.partial_fit(batch, smells(batch), winners=1, window=window)
        torch.testing.assert_close(lone.centres[0], mean, atol=1e-5, rtol=1e-4)


def test_second_rank_learns_with_weight_exp_minus_one() -> None:
    left, right = torch.full((4, 20), -1.0), torch.full((6, 20), 1.0)
    pair = blank(2)
    pair.partial_fit(
        torch.cat([left[:1], right[:1]]), smells(torch.cat([left[:1], right[:1]])), winners=2, window=1e9
    )
    pair.partial_fit(torch.cat([left, right]), smells(torch.cat([left, right])), winners=2, window=1e9)
    h = np.exp(-1.0)
    np.testing.assert_allclose(pair.centres[0], (-4 + 6 * h) / (4 + 6 * h), rtol=1e-5)
    np.testing.assert_allclose(pair.centres[1], (6 - 4 * h) / (6 + 4 * h), rtol=1e-5)


def test_ranks_share_sangers_rule(views: Tensor) -> None:
    """One batch on drawn centres, view by view: variances start at nought, so U is the drive alone."""
    layer = blank(6)
    layer.partial_fit(views[:6], smells(views[:6]), winners=3, window=1e9)
    before, codes = layer.tangents.double().numpy(), views[6:60]
    centres = layer.centres.double().numpy().copy()
    drive, responsibility = np.zeros_like(before), np.zeros(6)
    for z in codes.double().numpy():
        for rank, k in enumerate(np.argsort(np.linalg.norm(z - centres, axis=1))[:3]):
            h, residual = np.exp(-2 * rank / 3), z - centres[k]
            y = before[k] @ residual
            drive[k] += h * (np.outer(y, residual) - np.tril(np.outer(y, y), -1) @ before[k])
            responsibility[k] += h
    layer.partial_fit(codes, smells(codes), winners=3, window=1e9)
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


@pytest.mark.parametrize("smell", [0.0, 0.5])
def test_places_that_look_alike_get_charts_of_their_own_when_smell_competes(
    views: Tensor, smell: float
) -> None:
    """Two rooms of the same views, one of which smells of something else."""
    noise = torch.Generator().manual_seed(3)
    codes = torch.cat([views[:1500], views[:1500]])
    odours = torch.repeat_interleave(torch.tensor([[0.0, 0.0], [1.0, -1.0]]), 1500, dim=0)
    odours += 0.1 * torch.randn(3000, 2, generator=noise)
    layer = blank(100, smell=smell)
    for winners in (6, 4, 4):
        for rows in torch.randperm(3000, generator=noise).split(250):
            layer.partial_fit(codes[rows], odours[rows], winners=winners, window=3000.0)
    chart = layer.excite(codes, 1, odours).chart[:, 0]
    second = torch.bincount(chart[1500:], minlength=100) / torch.bincount(chart, minlength=100).clamp(min=1)
    mixed = float(torch.minimum(second, 1 - second).mean())
    assert mixed < 0.02 if smell else mixed > 0.3, mixed


def test_joint_distance_weighs_smell_by_the_usual_misfits(views: Tensor) -> None:
    odours = torch.randn(300, 2, generator=torch.Generator().manual_seed(2))
    layer = blank(30, smell=0.7)
    for batch in (slice(30), slice(30, 130)):
        layer.partial_fit(views[batch], odours[batch], winners=4, window=1e9)
    before = blank(30, smell=0.7)
    before.partial_fit(views[:30], odours[:30], winners=4, window=1e9)
    # before any chart has won, λ is κ
    points, seen = (
        np.hstack([z.double().numpy(), 0.7 * o.double().numpy()])
        for z, o in ((before.centres, before.smells), (views[30:130], odours[30:130]))
    )
    won = NearestNeighbors(n_neighbors=1).fit(points).kneighbors(seen, return_distance=False)[:, 0]
    sight = np.square(views[30:130].numpy() - before.centres.numpy()[won]).sum(axis=1)
    smell = np.square(odours[30:130].numpy() - before.smells.numpy()[won]).sum(axis=1)
    # the lower of the two in the middle, as PyTorch; of smell what it would be of a normal variable
    usual = [np.sort(sight)[49], np.quantile(smell, 0.1) * np.log(2) / -np.log(0.9)]
    np.testing.assert_allclose(layer.misfits, usual, rtol=1e-4)
    weight = 0.7 * np.sqrt(usual[0] / usual[1])
    assert float(layer.smell_weight) == pytest.approx(weight, rel=1e-4)
    test = slice(130, 300)
    joint = np.hstack([views[test].double().numpy(), weight * odours[test].double().numpy()])
    charts = np.hstack([layer.centres.double().numpy(), weight * layer.smells.double().numpy()])
    np.testing.assert_allclose(layer.points, charts, rtol=1e-4, atol=1e-5)
    distance, index = NearestNeighbors(n_neighbors=5).fit(charts).kneighbors(joint)
    chart, squared = layer.excite(views[test], 5, odours[test])
    assert np.mean(chart.numpy() == index) > 0.99
    np.testing.assert_allclose(squared, distance**2, rtol=1e-3)


def test_a_chart_smells_of_the_mean_of_what_it_wins(views: Tensor) -> None:
    layer, odours = blank(1, smell=0.5), torch.randn(201, 2, generator=torch.Generator().manual_seed(4))
    layer.partial_fit(views[:201], odours, winners=1, window=1e9)
    # the first view is born as the chart, and counts no more once others are won
    torch.testing.assert_close(layer.smells[0], odours[1:].mean(dim=0), atol=1e-5, rtol=1e-4)
    torch.testing.assert_close(layer.centres[0], views[1:201].mean(dim=0), atol=1e-4, rtol=1e-4)


def test_no_more_winners_than_charts(views: Tensor) -> None:
    grown = blank(3)
    grown.partial_fit(views[:3], smells(views[:3]), winners=12, window=100.0)
    assert grown.excite(views[:5], 12).chart.shape == (5, 3)


def test_coordinates_are_tangents_times_residual(charts: Charts, views: Tensor) -> None:
    codes = views[:20]
    chart = charts.excite(codes, 4).chart
    coordinates = charts.coordinates(codes, chart).numpy()
    for view in range(20):
        for rank, k in enumerate(chart[view].tolist()):
            direct = charts.tangents[k].numpy() @ (codes[view] - charts.centres[k]).numpy()
            np.testing.assert_allclose(coordinates[view, rank], direct, atol=1e-5)


def test_coordinates_in_earlier_frames_become_those_of_now(views: Tensor) -> None:
    layer = blank(40)
    layer.partial_fit(views[:300], smells(views[:300]), winners=2, window=300.0)
    before, chart = layer.frames, torch.arange(40)[:, None]
    # in the tangent planes of before, where frames that learn are not at right angles yet
    seen = before.centres + torch.einsum(
        "kd,kdc->kc", torch.linspace(-1, 1, 120).view(40, 3), before.tangents
    )
    old = torch.cat([torch.ones(40, 1), layer.coordinates(seen, chart)[:, 0]], dim=1)
    layer.partial_fit(views[300:600], smells(views[300:600]), winners=2, window=300.0)
    layer.freeze()
    now = torch.cat([torch.ones(40, 1), layer.coordinates(seen, chart)[:, 0]], dim=1)
    assert (now - old).abs().max() > 0.1
    told = torch.einsum("kij,kj->ki", layer.since(before).float(), old)
    torch.testing.assert_close(told, now, rtol=1e-3, atol=1e-4)


def test_grows_halfway_along_the_longest_overlaps() -> None:
    charts = blank(4, 5)
    charts.smells = torch.tensor([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [2.0, 3.0]])
    charts.centres = torch.tensor([[0.0], [1.0], [4.0], [14.0]]) * torch.eye(5)[1]
    before, overlapping = charts.state_dict(), torch.tensor([[0, 1], [1, 2], [2, 3], [0, 2]])
    before = {name: value.clone() for name, value in before.items()}
    charts.grow(overlapping, 2)
    assert charts.centres[4:, 1].tolist() == [9.0, 2.0]
    assert charts.smells[4:].tolist() == [[1.0, 1.5], [0.5, 0.0]]
    assert charts.tangents[4:].equal(before["tangents"][[2, 0]])
    assert not charts.responsibility[4:].any()
    assert not charts.variances[4:].any()
    assert charts.initialised == len(charts) == 6
    for name in ("centres", "smells", "tangents", "responsibility", "variances"):
        assert charts.get_buffer(name)[:4].equal(before[name])
    codes = torch.randn(50, 5, generator=torch.Generator().manual_seed(1))
    charts.partial_fit(codes, smells(codes), winners=6, window=100.0)
    assert charts.responsibility.all()
    charts.grow(overlapping, 9)
    assert len(charts) == 10


def test_wider_charts_learn_their_first_tangents_as_ever(views: Tensor) -> None:
    plain, wide = blank(40), blank(40)
    for layer in (plain, wide):
        layer.partial_fit(views[:200], smells(views[:200]), winners=4, window=1e9)
    wide.widen()
    gram = wide.tangents[:, 3:] @ wide.tangents.mT
    torch.testing.assert_close(gram[:, :, 3:], torch.eye(3).expand(40, 3, 3), atol=1e-5, rtol=0)
    assert gram[:, :, :3].abs().max() < 1e-5
    for layer in (plain, wide):
        layer.partial_fit(views[200:600], smells(views[200:600]), winners=4, window=1e9)
    torch.testing.assert_close(wide.tangents[:, :3], plain.tangents, atol=1e-5, rtol=1e-4)
    torch.testing.assert_close(wide.centres, plain.centres)
    wide.widen()
    assert wide.dimensions == 6
    wide.cut(3)
    torch.testing.assert_close(wide.variances, plain.variances, rtol=1e-4, atol=1e-7)


def test_no_more_tangents_than_components() -> None:
    few = blank(30, 5)
    few.widen()
    assert few.dimensions == 5


def test_spectra_of_a_cloud_in_two_dimensions() -> None:
    """Charts that no view has moved have nothing to tell."""
    x = torch.zeros(3000, 8)
    x[:, :2] = torch.rand(3000, 2, generator=torch.Generator().manual_seed(6))
    layer = blank(40, 8)
    layer.partial_fit(x[:40], smells(x[:40]), winners=2, window=1e9)
    layer.widen()
    assert layer.spectra.shape == (0, 6)
    for batch in x[40:].repeat(4, 1).split(100):
        layer.partial_fit(batch, smells(batch), winners=2, window=3000.0)
    torch.testing.assert_close(layer.spectra.sum(dim=1), torch.ones(len(layer.spectra)))
    assert (layer.spectra[:, :2].sum(dim=1) > 0.85).all()
