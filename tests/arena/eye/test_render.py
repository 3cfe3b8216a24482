import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from arena.eye.camera import Camera
from arena.rooms.arena import Arena, gallery
from arena.rooms.materials import texture
from tests.arena.plain_eye import plain_view
from tests.arena.reference import (
    BEFORE_BOXES,
    BEHIND_LOW_BOXES,
    PLATFORM,
    between_texels,
    free_poses,
    supersampled,
)

CAMERAS = [Camera.panoramic(120, 40), Camera.perspective(64, 48)]


@pytest.mark.parametrize("name", [*gallery(), "low boxes"])
def test_pixels_are_those_of_the_plain_eye(name: str) -> None:
    room, poses = BEHIND_LOW_BOXES, BEFORE_BOXES
    if name != "low boxes":
        # The plain eye has no textured floors.
        room = Arena.create(**{**Arena.load(name).model_dump(), "floor": (120, 110, 100)})
        poses = free_poses(room, 2)
    for camera in (
        Camera.perspective(120, 90),
        Camera.perspective(40, 120, field_of_view=0.3, eye_height=0.02),
        Camera.perspective(64, 48, eye_height=0.1),
        Camera.panoramic(180, 30),
        Camera.panoramic(90, 15),
    ):
        wanted = np.rint([plain_view(room, camera, pose) for pose in poses])
        error = np.abs(camera.render(room, poses) - wanted)
        assert (error > 1).mean() < 1e-3
        assert (error > 0).mean() < 0.03


@pytest.mark.parametrize("name", ["furnished", "pillar"])
@pytest.mark.parametrize("camera", CAMERAS)
def test_pixels_are_means_of_the_texture_they_cover(name: str, camera: Camera) -> None:
    arena = Arena.load(name)
    poses = free_poses(arena, 3)
    wanted = np.stack([supersampled(arena, camera, pose, 12) for pose in poses])
    error = np.abs(camera.render(arena, poses) - wanted)
    assert error.mean() < 1.4
    assert np.sqrt((error**2).mean()) < 4


@pytest.mark.parametrize("camera", CAMERAS)
def test_boxes_lower_than_the_eye_show_their_lids_and_what_stands_behind(camera: Camera) -> None:
    wanted = np.stack([supersampled(BEHIND_LOW_BOXES, camera, pose, 10) for pose in BEFORE_BOXES])
    error = np.abs(camera.render(BEHIND_LOW_BOXES, BEFORE_BOXES) - wanted)
    assert error.mean() < 1.9
    assert np.sqrt((error**2).mean()) < 4.5


def test_climbing_the_middle_column_meets_floor_lids_wall_and_ceiling() -> None:
    camera = Camera.perspective(65, 600, field_of_view=0.15)
    column = camera.render(BEHIND_LOW_BOXES, BEFORE_BOXES[:1])[0, :, 32]
    edges = (camera.height / 2 - np.arange(camera.height + 1)) / camera.focal_length

    def between(low: float, high: float) -> np.ndarray:
        found = column[(edges[1:] > low) & (edges[:-1] < high)]
        assert len(found) >= 2
        return found

    def seen(depth: float, height: float) -> float:
        return (height - camera.eye_height) / depth

    def top_colour(name: str) -> np.ndarray:
        return np.rint(texture(name).mean(axis=(0, 1)))

    assert (between(-1.0, seen(0.5, 0)) == BEHIND_LOW_BOXES.floor).all()
    assert (between(seen(0.5, 0.15), seen(2.5, 0.15)) == top_colour("plaid")).all()
    assert (between(seen(2.5, 0.2), seen(3.1, 0.2)) == top_colour("tiles")).all()
    assert between(seen(3.1, 0.2), seen(3.9, 1)).std(axis=0).min() > 5
    assert (between(seen(3.9, 1), 1.0) == BEHIND_LOW_BOXES.ceiling).all()


@pytest.mark.parametrize("heading", [0.0, 0.9])
def test_magnified_texels_are_interpolated(heading: float) -> None:
    camera, pose = Camera.perspective(64, 48, field_of_view=0.1), np.array([3.6, 0.3, heading])
    wanted = supersampled(BEHIND_LOW_BOXES, camera, pose, 3, between_texels)
    error = np.abs(camera.render(BEHIND_LOW_BOXES, pose[None])[0] - wanted)
    assert error.max() < 1.5


