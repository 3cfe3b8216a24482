import subprocess

import numpy as np
import pytest

from arena import Arena, Arm
from arena.angles import wrap_angle
from arena.rooms.parts import Box
from cogmap.errors import CogmapError
from cogmap.evaluation.deviation import path_length
from cogmap.evaluation.joint_ways import joint_length, shortest_joint_ways
from cogmap.evaluation.peers.prm import prm_joint_paths, prm_paths
from cogmap.evaluation.shortest import shortest_lengths
from tests.cogmap.evaluation.rooms import ROOM


def test_ompl_plans_around_the_box_no_shorter_than_the_shortest() -> None:
    pytest.importorskip("ompl")
    pairs = np.array(
        [[[-1.5, 0, 0], [1.5, 0, 1]], [[-1.5, 1, 0], [1.5, -1, 3]], [[0, 1.5, 2], [0, -1.5, -2]]], dtype=float
    )
    paths = prm_paths(ROOM, pairs, radius=0.2, milestones=200)
    assert paths is not None
    for path, pair, least in zip(paths, pairs, shortest_lengths(ROOM, pairs[:, :, :2], 0.2), strict=True):
        np.testing.assert_allclose(path[[0, -1]], pair, atol=1e-9)
        assert least * 0.999 <= path_length(path) < 2 * least
        assert ROOM.is_free(path[:, :2], 0.2).all()


def test_ompl_plans_joints_around_a_box() -> None:
    pytest.importorskip("ompl")
    boxed = Arena.load("furnished").model_copy(
        update={"boxes": (Box(center=(1.4, 0.0), size=(0.3, 0.3), material="oak"),)}
    )
    pairs = np.array([[[-0.6, 0.0], [0.6, 0.0]], [[3.0, 0.0], [-3.0, 0.0]]])
    paths = prm_joint_paths(boxed, pairs, arm=Arm(), milestones=400)
    assert paths is not None
    for path, pair, least in zip(paths, pairs, shortest_joint_ways(boxed, Arm(), pairs), strict=True):
        np.testing.assert_allclose(wrap_angle(path[[0, -1]] - pair), 0, atol=1e-9)
        assert 0.95 * least <= joint_length(path) < 2 * least


def test_without_ompl_there_is_no_peer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    assert prm_paths(ROOM, np.zeros((1, 2, 3)), radius=0.2, milestones=5) is None


def test_when_ompl_fails_or_takes_too_long_it_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: True)

    def fail(*_: object, **__: object) -> subprocess.CompletedProcess[str]:
        return subprocess.CompletedProcess([], 3, "", "lost\n")

    def dawdle(*_: object, timeout: float, **__: object) -> None:
        raise subprocess.TimeoutExpired("ompl", timeout)

    monkeypatch.setattr(subprocess, "run", fail)
    with pytest.raises(CogmapError, match=r"OMPL failed with code 3: lost$"):
        prm_paths(ROOM, np.zeros((1, 2, 3)), radius=0.2, milestones=5)
    monkeypatch.setattr(subprocess, "run", dawdle)
    with pytest.raises(CogmapError, match="not done after 7 s"):
        prm_paths(ROOM, np.zeros((1, 2, 3)), radius=0.2, milestones=5, patience=7.0)
