from typing import NamedTuple

import numpy as np
import pytest
import torch
from scipy.spatial import procrustes
from sklearn.linear_model import Ridge
from sklearn.metrics import r2_score
from torch import Tensor

from neurons.atlas.metric_map import SMALL, SUMS, MetricMap, _solved, _synchronised
from neurons.atlas.moving_least_squares import apart, patches_of, ties
from neurons.layers.heading_cells import HeadDirectionCells
from neurons.layers.place_cells import PlaceCells

SOURCES = torch.tensor([[-0.2, -0.1], [1.2, 0.1], [0.4, 1.3]])
STEP = 0.05
SIDE = 9
"""Place cells along each side of the square."""
CELLS = SIDE**2
FACING = HeadDirectionCells(24, 1, generator=torch.Generator().manual_seed(0))
FACING.preferred = torch.arange(24) * (2 * torch.pi / 24) - torch.pi


class Walk(NamedTuple):
    place: Tensor
    heading: Tensor
    odour: Tensor


def smell(place: Tensor) -> Tensor:
    return -2 * torch.cdist(place, SOURCES)


def off(place: Tensor) -> Tensor:
    """By how much the compass is off, rad: up to 11° each way, slowly varying."""
    return 0.2 * torch.sin(3 * place[:, 0] + 2 * place[:, 1])


def deviation(heading: Tensor) -> Tensor:
    """By how much it is off by where it points, rad: up to 9°."""
    return 0.1 * torch.sin(heading) + 0.05 * torch.cos(2 * heading)


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
    metric_map = MetricMap(len(cells.centres), len(FACING.preferred), 3, **settings)
    teach(metric_map, cells, walk, batch=batch)
    if solve:
        metric_map.solve(cells)
    return metric_map


def teach(metric_map: MetricMap, cells: PlaceCells, walk: Walk, *, batch: int = 256) -> None:
    learnt = walk.heading - off(walk.place)
    for odour, heading in zip(walk.odour.split(batch), learnt.split(batch), strict=True):
        metric_map.partial_fit(cells, FACING, odour, heading)


def spread_of_angle(angle: Tensor) -> float:
    """Root-mean-square deviation from the mean angle, in degrees."""
    turned = torch.polar(torch.ones_like(angle), angle)
    away: Tensor = (turned * turned.mean().conj()).angle()
    return float(away.square().mean().sqrt().rad2deg())


def test_finds_the_map_and_the_offset(cells: PlaceCells, walked: Walk) -> None:
    metric_map, fresh = learn(cells, walked), walk(1000, 1)
    assert not metric_map.diagnosis()
    assert metric_map.cross_validated_r2.min() > 0.99
    position, corrected = metric_map(cells, FACING, fresh.odour, fresh.heading - off(fresh.place))
    torch.testing.assert_close(metric_map.locate(cells, fresh.odour), position)
    z, true = (p.double().numpy() @ [1, 1j] for p in (position, fresh.place))
    affine = np.stack([z, np.ones_like(z)], axis=1)
    laid, *_ = np.linalg.lstsq(affine, true, rcond=None)
    left = affine @ laid - true
    assert 1 - np.var(left) / np.var(true) > 0.999
    assert abs(laid[0]) == pytest.approx(metric_map.lag * STEP, rel=0.03)
    # a place averages over its surroundings, which shrinks the offset
    assert spread_of_angle(fresh.heading - corrected) < 0.45 * spread_of_angle(off(fresh.place))
    assert spread_of_angle(metric_map.deviations) < 0.3 * spread_of_angle(off(fresh.place))


