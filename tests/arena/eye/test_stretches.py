import numpy as np
import pytest

from arena.eye import stretches
from arena.eye.camera import Camera
from arena.eye.projection import PROJECTED_FACE, place
from arena.rooms.arena import Arena
from tests.arena import plain_eye
from tests.arena.reference import BEFORE_BOXES, BEHIND_LOW_BOXES, free_poses


def found(room: Arena, camera: Camera, pose: np.ndarray) -> list[tuple[float, float, list[int]]]:
    """Neighbours that show the same joined, as the painter does."""
    (lens, ray), faces = camera._optics, room.scene.faces
    sights, sweep = np.empty(len(faces), PROJECTED_FACE), stretches.sweep_over(len(faces))
    place(pose, faces, lens, sights, sweep.span)
    stretches.begin(sweep)
    out: list[tuple[float, float, list[int]]] = []
    x = 0.0
    while x < camera.width:
        end, count = stretches.look(x, sweep, (faces, sights), lens, ray)
        seen = sweep.seen[:count].tolist()
        if out and out[-1][2] == seen:
            out[-1] = (out[-1][0], end, seen)
        else:
            out.append((x, end, seen))
        x = end
    return out


@pytest.mark.parametrize("name", ["furnished", "two_rooms", "low boxes"])
@pytest.mark.parametrize("camera", [Camera.panoramic(120, 40), Camera.perspective(64, 48)])
def test_stretches_are_where_single_rays_see_the_same(name: str, camera: Camera) -> None:
    room, poses = (BEHIND_LOW_BOXES, BEFORE_BOXES) if name == "low boxes" else (Arena.load(name), None)
    for pose in free_poses(room, 6) if poses is None else poses:
        ours = found(room, camera, pose)
        plain = list(plain_eye.stretches(room, camera, pose))
        assert [seen for *_, seen in ours] == [[face.number for face in seen] for *_, seen in plain]
        np.testing.assert_allclose([one[:2] for one in ours], [one[:2] for one in plain], atol=1e-6)
        assert ours[0][0] == 0
        assert ours[-1][1] == camera.width
