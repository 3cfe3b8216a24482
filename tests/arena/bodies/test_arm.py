import numpy as np
import pytest

from arena.bodies.arm import HALF_RANGE, Arm
from arena.errors import ArenaError


def test_the_eye_is_at_the_end_of_the_last_link_and_looks_along_it() -> None:
    arm = Arm(links=(0.7, 0.6, 0.5), base=(0.5, -1.0))
    joints = np.random.default_rng(0).uniform(-np.pi, np.pi, (30, 3))
    angles = np.cumsum(joints, axis=1)
    hand = 0.5 - 1j + (np.array([0.7, 0.6, 0.5]) * np.exp(1j * angles)).sum(axis=1)
    poses = arm.camera_poses(joints)
    np.testing.assert_allclose(poses[:, :2] @ [1, 1j], hand, atol=1e-12)
    np.testing.assert_allclose(np.exp(1j * poses[:, 2]), np.exp(1j * angles[:, -1]), atol=1e-12)
    assert (np.abs(poses[:, 2]) <= np.pi).all()


@pytest.mark.parametrize(
    ("limits", "kinds"),
    [
        ("none", ["circle"] * 3),
        ("one", ["circle", "circle", "line"]),
        ("both", ["line"] * 3),
        ((None, (-1.0, 2.0), None), ["circle", "line", "circle"]),
    ],
)
def test_a_joint_with_limits_is_a_line(limits: object, kinds: list[str]) -> None:
    axes = Arm(links=(0.7, 0.6, 0.5), limits=limits).axes
    assert [axis.kind for axis in axes] == kinds
    wanted = (-1.0, 2.0) if isinstance(limits, tuple) else (-HALF_RANGE, HALF_RANGE)
    assert {axis.limits for axis in axes} <= {None, wanted}
    assert [axis.name for axis in axes] == ["joint_1", "joint_2", "joint_3"]


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"links": (1.0,)}, "links"),
        ({"links": (1.0,) * 5}, "links"),
        ({"limits": "some"}, "limits"),
        ({"limits": (None,)}, "1 limits for 2 links"),
        ({"limits": (None, (1.0, -1.0))}, "the lower first"),
        ({"limits": (None, (-4.0, 4.0))}, "no more than a turn"),
        ({"width": 0.0}, "width"),
    ],
)
def test_bad_parameters_are_refused(fields: dict[str, object], message: str) -> None:
    with pytest.raises(ArenaError, match=message):
        Arm(**fields)


def test_it_reads_back_from_what_a_recording_keeps() -> None:
    arm = Arm(limits=(None, (-1.0, 2.0)), slip=0.05)
    assert Arm(**arm.model_dump(mode="json")) == arm