def test_finds_the_deviation_by_where_the_compass_points(cells: PlaceCells) -> None:
    some = walk(6000, 0)
    metric_map = MetricMap(CELLS, len(FACING.preferred), 3)
    recalled = some.heading - deviation(some.heading)
    before = spread_of_angle(some.heading - recalled)
    for left in (0.6, 0.35):
        metric_map.partial_fit(cells, FACING, some.odour, recalled)
        metric_map.solve(cells)
        metric_map.begin_again()
        _, corrected = metric_map(cells, FACING, some.odour, recalled)
        assert spread_of_angle(some.heading - corrected) < left * before


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
    assert not any(twice.get_buffer(name).any() for name in SUMS)
    teach(twice, cells, walked)
    twice.solve(cells)
    assert not twice.diagnosis()
    recalled = fresh.heading - off(fresh.place)
    left = [
        spread_of_angle(fresh.heading - each(cells, FACING, fresh.odour, recalled).heading)
        for each in (once, twice)
    ]
    assert left[1] < 0.75 * left[0]


class Ways(NamedTuple):
    """Displacements, shares of place and of heading on the way, mean headings, and the half of each."""

    moved: np.ndarray
    share: np.ndarray
    faced: np.ndarray
    direction: np.ndarray
    half: np.ndarray


def straight_ways(cells: PlaceCells, walk: Walk, lag: int = 4, straight: float = 0.25) -> Ways:
    share, patches = (part.double().numpy() for part in patches_of(cells, walk.odour))
    weights = patches @ ties(cells).flatten(0, 1).numpy()
    learnt = (walk.heading - off(walk.place)).double().numpy()
    faced = FACING.share(torch.from_numpy(learnt).float()).double().numpy()
    found = []
    for t in range(len(learnt) - lag):
        turns = np.diff(learnt[t : t + lag + 1])
        if np.abs(np.angle(np.exp(1j * turns))).max() < straight:
            heading = np.exp(1j * learnt[t : t + lag + 1])
            between = slice(t + 1, t + lag)
            found.append(
                (
                    weights[t + lag] - weights[t],
                    share[between].mean(axis=0),
                    faced[between].mean(axis=0),
                    np.mean((heading[1:] + heading[:-1]) / 2),
                    (t + lag) // 128 % 2,
                )
            )
    return Ways(*(np.array(part) for part in zip(*found, strict=True)))


@pytest.mark.parametrize(("lag", "straight"), [(3, 0.25), (5, 0.05)])
def test_sums_over_straight_ways_only(cells: PlaceCells, lag: int, straight: float) -> None:
    some = walk(600, 2)
    metric_map = learn(cells, some, solve=False, lag=lag, straight=straight)
    ways = straight_ways(cells, some, lag, straight)
    assert metric_map.seen == len(some.odour)
    for half in (0, 1):
        moved, share, faced, u = (part[ways.half == half] for part in ways[:-1])
        back, power = u.conj()[:, None], (np.abs(u) ** 2)[:, None]
        assert metric_map.counted[half].tolist() == pytest.approx([power.sum(), len(u)])
        wanted = {
            "spread": moved.T @ moved,
            "ahead": (share * back).T @ moved,
            "shared": share.T @ (power * share),
            "twice": (share * u[:, None] ** 2).T @ share,
            "facing": (faced * back).T @ moved,
            "faced": faced.T @ (power * faced),
        }
        for name, sums in wanted.items():
            mine = metric_map.get_buffer(name)[half].numpy()
            both = np.stack([sums.real, sums.imag], axis=2) if np.iscomplexobj(sums) else sums
            np.testing.assert_allclose(mine, both, atol=1e-4, err_msg=name)


@pytest.mark.parametrize("ridge", [1e-3, 1.0])
def test_map_is_ridge_regression_and_the_share_foretold_what_it_leaves(
    cells: PlaceCells, walked: Walk, ridge: float
) -> None:
    evidence = learn(cells, walked, solve=False)._evidence(slice(0, 2))
    prior = ridge * apart(cells)
    positions, turns, _ = evidence.solve(prior, 30.0)
    torch.testing.assert_close(turns.abs(), torch.ones(CELLS, dtype=torch.double))
    ways = straight_ways(cells, walked)
    wanted = ways.direction * (ways.share @ turns.numpy())
    # in coordinates in which the prior is the identity
    root = np.linalg.cholesky(prior.numpy() * np.square(ways.moved).sum(axis=0).mean())
    white = np.linalg.solve(root, ways.moved.T).T
    both = np.stack([wanted.real, wanted.imag], axis=1)
    trusted = Ridge(1.0, fit_intercept=False, solver="svd").fit(white, both).predict(white)
    mine = ways.moved @ positions.numpy()
    np.testing.assert_allclose(np.stack([mine.real, mine.imag], axis=1), trusted, atol=1e-3)
    left = np.square(np.abs(mine - wanted)).sum()
    assert evidence.cross_validated_r2(positions, turns) == pytest.approx(1 - left / evidence.power, abs=1e-4)


