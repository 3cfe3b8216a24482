import dataclasses
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import k0, k1

from arena.errors import ArenaError
from arena.rooms.arena import Arena
from arena.smell import odour
from arena.smell.odour import FAINTEST, OdourField

ROOM = (-3.0, -2.5, 3.0, 2.5)
Point = tuple[float, float]
Box = tuple[float, float, float, float]


def field(walls: object = (), sources: object = ((-1.5, -1.0),), **fields: object) -> OdourField:
    return OdourField(
        walls=np.array(walls, dtype=float).reshape(-1, 2, 2),
        sources=np.array(sources, dtype=float).reshape(-1, 2),
        **{"solids": [], "bounds": ROOM, "decay_length": 1.5, **fields},
    )


def mirror_images(source: Point, bounds: Box, reach: int = 6) -> np.ndarray:
    """A source and its images in the four walls of a rectangle."""
    x0, y0, x1, y1 = bounds
    return np.array(
        [
            (x0 + 2 * i * (x1 - x0) + a * (source[0] - x0), y0 + 2 * j * (y1 - y0) + b * (source[1] - y0))
            for i in range(-reach, reach + 1)
            for j in range(-reach, reach + 1)
            for a in (-1, 1)
            for b in (-1, 1)
        ]
    )


def exact(xy: np.ndarray, source: Point, bounds: Box, decay_length: float) -> tuple[np.ndarray, np.ndarray]:
    """The concentration and its gradient by the method of images."""
    away = xy[:, None] - mirror_images(source, bounds)
    distance = np.linalg.norm(away, axis=2)
    concentration = k0(distance / decay_length).sum(1) / (2 * np.pi)
    slope = -k1(distance / decay_length) / decay_length / distance / (2 * np.pi)
    return concentration, (slope[..., None] * away).sum(1)


def lattice(bounds: Box, step: float) -> np.ndarray:
    x0, y0, x1, y1 = bounds
    x, y = np.arange(x0, x1, step), np.arange(y0, y1, step)
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


def test_empty_room_is_the_analytic_solution_with_mirror_images() -> None:
    sources = [(-1.5, -1.0), (1.6, 0.9), (1.23, -1.17)]
    odours = field(sources=sources)
    points = lattice(ROOM, 0.117)
    found, slopes = odours.concentration(points), odours.gradient(points)
    for odorant, source in enumerate(sources):
        far = np.linalg.norm(points - source, axis=1) > 0.15
        wanted, slope = exact(points[far], source, ROOM, 1.5)
        np.testing.assert_allclose(found[far, odorant], wanted, rtol=4e-3)
        relative = np.linalg.norm(slopes[far, odorant] - slope, axis=1) / wanted
        assert relative.max() < 0.3
        assert relative[np.linalg.norm(points[far] - source, axis=1) > 0.4].max() < 0.02


@pytest.mark.parametrize(("cell", "worst"), [(0.1, 2e-3), (0.05, 5e-4), (0.025, 1.3e-4)])
def test_error_falls_with_the_square_of_the_cell(cell: float, worst: float) -> None:
    points = lattice(ROOM, 0.213)
    points = points[np.linalg.norm(points - (-1.5, -1.0), axis=1) > 0.7]
    found = field(cell=cell).concentration(points)[:, 0]
    np.testing.assert_allclose(found, exact(points, (-1.5, -1.0), ROOM, 1.5)[0], rtol=worst)


def test_what_is_given_off_is_what_decays() -> None:
    solids = [np.array([(-1, -1), (0.5, -0.8), (0.3, 0.4)]), np.array([(1.0, 1), (1.4, 1), (1.4, 1.3)])]
    walls = [[(-2, 1), (2.1, 0.7)], [(-2.5, -2.5), (-2.5, 1.0)]]
    odours = field(walls, sources=[(-1.5, -1.3), (1.6, 0.2)], solids=solids)
    centres = odours._centres[odours._free]
    total = odours.concentration(centres).sum(0) * 0.05**2
    np.testing.assert_allclose(total, 1.5**2, rtol=1e-9)


