import subprocess

import numpy as np
import pytest

from arena import Arena, Box, Wall
from cogmap.errors import CogmapError
from cogmap.navigation import prm
from cogmap.navigation.deviation import path_length
from cogmap.navigation.prm import prm_paths
from cogmap.navigation.shortest import shortest_lengths

ROOM = Arena.create(
    name="one box",
    platform=[[(-2, -2), (2, -2), (2, 2), (-2, 2)]],
    walls=[Wall(start=(-3, -3), end=(3, -3), material="brick")],
    boxes=[Box(center=(0, 0), size=(1, 1), material="oak")],
)


def test_the_shortest_way_around_a_box_is_known() -> None:
    radius = 0.2
    pairs = np.array([[[-1.5, 0], [1.5, 0]], [[-1.5, 1], [1.5, 1]]], dtype=float)
    straight = np.hypot(1, 0.5)
    tangent = np.sqrt(straight**2 - radius**2)
    arc = np.arcsin(radius / straight) + np.arctan2(0.5, 1)
    around = 2 * (tangent + radius * arc) + 1
    np.testing.assert_allclose(shortest_lengths(ROOM, pairs, radius), [around, 3], rtol=1e-3)


def test_the_shortest_way_does_not_depend_on_how_the_room_is_turned() -> None:
    corners = np.array([[-2.0, -2], [2, -2], [2, 2], [-2, 2]])
    pairs = np.random.default_rng(0).uniform([-1.7, -1.7], [-0.8, 1.7], (20, 2, 2)) * [[[1, 1], [-1, 1]]]
    straight = shortest_lengths(ROOM, pairs, 0.2)
    for angle in (0.3, 1.1):
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        turned = ROOM.model_copy(
            update={
                "platform": [[tuple(corner) for corner in (corners @ turn).tolist()]],
                "boxes": [Box(center=(0, 0), size=(1, 1), angle_deg=np.rad2deg(angle), material="oak")],
            }
        )
        np.testing.assert_allclose(shortest_lengths(turned, pairs @ turn, 0.2), straight, rtol=2e-3)


def test_places_that_are_not_free_or_not_joined_are_refused() -> None:
    with pytest.raises(CogmapError, match="not all places are free"):
        shortest_lengths(ROOM, np.array([[[0.0, 0], [1.5, 0]]]), 0.2)
    apart = ROOM.model_copy(
        update={"platform": [[(-2, -2), (-1, -2), (-1, 2), (-2, 2)], [(1, -2), (2, -2), (2, 2), (1, 2)]]}
    )
    with pytest.raises(CogmapError, match="no way leads"):
        shortest_lengths(apart, np.array([[[-1.5, 0.0], [1.5, 0]]]), 0.2)


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


def test_without_ompl_there_is_no_peer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    assert prm_paths(ROOM, np.zeros((1, 2, 3)), radius=0.2, milestones=5) is None


def test_when_ompl_fails_or_takes_too_long_it_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: True)
    monkeypatch.setattr(prm, "PATIENCE", 7)

    def fail(*_: object, **__: object) -> subprocess.CompletedProcess[str]:
        return subprocess.CompletedProcess([], 3, "", "lost\n")

    def dawdle(*_: object, timeout: float, **__: object) -> None:
        raise subprocess.TimeoutExpired("ompl", timeout)

    monkeypatch.setattr(subprocess, "run", fail)
    with pytest.raises(CogmapError, match=r"OMPL failed with code 3: lost$"):
        prm_paths(ROOM, np.zeros((1, 2, 3)), radius=0.2, milestones=5)
    monkeypatch.setattr(subprocess, "run", dawdle)
    with pytest.raises(CogmapError, match="not done after 7 s"):
        prm_paths(ROOM, np.zeros((1, 2, 3)), radius=0.2, milestones=5)
