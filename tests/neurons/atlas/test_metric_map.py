from typing import NamedTuple

import numpy as np
import pytest
import torch
from scipy.spatial import procrustes
from sklearn.linear_model import Ridge
from sklearn.metrics import r2_score
from torch import Tensor

from neurons.atlas.metric_map import MetricMap, _affine, _Evidence, _patches
from neurons.layers.place_cells import PlaceCells

SOURCES = torch.tensor([[-0.2, -0.1], [1.2, 0.1], [0.4, 1.3]])
STEP = 0.05
SIDE = 9
"""Place cells along each side of the square."""
CELLS, FEATURES = SIDE**2, 4 * SIDE**2


class Walk(NamedTuple):
    place: Tensor
    heading: Tensor
    odour: Tensor


def smell(place: Tensor) -> Tensor:
    return -2 * torch.cdist(place, SOURCES)


def off(place: Tensor) -> Tensor:
    """By how much the compass is off, rad: up to 11° each way, slowly varying."""
    return 0.2 * torch.sin(3 * place[:, 0] + 2 * place[:, 1])


def walk(views: int, seed: int) -> Walk:
    """Runs in a unit square of steps ahead, and turns by more than a straight way has, at the walls."""
    rng = np.random.default_rng(seed)
    here, heading, track = np.array([0.5, 0.5]), 0.0, []
    while len(track) < views:
        ahead = here + STEP * np.array([np.cos(heading), np.sin(heading)])
        if (np.abs(ahead - 0.5) < 0.5).all():
            here, heading = ahead, heading + rng.normal(0, 0.03)
        else:
            heading += rng.choice([-1, 1]) * rng.uniform(0.3, 3)
        track.append([*here, heading])
    pose = torch.tensor(np.array(track), dtype=torch.float32)
    return Walk(pose[:, :2], pose[:, 2], smell(pose[:, :2]))


@pytest.fixture(scope="module")
def cells() -> PlaceCells:
    x = torch.linspace(0, 1, SIDE)
    centres = smell(torch.cartesian_prod(x, x))
    place = PlaceCells(len(centres), 1, 3)
    place.centres, place.covariances = centres, 0.03 * torch.eye(3).repeat(len(centres), 1, 1)
    return place


@pytest.fixture(scope="module")
def walked() -> Walk:
    return walk(6000, 0)


def learn(
    cells: PlaceCells, walk: Walk, *, batch: int = 256, solve: bool = True, **settings: float
) -> MetricMap:
    metric_map = MetricMap(len(cells.centres), 3, **settings)
    teach(metric_map, cells, walk, batch=batch)
    if solve:
        metric_map.solve(cells)
    return metric_map


def teach(metric_map: MetricMap, cells: PlaceCells, walk: Walk, *, batch: int = 256) -> None:
    learnt = walk.heading - off(walk.place)
    for odour, heading in zip(walk.odour.split(batch), learnt.split(batch), strict=True):
        metric_map.partial_fit(cells, odour, heading)


def spread_of_angle(angle: Tensor) -> float:
    """Root-mean-square deviation from the mean angle, in degrees."""
    turned = torch.polar(torch.ones_like(angle), angle)
    away: Tensor = (turned * turned.mean().conj()).angle()
    return float(away.square().mean().sqrt().rad2deg())


def test_finds_the_map_and_the_offset(cells: PlaceCells, walked: Walk) -> None:
    metric_map, fresh = learn(cells, walked), walk(1000, 1)
    assert not metric_map.diagnosis()
    assert metric_map.cross_validated_r2.min() > 0.99
    position, offset = metric_map(cells, fresh.odour)
    z, true = (p.double().numpy() @ [1, 1j] for p in (position, fresh.place))
    affine = np.stack([z, np.ones_like(z)], axis=1)
    laid, *_ = np.linalg.lstsq(affine, true, rcond=None)
    left = affine @ laid - true
    assert 1 - np.var(left) / np.var(true) > 0.999
    assert abs(laid[0]) == pytest.approx(metric_map.lag * STEP, rel=0.03)
    # a place averages over its surroundings, which shrinks the offset
    assert spread_of_angle(off(fresh.place) - offset) < 0.45 * spread_of_angle(off(fresh.place))


def test_a_walk_elsewhere_is_told_from_one_that_the_map_foretells(cells: PlaceCells, walked: Walk) -> None:
    metric_map = learn(cells, walked)
    positions, learnt = metric_map.positions, metric_map.cross_validated_r2
    metric_map.begin_again()
    teach(metric_map, cells, walk(100, 2))
    metric_map.check()  # too short to tell
    assert metric_map.cross_validated_r2 is learnt
    teach(metric_map, cells, walk(3000, 3))
    metric_map.check()
    assert metric_map.cross_validated_r2.min() > 0.97
    assert metric_map.cross_validated_r2 is not learnt
    metric_map.begin_again()
    here = walk(3000, 4)
    teach(metric_map, cells, here._replace(odour=smell(1 - here.place)))
    metric_map.check()
    assert "one half of the walk foretells" in metric_map.diagnosis()
    assert metric_map.positions is positions


