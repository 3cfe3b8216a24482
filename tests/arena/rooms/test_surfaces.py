import numpy as np
import pytest
from hypothesis import given, settings

from arena.eye.camera import Camera
from arena.rooms.arena import Arena
from arena.rooms.materials import texture
from tests.arena import strategies

pytestmark = pytest.mark.filterwarnings("ignore:Do not use the `random` module")


@settings(deadline=None, max_examples=30)
@given(strategies.arenas())
def test_every_side_of_everything_is_a_face(room: Arena) -> None:
    faces = room.surfaces
    ends = [(wall.start, wall.end) for wall in room.walls]
    looks = [wall.material for wall in room.walls]
    heights = [wall.height for wall in room.walls]
    whose = [-1 for _ in room.walls]
    for index, solid in enumerate((*room.boxes, *room.pillars, *room.blocks)):
        ends += zip(solid.outline.tolist(), np.roll(solid.outline, -1, axis=0).tolist(), strict=True)
        looks += solid.sides
        heights += [solid.height] * len(solid.sides)
        whose += [index] * len(solid.sides)
    np.testing.assert_array_equal(np.stack([faces.start, faces.end], axis=1), ends)
    assert [faces.materials[index] for index in faces.material] == looks
    np.testing.assert_array_equal(faces.height, heights)
    np.testing.assert_array_equal(faces.solid, whose)
    np.testing.assert_array_equal(faces.closed, faces.solid >= 0)
    floor = {room.floor} if isinstance(room.floor, str) else set()
    assert list(faces.materials) == sorted({*looks, *floor})


@settings(deadline=None, max_examples=30)
@given(strategies.arenas())
def test_the_faces_of_a_solid_share_one_wrapping(room: Arena) -> None:
    faces = room.surfaces
    lengths = np.linalg.norm(faces.end - faces.start, axis=1)
    np.testing.assert_array_equal(faces.offset[faces.solid < 0], 0)
    for index in range(len(room.solids)):
        own = np.flatnonzero(faces.solid == index)
        assert faces.offset[own[0]] == 0
        np.testing.assert_allclose(faces.offset[own[1:]], np.cumsum(lengths[own])[:-1])


def test_a_box_shows_each_side_in_its_material() -> None:
    names = ("blue", "brick", "tiles", "white")
    box = {"center": (0.0, 0.0), "size": (1.0, 1.0), "height": 2.0, "material": names}
    room = Arena.create(name="box", platform=[[(-3, -3), (3, -3), (0, 3)]], walls=[], boxes=[box])
    views = np.array([[0, -1.5, np.pi / 2], [1.5, 0, np.pi], [0, 1.5, -np.pi / 2], [-1.5, 0, 0]])
    middles = Camera.perspective(320, 240).render(room, views)[:, 60:140, 110:210].mean(axis=(1, 2))
    looks = np.array([texture(name).mean(axis=(0, 1)) for name in names])
    nearest = np.linalg.norm(middles[:, None] - looks, axis=2).argmin(axis=1)
    assert nearest.tolist() == [0, 1, 2, 3]