LAMP = {"azimuth_deg": 40.0, "elevation_deg": 45.0, "strength": 0.6}


@pytest.mark.parametrize("camera", [Camera.panoramic(120, 40), Camera.perspective(66, 49)])
@pytest.mark.parametrize("look", [{"floor": "mosaic"}, {"light": LAMP}, {"zenith": (20, 60, 190)}])
def test_floors_lamps_and_skies_are_as_single_rays_find_them(camera: Camera, look: dict[str, object]) -> None:
    room = Arena.create(**{**Arena.load("furnished").model_dump(), **look})
    poses = free_poses(room, 2)
    error = camera.render(room, poses) - np.stack([supersampled(room, camera, pose, 12) for pose in poses])
    assert np.abs(error).mean() < (6 if "floor" in look else 1.4)
    assert np.abs(error.mean(axis=(0, 1, 2))).max() < 0.5
    plain = camera.render(Arena.load("furnished"), poses) - np.stack(
        [supersampled(room, camera, pose, 4) for pose in poses]
    )
    assert np.abs(error).mean() < 0.5 * np.abs(plain).mean()


def test_a_wall_taller_than_its_tile_repeats_it() -> None:
    wall = {"start": (2, -9), "end": (2, 9), "height": 4.0, "material": "granite"}
    room = Arena.create(name="tall", platform=PLATFORM, walls=[wall])
    for camera in (Camera.perspective(80, 120), Camera.perspective(60, 300, field_of_view=0.8)):
        for pose in np.array([(0, 0, 0.0), (0.5, 0.3, 0.9), (1.5, 0, 0.4)]):
            error = np.abs(camera.render(room, pose[None])[0] - supersampled(room, camera, pose, 8))
            assert error.mean() < 2.5
            assert error.mean(axis=(1, 2)).max() < 12


coordinate = st.integers(-4, 4).map(lambda n: n / 2) | st.floats(-2, 2)
point = st.tuples(coordinate, coordinate)
height = st.sampled_from([0.05, 0.3, 0.6, 1.0]) | st.floats(0.01, 3)
wall = st.fixed_dictionaries({"start": point, "end": point, "height": height, "material": st.just("brick")})
box = st.fixed_dictionaries(
    {
        "center": point,
        "size": st.tuples(st.floats(0.01, 2), st.floats(0.01, 2)),
        "angle_deg": st.sampled_from([0.0, 45.0]) | st.floats(-180, 180),
        "height": height,
        "material": st.just("oak"),
    }
)
solid_walls = st.lists(wall.filter(lambda w: np.hypot(*np.subtract(w["end"], w["start"])) > 1e-3), max_size=4)
heading = st.integers(-4, 4).map(lambda n: n * np.pi / 4) | st.floats(-np.pi, np.pi)


@given(
    walls=solid_walls,
    boxes=st.lists(box, min_size=1, max_size=3),
    poses=st.lists(st.tuples(coordinate, coordinate, heading), min_size=1, max_size=3),
)
@example(
    walls=[{"start": (-1.0, 0.0), "end": (1.0, 0.0), "material": "brick"}],
    boxes=[{"center": (1.5, 0.0), "size": (1.0, 1.0), "material": "oak"}],
    poses=[(0.0, 0.0, n * np.pi / 4) for n in range(8)]
    + [(-1.0, 0.0, 0.0), (1.0, 0.5, 1.0), (1.5, 0.0, 0.0)],
)
@settings(max_examples=60, deadline=None)
def test_what_covers_a_pixel_adds_up_to_one(
    walls: list[dict[str, object]], boxes: list[dict[str, object]], poses: list[tuple[float, float, float]]
) -> None:
    colour = (37, 141, 213)
    room = Arena.create(
        name="one colour", platform=PLATFORM, walls=walls, boxes=boxes, floor=colour, ceiling=colour
    )

    scene = room.scene
    faces = scene.faces.copy()
    faces["red"], faces["green"], faces["blue"] = colour
    texels = np.tile(np.array([*colour, 0], np.uint8), len(scene.texels) // 4)
    room.__dict__["scene"] = scene._replace(faces=faces, texels=texels)
    for camera in (Camera.panoramic(24, 11), Camera.perspective(24, 11), Camera.perspective(23, 12)):
        assert (camera.render(room, np.array(poses)) == colour).all()