def test_a_second_time_on_corrected_headings_the_offset_is_nearer(cells: PlaceCells, walked: Walk) -> None:
    once, fresh = learn(cells, walked), walk(1000, 1)
    twice = learn(cells, walked)
    twice.begin_again()
    assert not any(
        sums.any() for sums in (twice.spread, twice.ahead, twice.shared, twice.counted, twice.seen)
    )
    teach(twice, cells, walked)
    twice.solve(cells)
    assert not twice.diagnosis()
    left = [spread_of_angle(off(fresh.place) - each(cells, fresh.odour).offset) for each in (once, twice)]
    assert left[1] < 0.75 * left[0]


@pytest.mark.parametrize(("lag", "straight"), [(3, 0.25), (5, 0.05)])
def test_sums_over_straight_ways_only(cells: PlaceCells, lag: int, straight: float) -> None:
    some = walk(600, 2)
    metric_map = learn(cells, some, solve=False, lag=lag, straight=straight)
    share, patches = (part.double().numpy() for part in _patches(cells, some.odour))
    learnt = (some.heading - off(some.place)).double().numpy()
    spread, ahead = np.zeros((2, FEATURES, FEATURES)), np.zeros((2, CELLS, FEATURES), complex)
    pairs = [0, 0]
    for t in range(len(learnt) - lag):
        turns = np.diff(learnt[t : t + lag + 1])
        if np.abs(np.angle(np.exp(1j * turns))).max() < straight:
            half = (t + lag) // 128 % 2
            moved = patches[t + lag] - patches[t]
            heading = np.exp(1j * learnt[t : t + lag + 1])
            u = np.mean((heading[1:] + heading[:-1]) / 2)
            spread[half] += np.outer(moved, moved)
            ahead[half] += np.outer(share[t + 1 : t + lag].mean(axis=0) * u.conj(), moved)
            pairs[half] += 1
    assert metric_map.counted[:, 1].tolist() == pairs
    assert metric_map.seen == len(learnt)
    np.testing.assert_allclose(metric_map.spread, spread, atol=1e-4)
    np.testing.assert_allclose(metric_map.ahead, np.stack([ahead.real, ahead.imag], axis=3), atol=1e-4)


@pytest.mark.parametrize("ridge", [1e-3, 1.0])
def test_map_is_ridge_regression_and_the_share_foretold_what_it_leaves(
    cells: PlaceCells, walked: Walk, ridge: float
) -> None:
    metric_map = learn(cells, walked, ridge=ridge)
    lag, straight = metric_map.lag, metric_map.straight
    evidence = metric_map._evidence(slice(0, 2))
    positions, turns = evidence.solve(ridge * torch.eye(FEATURES).double())
    torch.testing.assert_close(turns.abs(), torch.ones(CELLS, dtype=torch.double))
    rows, wanted = [], []
    share, patches = _patches(cells, walked.odour)
    learnt = walked.heading - off(walked.place)
    for t in range(len(learnt) - lag):
        turned = learnt[t : t + lag + 1].diff()
        if torch.atan2(turned.sin(), turned.cos()).abs().max() < straight:
            heading = torch.polar(torch.ones(lag + 1), learnt[t : t + lag + 1])
            f = share[t + 1 : t + lag].mean(dim=0).cdouble() @ turns
            rows.append(patches[t + lag] - patches[t])
            wanted.append((heading[1:] + heading[:-1]).mean().cdouble() / 2 * f)
    v, u = torch.stack(rows), torch.stack(wanted)
    ridge = Ridge(ridge * float(v.square().sum(dim=0).mean()), fit_intercept=False)
    trusted = ridge.fit(v.double().numpy(), torch.view_as_real(u).numpy()).predict(v.double().numpy())
    mine = v.cdouble() @ positions
    np.testing.assert_allclose(torch.view_as_real(mine), trusted, atol=1e-3)
    left = (mine - u).abs().square().sum()
    assert evidence.cross_validated_r2(positions, turns) == pytest.approx(
        1 - float(left) / evidence.power, abs=1e-4
    )


@pytest.mark.parametrize("batch", [1, 2, 100])
def test_any_batches_will_do(cells: PlaceCells, batch: int) -> None:
    some = walk(600, 2)
    whole, parts = (learn(cells, some, batch=size, solve=False) for size in (600, batch))
    for name, value in whole.state_dict().items():
        torch.testing.assert_close(
            parts.state_dict()[name], value, atol=1e-4, rtol=1e-5, equal_nan=True, msg=name
        )


