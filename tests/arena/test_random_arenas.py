"""What must hold in any room, not only in those of the gallery."""

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from arena.bodies.disc import Disc
from arena.rooms.arena import Arena
from tests.arena.strategies import arenas

# beartype picks at random what it looks at in a list.
pytestmark = pytest.mark.filterwarnings("ignore:Do not use the `random` module")
SLOW = settings(deadline=None, max_examples=30, suppress_health_check=list(HealthCheck))
REACH = 0.15
"""The odour of a source is shared by the cells around it, and interpolated from those around them."""


def clearance(room: Arena, xy: np.ndarray) -> np.ndarray:
    """Distance from each point to the nearest edge of anything; −1 off the platform and in solids."""
    border = [
        np.array(ring.coords)
        for part in shapely.get_parts(room.walkable)
        for ring in (part.exterior, *part.interiors)
    ]
    solids = [np.vstack([solid.outline, solid.outline[:1]]) for solid in room.solids]
    chains = [*border, *solids, *(np.array([wall.start, wall.end]) for wall in room.walls)]
    edges = np.concatenate([np.stack([chain[:-1], chain[1:]], axis=1) for chain in chains])
    along = edges[:, 1] - edges[:, 0]
    share = np.clip(((xy[:, None] - edges[:, 0]) * along).sum(-1) / (along**2).sum(-1), 0, 1)
    distance = np.linalg.norm(xy[:, None] - edges[:, 0] - share[..., None] * along, axis=-1).min(axis=1)
    solid = np.any([inside(chain, xy) for chain in solids], axis=0) if solids else False
    platform = np.sum([inside(chain, xy) for chain in border], axis=0) % 2 == 1
    return np.where(platform & ~solid, distance, -1)


def inside(chain: np.ndarray, xy: np.ndarray) -> np.ndarray:
    """Whether a ray to the right crosses a closed chain an odd number of times."""
    a, b = chain[:-1], chain[1:]
    spans = (a[:, 1] > xy[:, None, 1]) != (b[:, 1] > xy[:, None, 1])
    rise = np.where(b[:, 1] == a[:, 1], 1, b[:, 1] - a[:, 1])
    x = a[:, 0] + (xy[:, None, 1] - a[:, 1]) / rise * (b[:, 0] - a[:, 0])
    return (spans & (x > xy[:, None, 0])).sum(axis=1) % 2 == 1


@SLOW
@given(room=arenas(), radius=st.floats(0.01, 0.4), seed=st.integers(0, 999))
def test_free_space_is_where_nothing_is_nearer_than_the_radius(room: Arena, radius: float, seed: int) -> None:
    low, high = np.reshape(room.walkable.bounds, (2, 2))
    xy = np.random.default_rng(seed).uniform(low - 0.2, high + 0.2, (1000, 2))
    found = clearance(room, xy)
    # Round corners are drawn as polygons.
    clear = np.abs(found - radius) > 0.01 * radius
    np.testing.assert_array_equal(room.is_free(xy, radius)[clear], (found > radius)[clear])


def place(room: Arena, radius: float, rng: np.random.Generator) -> np.ndarray:
    """Fifty free places, from rooms that have some."""
    assume(room.free_space(radius).area > 0.01)
    return room.sample_free(50, radius, rng)


@SLOW
@given(room=arenas(), radius=st.floats(0.02, 0.3), seed=st.integers(0, 999))
def test_every_sampled_place_is_free(room: Arena, radius: float, seed: int) -> None:
    xy = place(room, radius, np.random.default_rng(seed))
    assert room.is_free(xy, radius).all()
    assert (clearance(room, xy) > 0.99 * radius).all()


@SLOW
@given(room=arenas(), radius=st.floats(0.03, 0.3), turning=st.floats(0, 5), seed=st.integers(0, 999))
def test_the_body_never_leaves_free_space(room: Arena, radius: float, turning: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    x, y = place(room, radius, rng)[0].tolist()
    drive = Disc(radius=radius, max_speed=2.0, max_turn=10.0).place(room, (x, y, 0.0))
    commands = zip(rng.uniform(-0.5, 2, 300), turning * rng.standard_normal(300), strict=True)
    poses = [drive.pose for speed, turn in commands if drive.step(speed, turn, 0.05) is not None]
    free = room.free_space(radius)
    assert shapely.distance(free, shapely.points([pose[:2] for pose in poses])).max() < 1e-3 + 0.01 * radius
    part = [part for part in shapely.get_parts(free) if part.distance(shapely.Point(x, y)) < 1e-3]
    walked = shapely.points([pose[:2] for pose in poses])
    assert shapely.distance(shapely.union_all(part), walked).max() < 1e-3 + 0.01 * radius


@SLOW
@given(room=arenas(), seed=st.integers(0, 999))
def test_odours_are_positive_and_strongest_at_their_source(room: Arena, seed: int) -> None:
    assume(room.sources)
    rng = np.random.default_rng(seed)
    low, high = np.reshape(room.bounds, (2, 2))
    anywhere = rng.uniform(low, high, (4000, 2))
    assert (np.float32(room.odours.concentration(anywhere)) > 0).all()
    open_air = anywhere[shapely.distance(room.obstacles, shapely.points(anywhere)) > REACH]
    for odorant, source in enumerate(room.odours.sources):
        around = (source + rng.uniform(-REACH, REACH, (200, 2))).clip(low, high)
        peak = room.odours.concentration(around)[:, odorant].max()
        far = open_air[np.linalg.norm(open_air - source, axis=1) > REACH]
        assert peak > 1e-3
        assert (room.odours.concentration(far)[:, odorant] < peak).all()