def test_for_the_compass_headings_are_instruments_of_displacements(cells: PlaceCells, walked: Walk) -> None:
    ways = straight_ways(cells, walked)
    toward = ways.direction[:, None] * ways.share
    instruments = np.concatenate([toward.real, toward.imag], axis=1)
    told = Ridge(SMALL * np.square(instruments).sum(axis=0).mean(), fit_intercept=False)
    foretold = told.fit(instruments, ways.moved).predict(instruments)
    found = learn(cells, walked, solve=False)._evidence(slice(0, 2))._instrumented()
    np.testing.assert_allclose(found, foretold.T @ ways.moved, atol=2e-3)


def test_errors_of_smell_turn_a_compass_that_is_right_less_than_least_squares_would(
    cells: PlaceCells,
) -> None:
    clear = walk(12_000, 5)
    noise = 0.12 * torch.randn(clear.odour.shape, generator=torch.Generator().manual_seed(5))
    right = clear._replace(odour=clear.odour + noise, heading=clear.heading + off(clear.place))
    evidence, prior = learn(cells, right, solve=False)._evidence(slice(0, 2)), 1e-3 * apart(cells)
    (placing,) = _solved(evidence.spread + evidence.spread.diagonal().mean() * prior, evidence.ahead)
    turned = spread_of_angle(_synchronised(evidence.ahead @ placing).angle())
    assert turned > 1
    assert spread_of_angle(evidence.solve(prior, 30.0).turns.angle()) < 0.6 * turned


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
    both.partial_fit(cells, FACING, other.odour, other.heading - off(other.place))
    for name in SUMS:
        total = sum(getattr(metric_map, name) for metric_map in apart)
        torch.testing.assert_close(getattr(both, name), total, atol=1e-4, rtol=1e-5)


def assert_left_out(metric_map: MetricMap, cells: PlaceCells, odour: Tensor, said: str) -> None:
    assert said in metric_map.diagnosis()
    recalled = torch.linspace(-3, 3, len(odour))
    position, heading = metric_map(cells, FACING, odour, recalled)
    assert position.isnan().all()
    torch.testing.assert_close(heading, recalled)


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
    noise = 0.09 * torch.randn(len(some.odour), 3, generator=torch.Generator().manual_seed(0))
    return some._replace(odour=some.odour + noise)


def test_of_few_views_with_noise_one_affine_map_for_all_is_learnt(cells: PlaceCells, noisy: Walk) -> None:
    assert_left_out(learn(cells, noisy, stiffness=0.0), cells, noisy.odour, "foretells")
    stiff = learn(cells, noisy)
    assert not stiff.diagnosis()
    position, heading = stiff(cells, FACING, noisy.odour, noisy.heading)
    torch.testing.assert_close(heading.cos(), noisy.heading.cos(), atol=1e-5, rtol=0)
    assert r2_score(*procrustes(noisy.place.numpy(), position.numpy())[:2]) > 0.95
    order = torch.randperm(len(noisy.place), generator=torch.Generator().manual_seed(0))
    lost = noisy._replace(place=noisy.place[order], odour=noisy.odour[order])
    assert_left_out(learn(cells, lost), cells, lost.odour, "foretells")


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
    turns = _synchronised(
        (turned[:, None] * (ahead.sqrt() @ ahead.sqrt().T) * turned.conj()).to(torch.cdouble)
    )
    across = (turns[10:].mean() / turns[:10].mean()).angle().item()
    assert across == pytest.approx(0.7, abs=0.01)
