import numpy as np

from arena.rooms.arena import Arena
from arena.rooms.materials import mean_colour

LAMP = {"azimuth_deg": 90.0, "elevation_deg": 30.0, "strength": 0.5}


def test_faces_are_those_of_the_room() -> None:
    room = Arena.load("pillar")
    faces, surfaces = room.scene.faces, room.surfaces
    np.testing.assert_array_equal(np.c_[faces["x0"], faces["y0"]], surfaces.start)
    np.testing.assert_array_equal(np.c_[faces["x1"], faces["y1"]], surfaces.end)
    for name in ("height", "offset", "closed", "solid"):
        np.testing.assert_array_equal(faces[name], getattr(surfaces, name))
    assert (faces["left_light"] == 1).all()
    assert (faces["right_light"] == 1).all()


def test_a_lamp_lights_the_side_that_faces_it() -> None:
    wall = {"start": (0, 1), "end": (1, 1), "material": "brick"}
    room = Arena.create(name="lit", platform=[[(0, 0), (1, 0), (1, 0.5)]], walls=[wall], light=LAMP)
    (face,) = room.scene.faces
    assert face["left_light"] == np.float64(0.5 + 0.5 * np.cos(np.pi / 6))
    assert face["right_light"] == 0.5
    np.testing.assert_allclose(room.scene.floor[:3], 0.75 * np.array(room.floor))


def test_the_lid_has_the_mean_colour_of_the_sides() -> None:
    box = {"center": (0, 0), "size": (1, 1), "material": ["brick", "oak", "oak", "books"]}
    room = Arena.create(name="lid", platform=[[(2, 0), (3, 0), (3, 1)]], walls=[], boxes=[box])
    wanted = np.mean([mean_colour(name) for name in box["material"]], axis=0)
    for face in room.scene.faces:
        np.testing.assert_allclose([face["red"], face["green"], face["blue"]], wanted, rtol=1e-5)


def test_a_textured_floor_starts_at_its_material() -> None:
    room = Arena.load("plus_maze")
    floor, texels = room.scene.floor, room.scene.texels
    found = texels[floor.start : floor.start + 4 * 1024 * 128].reshape(-1, 4)[:, :3].mean(axis=0)
    np.testing.assert_allclose(found, mean_colour(room.floor), rtol=1e-3)
