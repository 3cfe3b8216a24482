from pathlib import Path

import numpy as np
import pytest

from arena.acting import journeys
from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.exploration import explore
from arena.eye.camera import Camera
from arena.motions.brownian import Brownian
from arena.motions.policy import Policy, Sensed
from arena.recordings.recording import Recording
from arena.rooms.arena import Arena
from arena.steered import of_one

ROOM = Arena.load("pillar")
EYE = Camera.panoramic(16, 4, noise=0.05)
START = (1.2, 0.3, 0.5)


def some(views: int) -> Policy:
    """Goes by sight, and stops at a view."""
    left = iter(range(views - 1))

    def policy(sensed: Sensed) -> np.ndarray | None:
        return None if next(left, None) is None else sensed["view"].mean(axis=(0, 1))[:2] / 255

    return policy


def go(policy: Policy, **fields: object) -> Recording:
    return explore(ROOM, policy, EYE, body=Disc(slip=0.05), seed=2, **fields)


def test_a_policy_is_recorded_until_it_stops() -> None:
    rec = go(some(300), start=START)
    assert len(rec) == 300
    np.testing.assert_array_equal(np.isnan(rec.commands).all(axis=1), np.arange(300) == 299)
    np.testing.assert_array_equal(rec.times, 0.2 * np.arange(300))
    seen = rec.views[:299].mean(axis=(1, 2))[:, :2] / 255
    np.testing.assert_array_equal(rec.commands[:299], seen)
    gone = journeys(
        ROOM, of_one(some(300)), EYE, np.array([START]), body=Disc(slip=0.05), seed=2, most_steps=400
    )
    np.testing.assert_array_equal(rec.poses, gone.poses[:, 0])
    assert rec.attributes["motion"] == {"kind": "policy", "start": START, "dt": 0.2}
    assert rec.attributes["views"] == 300


def test_or_until_the_views_are_taken_from_anywhere() -> None:
    rec, other = go(some(300), views=20), explore(ROOM, some(300), EYE, views=20, seed=3, dt=0.1)
    assert np.isfinite(rec.commands).all()
    assert ROOM.is_free(rec.poses[:, :2], 0.17).all()
    assert not np.array_equal(rec.poses[0], other.poses[0])
    assert other.times[-1] == pytest.approx(1.9)


def test_on_disk_is_the_same_as_in_memory_and_nothing_there_is_lost(tmp_path: Path) -> None:
    path = tmp_path / "rec.zarr"
    memory, disk = go(some(300)), go(some(300), out=path)
    for name in ("views", "odours", "times", "poses", "commands"):
        np.testing.assert_array_equal(getattr(disk, name)[:], getattr(memory, name)[:])
    with pytest.raises(ArenaError, match="exists already"):
        go(some(300), out=path)
    assert len(Recording.open(path)) == 300


def test_a_policy_that_fails_leaves_nothing(tmp_path: Path) -> None:
    def policy(sensed: Sensed) -> np.ndarray:  # noqa: ARG001
        raise KeyError("lost")

    with pytest.raises(KeyError):
        go(policy, out=tmp_path / "rec.zarr")
    assert not list(tmp_path.iterdir())


def test_bad_input() -> None:
    for fields in ({"views": 0}, {"start": (0.0, 0.0, 0.0)}, {"dt": -1.0}):
        with pytest.raises(ArenaError):
            go(some(9), **fields)
    with pytest.raises(ArenaError, match="Brownian has its own"):
        explore(ROOM, Brownian(), EYE, start=START, views=3)
