import math

import numpy as np
import pymunk
import pytest

from arena.bodies import rolling
from arena.bodies.disc import Disc
from arena.rooms.arena import Arena, gallery

MOUSE = pymunk.ShapeFilter()


@pytest.mark.parametrize("name", list(gallery()))
def test_queries_are_those_of_chipmunk_bit_by_bit(name: str) -> None:
    room, rng = Arena.load(name), np.random.default_rng(0)
    space = room.space()
    for x, y, heading, reach in rng.uniform((-2, -2, -4, 0), (2, 2, 4, 2), (500, 4)).tolist():
        distance, *nearest = rolling._nearest(x, y, reach, room.edges)
        wanted = space.point_query_nearest((x, y), reach, MOUSE)
        assert (distance, *nearest) == ((reach, x, y) if wanted is None else (wanted.distance, *wanted.point))
        found = rolling.look_ahead(np.array([x, y, heading, 0, 0, 0]), room.edges, reach)
        goal = x + reach * math.cos(heading), y + reach * math.sin(heading)
        ahead = space.segment_query_first((x, y), goal, 0.0, MOUSE)
        np.testing.assert_array_equal(found, math.nan if ahead is None else ahead.normal.angle)


def test_many_bodies_pass_through_each_other() -> None:
    room, rng = Arena.load("pillar"), np.random.default_rng(0)
    starts = [(x, y, 0.0) for x, y in room.sample_free(40, 0.18, rng).tolist()]
    drives = [Disc().place(room, start) for start in starts]
    states = np.array([(*start, 0.0, 0.0, math.nan) for start in starts])
    for _ in range(50):
        commands = rng.uniform(-1, 1, (40, 2))
        rolling.roll_all(states, room.edges, Disc().limits, np.ones((40, 2)), commands, 0.05)
        for drive, command in zip(drives, commands.tolist(), strict=True):
            drive.step(*command, 0.05)
    np.testing.assert_array_equal(states[:, :2], [drive.pose[:2] for drive in drives])
    assert np.isfinite(states[:, rolling.CONTACT]).any()
