import numpy as np
import pytest

from arena.bodies.arm import Arm
from arena.eye.base import AnyEye, Eye, Watcher, see
from arena.eye.camera import Camera
from arena.eye.overhead import Overhead
from arena.rooms.arena import Arena

ROOM, ARM = Arena.load("furnished"), Arm()
JOINTS = ARM.sample_free(ROOM, 3, np.random.default_rng(0))


class Other:
    """An eye of one's own on the hand."""

    height, width = 8, 24

    def render(self, arena: Arena, poses: np.ndarray, *, rng: np.random.Generator) -> np.ndarray:
        return Camera.panoramic(24, 8, noise=0.05).render(arena, poses, rng=rng)

    def model_dump(self) -> dict[str, object]:
        return {}


def seen(eye: AnyEye, joints: np.ndarray, rng: object) -> np.ndarray:
    out = np.empty((len(joints), eye.height, eye.width, 3), np.uint8)
    see(eye, ROOM, ARM, joints, out=out, rng=rng)
    return out


@pytest.mark.parametrize("eye", [Camera.panoramic(24, 8, noise=0.05), Overhead(16, 12, noise=0.05), Other()])
def test_each_is_seen_as_alone_with_its_own_generator(eye: AnyEye) -> None:
    together = seen(eye, JOINTS, [np.random.default_rng(k) for k in range(3)])
    for k in range(3):
        np.testing.assert_array_equal(seen(eye, JOINTS[k : k + 1], np.random.default_rng(k))[0], together[k])


def test_what_is_on_the_hand_sees_from_there_and_what_hangs_above_sees_the_arm() -> None:
    rng = np.random.default_rng(0)
    hand, above = Camera.panoramic(24, 8), Overhead(16, 12)
    np.testing.assert_array_equal(seen(hand, JOINTS, rng), hand.render(ROOM, ARM.camera_poses(JOINTS)))
    np.testing.assert_array_equal(seen(above, JOINTS, rng), above.look(ROOM, ARM, JOINTS))
    assert isinstance(hand, Eye)
    assert isinstance(above, Watcher)
    assert not isinstance(above, Eye)
