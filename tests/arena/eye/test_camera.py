from collections.abc import Iterator

import numba
import numpy as np
import pytest

from arena.errors import ArenaError
from arena.eye.camera import Camera
from arena.rooms.arena import Arena, gallery

PLATFORM = [[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]]
BLUE = (40, 70, 180)


@pytest.fixture(scope="module")
def furnished() -> Arena:
    return Arena.load("furnished")


@pytest.fixture
def threads() -> Iterator[None]:
    before = numba.get_num_threads()
    yield
    numba.set_num_threads(before)


def free_poses(arena: Arena, count: int) -> np.ndarray:
    rng = np.random.default_rng(0)
    return np.c_[arena.sample_free(count, 0.18, rng), rng.uniform(-np.pi, np.pi, count)]


def blue_wall(start: tuple[float, float], end: tuple[float, float], height: float = 1.0) -> Arena:
    wall = {"start": start, "end": end, "height": height, "material": "blue"}
    return Arena.create(name="one blue wall", platform=PLATFORM, walls=[wall])


def blue_columns(camera: Camera, room: Arena, pose: tuple[float, float, float]) -> np.ndarray:
    """Columns whose horizon is blue."""
    image = camera.render(room, np.array([pose], dtype=float))[0]
    return np.flatnonzero((image[camera.height // 2 - 1] == BLUE).all(axis=-1))


@pytest.mark.parametrize("camera", [Camera.perspective(65, 3), Camera.panoramic(65, 3)])
@pytest.mark.parametrize("heading", [0.0, 0.7, np.pi / 2, -2.9])
def test_centre_column_looks_along_the_heading(camera: Camera, heading: float) -> None:
    ahead = np.array([np.cos(heading), np.sin(heading)])
    aside = 0.03 * np.array([-ahead[1], ahead[0]])
    start, end = 0.5 * ahead - aside, 0.5 * ahead + aside
    depth = camera.depth(blue_wall(tuple(start.tolist()), tuple(end.tolist())), np.array([[0, 0, heading]]))[
        0
    ]
    assert depth[32] == pytest.approx(0.5)
    assert np.isfinite(depth).sum() <= 5
    assert np.isfinite(depth[30:35]).sum() == np.isfinite(depth).sum()


def test_left_is_at_smaller_columns() -> None:
    on_the_left = blue_wall((-0.2, 2.0), (0.2, 2.0))
    assert set(blue_columns(Camera.panoramic(64, 4), on_the_left, (0, 0, 0))) == {15, 16}
    on_the_right = blue_wall((-0.2, -2.0), (0.2, -2.0))
    assert set(blue_columns(Camera.panoramic(64, 4), on_the_right, (0, 0, 0))) == {47, 48}
    ahead_left = blue_wall((1.0, 0.2), (1.0, 0.8))
    assert blue_columns(Camera.perspective(64, 48), ahead_left, (0, 0, 0)).max() < 32


def test_column_zero_looks_straight_back_over_the_left_shoulder() -> None:
    camera = Camera.panoramic(64, 4)
    assert set(blue_columns(camera, blue_wall((-2.0, 0.0), (-2.0, 0.4)), (0, 0, 0))) == {0, 1}
    assert set(blue_columns(camera, blue_wall((-2.0, -0.4), (-2.0, 0.0)), (0, 0, 0))) == {62, 63}
    assert set(blue_columns(camera, blue_wall((-2.0, -0.4), (-2.0, 0.4)), (0, 0, 0))) == {0, 1, 62, 63}


@pytest.mark.parametrize("columns", [1, 37, 180, 359])
def test_turning_left_rolls_a_panorama_to_the_right(furnished: Arena, columns: int) -> None:
    camera, poses = Camera.panoramic(), free_poses(furnished, 5)
    turned = camera.render(furnished, poses + np.array([0, 0, 2 * np.pi * columns / camera.width]))
    rolled = np.roll(camera.render(furnished, poses), columns, axis=2)
    assert np.abs(turned.astype(int) - rolled).max() <= 1


@pytest.mark.parametrize(
    "camera", [Camera.perspective(20, 30), Camera.panoramic(20, 30), Camera.panoramic(20, 31)]
)
def test_horizon_is_in_the_middle(camera: Camera) -> None:
    room = blue_wall((900.0, -1.0), (900.0, 1.0), height=0.3)
    image = camera.render(room, np.array([(0, 0, 0.0)]))[0]
    half = camera.height // 2
    assert (image[:half] == room.ceiling).all()
    assert (image[camera.height - half :] == room.floor).all()


@pytest.mark.parametrize("angle", [0.3, np.pi / 2, 2.5])
def test_field_of_view_spans_its_angle(angle: float) -> None:
    camera = Camera.perspective(50, 40, field_of_view=angle)
    edge = 0.8 * np.tan(angle / 2)
    for stretch, seen in [(1.001, range(50)), (0.995, range(1, 49))]:
        room = blue_wall((0.8, -stretch * edge), (0.8, stretch * edge))
        assert blue_columns(camera, room, (0, 0, 0)).tolist() == list(seen)
    pixels_are_square = blue_wall((0.8, -9.0), (0.8, 9.0), height=0.3 + 0.8 * 10.5 / camera.focal_length)
    column = camera.render(pixels_are_square, np.zeros((1, 3)))[0, :, 25]
    assert np.flatnonzero((column[:20] == BLUE).all(axis=1)).tolist() == list(range(10, 20))


def test_a_panorama_has_square_pixels() -> None:
    camera = Camera.panoramic(360, 60)
    column = camera.render(blue_wall((2.0, -9.0), (2.0, 9.0)), np.array([(0, 0, 0.0)]))[0, :, 180]
    rows = np.flatnonzero((column == BLUE).all(axis=1))
    assert camera.focal_length == pytest.approx(57.296, abs=1e-3)
    assert rows[0] == np.ceil(30 - 0.7 / 2 * camera.focal_length)
    assert rows[-1] == np.floor(30 + 0.3 / 2 * camera.focal_length) - 1


def changes(
    room: Arena, camera: Camera, poses: np.ndarray, direction: np.ndarray, sizes: np.ndarray
) -> np.ndarray:
    """Root-mean-square change of the images by the size of a step."""
    still = camera.render(room, poses).astype(np.float32)
    moved = [camera.render(room, poses + size * direction) for size in sizes]
    return np.array([np.sqrt(np.mean((images - still) ** 2)) for images in moved])


def slopes(room: Arena, camera: Camera, count: int) -> tuple[float, float]:
    """Log-log slopes of the change against steps of 0.01 to 1 cm, and turns of 0.01 to 1 degree."""
    poses = free_poses(room, count)
    bearing = np.random.default_rng(1).uniform(-np.pi, np.pi, count)
    ahead, turn = np.zeros_like(poses), np.zeros_like(poses)
    ahead[:, :2] = np.stack([np.cos(bearing), np.sin(bearing)], axis=1)
    turn[:, 2] = 1
    found = []
    for direction, sizes in (
        (ahead, np.geomspace(1e-4, 1e-2, 5)),
        (turn, np.deg2rad(np.geomspace(0.01, 1, 5))),
    ):
        change = changes(room, camera, poses, direction, sizes)
        found.append(float(np.polyfit(np.log(sizes), np.log(change), 1)[0]))
    return found[0], found[1]


@pytest.mark.parametrize(
    ("camera", "count", "moving", "turning"),
    [
        (Camera.perspective(), 40, 0.84, 0.77),
        (Camera.panoramic(), 100, 0.74, 0.84),
        # Rounded to grey levels, a strip that changed in proportion to the step would reach .65 when moved.
        (Camera.panoramic(92, 15), 600, 0.60, 0.70),
    ],
    ids=["perspective", "panoramic", "strip"],
)
def test_small_steps_change_the_image_little(
    furnished: Arena, camera: Camera, count: int, moving: float, turning: float
) -> None:
    found = slopes(furnished, camera, count)
    assert found[0] > moving
    assert found[1] > turning


@pytest.mark.full
@pytest.mark.parametrize("name", gallery())
def test_slopes_in_every_room(name: str) -> None:
    room = Arena.load(name)
    for label, camera, count in (
        ("perspective 320x240", Camera.perspective(), 60),
        ("panoramic 360x60", Camera.panoramic(), 150),
        ("strip 92x15", Camera.panoramic(92, 15), 2000),
    ):
        moving, turning = slopes(room, camera, count)
        print(f"{name}, {label}: slope {moving:.2f} moving, {turning:.2f} turning")  # noqa: T201
        assert moving > 0.5
        assert turning > 0.5


@pytest.mark.parametrize("name", ["furnished", "pillar", "l_shape"])
def test_nothing_jumps(name: str) -> None:
    room, camera = Arena.load(name), Camera.panoramic(92, 15)
    poses = free_poses(room, 1500)
    step = np.array([5e-5, -8e-5, 0])
    change = np.abs(camera.render(room, poses + step).astype(int) - camera.render(room, poses))
    assert change.max() <= 5
    assert (change > 1).mean() < 1e-4


def test_into_a_buffer_and_out_of_it_come_the_same_bits(furnished: Arena) -> None:
    for camera in (Camera.perspective(30, 21), Camera.panoramic(32, 9)):
        poses = free_poses(furnished, 6)
        buffer = np.full((8, camera.height, camera.width, 3), 77, np.uint8)
        images = camera.render(furnished, poses, out=buffer[1:7])
        assert np.shares_memory(images, buffer)
        np.testing.assert_array_equal(images, camera.render(furnished, poses))
        assert (buffer[[0, 7]] == 77).all()


@pytest.mark.parametrize(
    "buffer",
    [np.empty((1, 8, 4, 3), np.uint8), np.empty((1, 4, 8, 3), np.uint8)[:, :, ::-1]],
)
def test_a_buffer_that_does_not_fit_is_refused(furnished: Arena, buffer: np.ndarray) -> None:
    with pytest.raises(ArenaError, match=r"^the buffer is .*; these views need .*uint8"):
        Camera.panoramic(8, 4).render(furnished, np.zeros((1, 3)), out=buffer)


def test_sensor_noise_is_gaussian_and_comes_from_the_generator(furnished: Arena) -> None:
    clean, noisy = Camera.panoramic(80, 20), Camera.panoramic(80, 20, noise=0.02)
    poses = free_poses(furnished, 30)
    images = noisy.render(furnished, poses, rng=np.random.default_rng(3))
    np.testing.assert_array_equal(images, noisy.render(furnished, poses, rng=np.random.default_rng(3)))
    grain = images.astype(float) - clean.render(furnished, poses)
    assert grain.std() == pytest.approx(0.02 * 255, rel=0.02)
    assert abs(grain.mean()) < 0.05
    with pytest.raises(ArenaError, match="give `rng`"):
        noisy.render(furnished, poses)


@pytest.mark.usefixtures("threads")
@pytest.mark.parametrize("camera", [Camera.perspective(64, 48), Camera.panoramic(92, 15)])
def test_same_bits_for_any_number_of_threads_and_any_batch(furnished: Arena, camera: Camera) -> None:
    poses = free_poses(furnished, 13)
    images, depth = camera.render(furnished, poses), camera.depth(furnished, poses)
    for count in {1, min(2, numba.config.NUMBA_NUM_THREADS)}:
        numba.set_num_threads(count)
        np.testing.assert_array_equal(camera.render(furnished, poses), images)
        np.testing.assert_array_equal(camera.depth(furnished, poses), depth)
    parts = [camera.render(furnished, poses[part]) for part in np.split(np.arange(13), [1, 1, 6])]
    np.testing.assert_array_equal(np.concatenate(parts), images)
    np.testing.assert_array_equal(camera.render(furnished, poses[::-1]), images[::-1])


@pytest.mark.parametrize("pose", [(np.nan, 0, 0), (0, np.inf, 0), (0, 0, -np.inf)])
def test_poses_must_be_finite(furnished: Arena, pose: tuple[float, float, float]) -> None:
    poses = np.array([(0, 0, 0), pose], dtype=float)
    for look in (Camera.panoramic().render, Camera.panoramic().depth):
        with pytest.raises(ArenaError, match=r"^pose 1 is .*; give finite x, y .m. and heading .rad.$"):
            look(furnished, poses)


@pytest.mark.parametrize(
    ("fields", "complaint"),
    [
        ({"width": 0}, "width is 0: .*greater than 0"),
        ({"height": -3}, "height is -3: .*greater than 0"),
        ({"width": 10_000}, "width is 10000: .*less than or equal to 8192"),
        ({"eye_height": 0.0}, "eye_height is 0.0: .*greater than 0"),
        ({"eye_height": np.nan}, "eye_height is nan: .*"),
        ({"field_of_view": 0.0}, "field_of_view is 0.0: .*greater than 0"),
        ({"field_of_view": np.nan}, "field_of_view is nan: .*"),
        ({"field_of_view": np.pi}, "field_of_view is 3.14.* below π: use Camera.panoramic .*"),
        ({"field_of_view": 7.0}, "field_of_view is 7 rad.* below π: use Camera.panoramic .*"),
        ({"lens": "fisheye"}, "lens.*"),
    ],
)
def test_what_a_camera_cannot_be_is_one_clear_line(fields: dict[str, object], complaint: str) -> None:
    good = {"projection": "perspective", "width": 8, "height": 6, "field_of_view": 1.0}
    with pytest.raises(ArenaError, match=complaint) as raised:
        Camera(**{**good, **fields})
    assert "\n" not in str(raised.value)


def test_a_panorama_looks_all_around() -> None:
    with pytest.raises(ArenaError, match="a panoramic camera looks all around"):
        Camera(projection="panoramic", width=8, height=6, field_of_view=1.0)


def test_named_constructors_and_stored_fields_agree() -> None:
    for camera in (Camera.perspective(8, 6, field_of_view=1.0, eye_height=0.2), Camera.panoramic(8, 6)):
        assert Camera(**camera.model_dump()) == camera
    with pytest.raises(ArenaError, match="below π"):
        Camera.perspective(field_of_view=4.0)
    with pytest.raises(ArenaError, match="width is -1"):
        Camera.panoramic(-1)


def test_no_poses_no_images(furnished: Arena) -> None:
    assert Camera.panoramic(12, 5).render(furnished, np.empty((0, 3))).shape == (0, 5, 12, 3)
    assert Camera.panoramic(12, 5).depth(furnished, np.empty((0, 3))).shape == (0, 12)
