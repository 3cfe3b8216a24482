import numpy as np
import pytest

from arena.eye.camera import Camera
from arena.eye.projection import PROJECTED_FACE, direction, met_at, place, ray_at
from arena.rooms.arena import Arena
from tests.arena.reference import free_poses


@pytest.mark.parametrize("camera", [Camera.panoramic(120, 40), Camera.perspective(64, 48)])
def test_rays_meet_faces_where_lines_cross(camera: Camera) -> None:
    room, (lens, _) = Arena.load("furnished"), camera._optics
    faces = room.scene.faces
    sights, span = np.empty(len(faces), PROJECTED_FACE), np.empty((2 * len(faces), 2))
    for x, y, heading in free_poses(room, 4):
        place(np.array([x, y, heading]), faces, lens, sights, span)
        met = 0
        for row in np.flatnonzero(span[:, 1] > span[:, 0]):
            sight, face = sights[row % len(faces)], faces[row % len(faces)]
            for at in np.linspace(*span[row], 5)[1:-1]:
                ahead, left = direction(at, lens)
                depth = 1 / met_at(sight, (ahead, left))
                turn = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
                hit = np.array([x, y]) + depth * turn @ (ahead, left)
                begin, end = np.array([face["x0"], face["y0"]]), np.array([face["x1"], face["y1"]])
                share = (hit - begin) @ (end - begin) / ((end - begin) @ (end - begin))
                assert -1e-9 < share < 1 + 1e-9
                np.testing.assert_allclose(hit, begin + share * (end - begin), atol=1e-9)
                met += 1
        assert met > 5


def test_rays_are_exact_between_columns_and_linear_within() -> None:
    lens, ray = Camera.panoramic(12, 4)._optics
    np.testing.assert_allclose(ray_at(5.0, ray), direction(5.0, lens), atol=1e-15)
    np.testing.assert_allclose(ray_at(5.25, ray), 0.75 * ray[5] + 0.25 * ray[6], atol=1e-15)
    np.testing.assert_allclose(ray_at(12.0, ray), direction(12.0, lens), atol=1e-15)
