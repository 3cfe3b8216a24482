import json

import numpy as np
import pytest

from arena import Arena, Arm, Overhead, Recording
from cogmap.coordinates import GeneralisedCoordinates, view_code
from cogmap.errors import CogmapError
from cogmap.pages.live.posture import THICK, WIDE, Mechanism, Posture


@pytest.fixture(scope="module")
def mechanism() -> Mechanism:
    """An arm whose second joint hardly moves: one loop, found in few views."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(view_code, "STEPS", 40)
        room = Arena.load("furnished")
        arm = Arm(links=(1.0, 0.3), limits=(None, (-0.01, 0.01)))
        eye = Overhead(24, 24, span=3.0)
        joints = arm.sample_free(room, 1000, np.random.default_rng(0))
        views = eye.look(room, arm, joints)
        walk = Recording(
            views=views, times=np.arange(1000.0), odours=np.ones((1000, 1), np.float32), joints=joints
        )
        found = GeneralisedCoordinates(components=20).fit(walk.views)
    return Mechanism(room, arm, eye, found, walk)


def test_a_joint_is_bent_and_its_place_moves_round_the_ring(mechanism: Mechanism) -> None:
    posture = Posture(mechanism)
    points, links = [], []
    for angle in np.linspace(-3, 3, 12):
        posture.bend(0, float(angle))
        update = posture.turn(0.0)
        assert update is not None
        shown = json.loads(json.dumps(update.frame, allow_nan=False))
        points.append(shown["point"])
        links.append(shown["links"])
        assert shown["joints"][0] == pytest.approx(angle, abs=1e-3)
        away = np.abs(np.angle(np.exp(1j * (mechanism.joints[:, 0] - angle))))
        nearest = shown["near"][0]["joints"][0]
        assert abs(np.angle(np.exp(1j * (nearest - angle)))) < away.min() + 0.1
    turned = np.unwrap(np.arctan2(*np.array(points)[:, 1::-1].T))
    steps = np.diff(turned)
    assert (np.sign(steps) == np.sign(steps[0])).all()
    assert abs(turned[-1] - turned[0]) == pytest.approx(6.0, abs=0.6)
    np.testing.assert_allclose(np.linalg.norm(np.array(points)[:, :2], axis=1), WIDE, atol=1e-3)
    np.testing.assert_allclose(links[0][0], [(0, 0), (np.cos(3), -np.sin(3))], atol=1e-3)
    assert posture.turn(0.0) is None
    assert posture.turn(0.0, anew=True) is not None


def test_a_joint_that_cannot_bend_so_far_stays_and_says_so(mechanism: Mechanism) -> None:
    posture = Posture(mechanism)
    before = posture.joints.copy()
    posture.bend(1, 1.0)
    np.testing.assert_array_equal(posture.joints, before)
    assert "joint_2" in posture.said
    posture.bend(7, 0.0)
    posture.bend(0, float("nan"))
    np.testing.assert_array_equal(posture.joints, before)


def test_two_phases_lie_on_a_torus(mechanism: Mechanism, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(GeneralisedCoordinates, "loops_", 2)
    angles = np.random.default_rng(0).uniform(-np.pi, np.pi, (50, 2))
    x, y, z = mechanism.drawn(angles).T
    np.testing.assert_allclose((np.hypot(x, y) - WIDE) ** 2 + z**2, THICK**2, atol=1e-9)


def test_the_scenery_is_json_of_the_views_that_are_kept(mechanism: Mechanism) -> None:
    told = json.loads(json.dumps(mechanism.scenery, allow_nan=False))
    assert told["kind"] == "arm"
    assert told["embedding"]["colours"] == ["by joint_1", "by joint_2"]


def test_what_shows_no_coordinates_is_refused(mechanism: Mechanism, monkeypatch: pytest.MonkeyPatch) -> None:
    parts = mechanism.room, mechanism.body, mechanism.eye, mechanism.coordinates
    bare = Recording(views=mechanism.walk.views[:], times=mechanism.walk.times, odours=mechanism.walk.odours)
    with pytest.raises(CogmapError, match="no joints"):
        Mechanism(*parts, bare)
    monkeypatch.setattr(mechanism.coordinates, "coordinates_", None)
    with pytest.raises(CogmapError, match="unresolved"):
        Mechanism(*parts, mechanism.walk)