def test_sums_of_two_walks_add_up_when_a_jump_is_told(cells: PlaceCells) -> None:
    # whole blocks, so that views fall to the same halves when counted on
    along = torch.stack([torch.linspace(0.1, 0.9, 256), torch.full((256,), 0.5)], dim=1)
    one, other = (Walk(way, torch.zeros(len(way)), smell(way)) for way in (along, along.flip(0)))
    apart = [learn(cells, each, solve=False) for each in (one, other)]
    both = learn(cells, one, solve=False)
    both.recent.fill_(torch.nan)
    both.partial_fit(cells, other.odour, other.heading - off(other.place))
    for name in ("spread", "ahead", "shared", "counted", "seen"):
        total = sum(getattr(metric_map, name) for metric_map in apart)
        torch.testing.assert_close(getattr(both, name), total, atol=1e-4, rtol=1e-5)


def assert_left_out(metric_map: MetricMap, cells: PlaceCells, odour: Tensor, said: str) -> None:
    assert said in metric_map.diagnosis()
    position, offset = metric_map(cells, odour)
    assert position.isnan().all()
    assert not offset.any()


def test_shuffled_order_teaches_nothing(cells: PlaceCells, walked: Walk) -> None:
    order = torch.randperm(len(walked.place), generator=torch.Generator().manual_seed(0))
    views = Walk(*(part[order] for part in walked))
    assert_left_out(learn(cells, views), cells, walked.odour, "too few")
    lost = walked._replace(place=views.place, odour=views.odour)
    assert_left_out(learn(cells, lost), cells, walked.odour, "foretells")
    still = views._replace(heading=off(views.place))
    assert_left_out(learn(cells, still), cells, walked.odour, "foretells")


@pytest.fixture(scope="module")
def noisy() -> Walk:
    some = walk(800, 3)
    noise = 0.06 * torch.randn(len(some.odour), 3, generator=torch.Generator().manual_seed(0))
    return some._replace(odour=some.odour + noise)


def test_of_few_views_with_noise_one_affine_map_for_all_is_learnt(cells: PlaceCells, noisy: Walk) -> None:
    assert_left_out(learn(cells, noisy, stiffness=0.0), cells, noisy.odour, "foretells")
    stiff = learn(cells, noisy)
    assert not stiff.diagnosis()
    position, offset = stiff(cells, noisy.odour)
    assert not offset.any()
    assert r2_score(*procrustes(noisy.place.numpy(), position.numpy())[:2]) > 0.95
    order = torch.randperm(len(noisy.place), generator=torch.Generator().manual_seed(0))
    lost = noisy._replace(place=noisy.place[order], odour=noisy.odour[order])
    assert_left_out(learn(cells, lost), cells, lost.odour, "foretells")


def test_affine_maps_are_what_the_stiff_prior_leaves(cells: PlaceCells) -> None:
    rng = torch.Generator().manual_seed(0)
    start, slope = torch.randn(1, generator=rng), torch.randn(3, generator=rng)
    affine = (
        torch.cat([start + cells.centres @ slope[:, None], slope.expand(CELLS, 3)], dim=1).flatten().double()
    )
    projection = _affine(cells)
    torch.testing.assert_close(projection @ affine, affine, atol=1e-5, rtol=1e-5)
    assert float(projection.trace()) == pytest.approx(4)
    torch.testing.assert_close(projection @ projection, projection)


@pytest.mark.parametrize(("turn", "said"), [(0.4, "too few"), (0.1, "foretells")])
def test_spinning_on_the_spot_teaches_nothing(cells: PlaceCells, turn: float, said: str) -> None:
    noise = 0.02 * torch.randn(3000, 3, generator=torch.Generator().manual_seed(0))
    place = torch.full((3000, 2), 0.4)
    spin = Walk(place, turn * torch.arange(3000.0), smell(place) + noise)
    assert_left_out(learn(cells, spin), cells, spin.odour, said)


def test_how_much_must_be_foretold_is_a_setting(cells: PlaceCells, walked: Walk) -> None:
    assert_left_out(learn(cells, walked, least_r2=0.9999), cells, walked.odour, "less than 0.9999")


def test_without_a_compass_there_is_nothing_to_learn(cells: PlaceCells, walked: Walk) -> None:
    blind = walked._replace(heading=torch.full_like(walked.heading, torch.nan))
    assert_left_out(learn(cells, blind), cells, walked.odour, "0 of 6000 views")


def test_offsets_converge_behind_a_door_too() -> None:
    # two rooms of ten cells, whose compasses differ by 40°; few ways lead through the door
    cells, door = 20, 0.01
    ahead = torch.zeros(cells, cells)
    ahead[:10, :10], ahead[10:, 10:] = 1.0, 1.0
    ahead[9, 10] = ahead[10, 9] = door
    turned = torch.polar(torch.ones(cells), torch.tensor([0.0, 0.7]).repeat_interleave(10))
    evidence = _Evidence(
        torch.eye(cells, dtype=torch.double),
        (turned[:, None] * ahead.sqrt() * turned.conj()).to(torch.cdouble),
        torch.zeros(cells, cells, dtype=torch.double),
        1.0,
        1.0,
    )
    _, turns = evidence.solve(1e-9 * torch.eye(cells).double())
    across = (turns[10:].mean() / turns[:10].mean()).angle().item()
    assert across == pytest.approx(0.7, abs=0.01)