def test_source_and_receiver_can_be_exchanged() -> None:
    room = Arena.load("pillar").odours
    pair = room._centres[[20, 90], [60, 30]]
    found = dataclasses.replace(room, sources=pair).concentration(pair)
    assert found[1, 0] == pytest.approx(found[0, 1], rel=1e-9)


def plain(odours: OdourField, xy: np.ndarray, order: tuple[int, int]) -> np.ndarray:
    """Log concentration or its slope by cubic convolution, as written in Keys (1981), table 1."""

    def kernel(s: np.ndarray) -> np.ndarray:
        s = np.abs(s)
        near, far = 1.5 * s**3 - 2.5 * s**2 + 1, -0.5 * s**3 + 2.5 * s**2 - 4 * s + 2
        return np.where(s < 1, near, np.where(s < 2, far, 0))

    def weights(at: np.ndarray, taps: np.ndarray, step: float, order: int) -> np.ndarray:
        away, h = (at[:, None] - taps) / step, 1e-6
        return (kernel(away + h) - kernel(away - h)) / (2 * h * step) if order else kernel(away)

    log, reached, _ = odours._table
    low = np.array(odours.bounds[:2])
    taps = [low[axis] + (np.arange(log.shape[axis]) - 1.5) * odours._step[axis] for axis in (0, 1)]
    wx, wy = (weights(xy[:, axis], taps[axis], odours._step[axis], order[axis]) for axis in (0, 1))
    i, j = np.minimum((xy - low) // odours._step, np.array(reached.shape[:2]) - 1).astype(int).T
    found = np.einsum("pi,pj,ijk->pk", wx, wy, log)
    return np.where(reached[i, j], found, 0.0 if any(order) else np.log(FAINTEST))


@pytest.mark.parametrize("count", [1, 400])
@pytest.mark.parametrize("walls", [(), [[(0.3, -2.5), (0.3, 2.5)]]])
def test_kernel_agrees_with_a_plain_convolution(walls: object, count: int) -> None:
    odours = field(walls, sources=[(-1.5, -1.0), (1.6, 0.9)], cell=0.07)
    assert odours._step[0] != odours._step[1]
    points = np.random.default_rng(0).uniform(ROOM[:2], ROOM[2:], (count, 2))
    points = np.vstack([points, [ROOM[:2], ROOM[2:], (-3.0, 2.5), (0.0, -2.5)]])[-count:]
    logarithm, by_x, by_y = (plain(odours, points, order) for order in ((0, 0), (1, 0), (0, 1)))
    found = odours.concentration(points)
    np.testing.assert_allclose(found, np.exp(logarithm), rtol=1e-12)
    slopes = found[..., None] * np.stack([by_x, by_y], axis=-1)
    np.testing.assert_allclose(odours.gradient(points), slopes, rtol=1e-7, atol=1e-8)


def test_points_may_lie_anyhow_in_memory() -> None:
    odours, poses = field(), np.random.default_rng(0).uniform(-2, 2, (9, 3))
    wanted = odours.concentration(poses[:, :2].copy())
    np.testing.assert_array_equal(odours.concentration(poses[:, :2]), wanted)
    np.testing.assert_array_equal(odours.concentration(np.asfortranarray(poses[:, :2])), wanted)
    single = poses[:, :2].astype(np.float32)
    np.testing.assert_array_equal(odours.concentration(single), odours.concentration(single.astype(float)))


def test_equal_rooms_are_solved_once(monkeypatch: pytest.MonkeyPatch) -> None:
    solved = []
    real = odour.splu
    monkeypatch.setattr(odour, "splu", lambda matrix: solved.append(matrix) or real(matrix))
    sources = [(0.123, 0.456), (1.0, 1.0), (-1.0, 0.3)]
    here = np.zeros((1, 2))
    first, other = field(sources=sources), field(sources=sources)
    assert first == other
    assert hash(first) == hash(other)
    np.testing.assert_array_equal(first.concentration(here), other.concentration(here))
    assert len(solved) == 1
    different = [
        {"decay_length": 1.4},
        {"walls": [[(0, 1), (1, 1)]]},
        {"cell": 0.06},
        {"sources": sources[:2]},
    ]
    for fields in different:
        assert field(**{"sources": sources, **fields}) != first
    assert first != "first"


@pytest.mark.parametrize("name", ["open_field", "furnished", "pillar"])
def test_positive_and_differentiable_everywhere(name: str) -> None:
    odours = Arena.load(name).odours
    points = np.random.default_rng(0).uniform(ROOM[:2], ROOM[2:], (500, 2)) * 0.999
    assert (odours.concentration(points) > 1e-3).all()
    h = 1e-6
    numeric = [
        (odours.concentration(points + step) - odours.concentration(points - step)) / (2 * h)
        for step in h * np.eye(2)
    ]
    np.testing.assert_allclose(odours.gradient(points), np.stack(numeric, axis=-1), rtol=1e-3, atol=1e-5)


def test_smooth_at_a_centimetre() -> None:
    odours = Arena.load("pillar").odours
    x = np.arange(0.75, 1.5, 0.01)
    line = np.log(odours.concentration(np.stack([x, 0.4 * x - 0.9], axis=1)))
    wanted = np.polynomial.Polynomial.fit(x, line[:, 1], 8)(x)
    np.testing.assert_allclose(line[:, 1], wanted, atol=2e-3)


def test_door_lets_less_odour_through_than_no_wall_and_more_than_a_wall() -> None:
    here = np.array([[1.0, 2.0]])
    wall = [[(0, -2.5), (0, 2.5)]]
    door = [[(0, -2.5), (0, -0.5)], [(0, 0.5), (0, 2.5)]]
    nothing, some, closed = (field(w).concentration(here)[0, 0] for w in ((), door, wall))
    assert closed == pytest.approx(FAINTEST)
    assert 100 * closed < some < 0.7 * nothing
    beside_door = field(door).concentration(np.array([[1.0, 0.0]]))[0, 0]
    assert beside_door > 1.5 * some


@settings(deadline=None, max_examples=25)
@given(
    angle=st.floats(-1.2, 1.2),
    where=st.sampled_from([0.0, 0.025, -0.05, 0.0133, 0.3]),
    bend=st.floats(-0.5, 0.5),
)
def test_no_wall_leaks(angle: float, where: float, bend: float) -> None:
    reach = 9 * np.tan(angle)
    ends = where + np.array([-reach, bend, reach]), np.array([-9, 0, 9])
    a, b, c = np.stack(ends, axis=1)
    odours = field([(a, b), (b, c)], sources=[(-2.9, 0)], cell=0.1)
    far = np.array([[2.9, 0.0]])
    assert odours.concentration(far)[0, 0] == pytest.approx(FAINTEST)
    assert odours.concentration(np.array([[-2.6, 0.0]]))[0, 0] > 0.1


@pytest.mark.parametrize("shift", [0.0, 1e-9, -1e-9, 0.01])
def test_wall_through_cell_centres_is_one_wall(shift: float) -> None:
    """On either side of a wall that halves the room the odour is that of half a room."""
    odours = field([[(0.025 + shift, -2.5), (0.025 + shift, 2.5)]], sources=[(-1.5, -1.0)])
    points = lattice((-2.9, -2.4, -0.4, 2.4), 0.31)
    points = points[np.linalg.norm(points - (-1.5, -1.0), axis=1) > 0.2]
    half = (-3.0, -2.5, 0.025 + shift, 2.5)
    np.testing.assert_allclose(
        odours.concentration(points)[:, 0], exact(points, (-1.5, -1.0), half, 1.5)[0], rtol=0.03
    )


def test_thin_box_stops_odour_too() -> None:
    box = np.array([(0.001, -2.6), (0.011, -2.6), (0.011, 2.6), (0.001, 2.6)])
    assert field(solids=[box]).concentration(np.array([[0.5, 0.0]]))[0, 0] == pytest.approx(FAINTEST)


def test_where_no_odour_arrives_does_not_spoil_what_is_on_this_side_of_the_wall() -> None:
    odours = field([[(0, -2.5), (0, 2.5)]], sources=[(-1.5, -1.0)])
    points = lattice((-0.5, -2.4, -0.03, 2.4), 0.0113)
    wanted = exact(points, (-1.5, -1.0), (-3.0, -2.5, 0.0, 2.5), 1.5)[0]
    np.testing.assert_allclose(odours.concentration(points)[:, 0], wanted, rtol=3e-3)
    beyond = lattice((0.03, -2.4, 0.5, 2.4), 0.0113)
    assert (odours.concentration(beyond) == odours.concentration(np.array([[2.0, 2.0]]))).all()
    assert (odours.gradient(beyond) == 0).all()


def test_source_beside_a_wall_stays_on_its_side() -> None:
    odours = field([[(0, -2.5), (0, 2.5)]], sources=[(-0.011, 0.3), (0.011, 0.3)])
    left, right = odours.concentration(np.array([[-0.5, 0.3], [0.5, 0.3]]))
    assert left[1] == right[0] == pytest.approx(FAINTEST)
    assert min(left[0], right[1]) > 0.2


def test_no_sources_no_odorants() -> None:
    odours = field(sources=[])
    assert odours.concentration(np.zeros((4, 2))).shape == (4, 0)
    assert odours.gradient(np.zeros((4, 2))).shape == (4, 0, 2)


@pytest.mark.parametrize("point", [(3.01, 0), (0, -2.6), (np.nan, 0), (0, np.inf)])
def test_points_out_of_bounds_are_refused(point: Point) -> None:
    with pytest.raises(ArenaError, match="outside the room"):
        field().concentration(np.array([(0.0, 0.0), point]))


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"sources": [(4.0, 0.0)]}, "odour source 0 .* outside the room"),
        ({"walls": [[(0.02, -1), (0.02, 1)], [(-0.02, -1), (-0.02, 1)]], "sources": [(0, 0)]}, "too narrow"),
        ({"bounds": (0.0, 0.0, 900.0, 900.0)}, "odour cells"),
        ({"decay_length": 0.0}, "decay_length"),
        ({"cell": np.nan}, "cell"),
    ],
)
def test_what_the_grid_cannot_resolve_is_refused(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(ArenaError, match=message):
        field(**wrong).concentration(np.array([[1.0, 1.0]]))


def test_solids_that_coincide_part_the_odour_as_one_does() -> None:
    angle = np.arange(32) * np.pi / 16
    outline = 0.4 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    xy = np.random.default_rng(0).uniform([0.5, -1], [2.5, 1], (50, 2))
    one, many = (field(solids=[outline] * count, cell=0.2).concentration(xy) for count in (1, 300))
    np.testing.assert_array_equal(one, many)


def test_ways_are_parted_by_the_walls_that_shapely_says() -> None:
    rng = np.random.default_rng(1)
    walls, a = rng.uniform(-3, 3, (40, 2, 2)), rng.uniform(-3, 3, (300, 2))
    b = a + rng.normal(scale=0.2, size=a.shape)
    ways = shapely.linestrings(np.stack([a, b], axis=1))
    wanted = shapely.intersects(ways, shapely.multilinestrings(walls))
    assert 0.1 < wanted.mean() < 0.9
    np.testing.assert_array_equal(field(walls)._parted(a, b), wanted)
