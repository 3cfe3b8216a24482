from collections.abc import Callable

import numpy as np
import pymunk
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from arena import camera as eye
from arena.arena import Arena, Box, Pillar
from arena.camera import Camera
from arena.materials import TEXEL, TILE, Weave, texture

PLATFORM = [[[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]]]
BEHIND_LOW_BOXES = Arena.create(
    name="a tall wall behind boxes lower than the eye, two of which touch",
    platform=PLATFORM,
    walls=[
        {"start": (4, -4), "end": (4, 4), "material": "granite"},
        {"start": (2.2, 1.1), "end": (2.9, 2.6), "height": 0.2, "material": "timber"},
    ],
    boxes=[
        {"center": (2.9, 0), "size": (0.6, 0.8), "height": 0.2, "material": "tiles"},
        {"center": (1.6, 0), "size": (2, 0.8), "height": 0.15, "material": "plaid"},
        {"center": (1.9, 1.3), "size": (0.4, 0.6), "angle_deg": 20, "height": 0.45, "material": "oak"},
    ],
    pillars=[{"center": (1.7, -1.2), "radius": 0.4, "height": 0.1, "material": "mosaic"}],
)
BEFORE_BOXES = np.array([(0.1, 0.0, 0.0), (-0.5, -0.5, 0.3), (0.2, 0.8, -0.2)])
CAMERAS = [Camera.panoramic(120, 40), Camera.perspective(64, 48)]
Sampler = Callable[[str, np.ndarray, np.ndarray], np.ndarray]


def free_poses(arena: Arena, count: int) -> np.ndarray:
    rng = np.random.default_rng(0)
    return np.c_[arena.sample_free(count, 0.18, rng), rng.uniform(-np.pi, np.pi, count)]


def rays(camera: Camera, pose: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Directions in the room of image coordinates x, as long as one unit of depth."""
    f = camera.focal_length
    if camera.projection == "panoramic":
        ahead, left = np.cos(np.pi - x / f), np.sin(np.pi - x / f)
    else:
        ahead, left = np.ones_like(x), (camera.width / 2 - x) / f
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return np.stack([c * ahead - s * left, s * ahead + c * left], axis=-1)


def nearest_texel(name: str, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    i, j = (np.floor(w / TEXEL).astype(int) for w in (u, v))
    return texture(name)[i % TILE[0], j % TILE[1]].astype(float)


def between_texels(name: str, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    u, v = u - TEXEL / 2, v - TEXEL / 2
    fu, fv = (((w / TEXEL) % 1)[..., None] for w in (u, v))
    low, high = (
        (1 - fu) * nearest_texel(name, u, w) + fu * nearest_texel(name, u + TEXEL, w) for w in (v, v + TEXEL)
    )
    return (1 - fv) * low + fv * high


def inside(points: np.ndarray, solid: Box | Pillar) -> np.ndarray:
    found = np.ones(points.shape[:-1], bool)
    for a, b in zip(solid.outline, np.roll(solid.outline, -1, axis=0), strict=True):
        found &= (b - a)[0] * (points - a)[..., 1] > (b - a)[1] * (points - a)[..., 0]
    return found


def supersampled(
    arena: Arena, camera: Camera, pose: np.ndarray, samples: int, sampler: Sampler = nearest_texel
) -> np.ndarray:
    """Mean of samples × samples rays a pixel, each sent by itself into a room of opaque faces and lids."""
    x = (np.arange(camera.width * samples) + 0.5) / samples
    y = (np.arange(camera.height * samples)[:, None] + 0.5) / samples
    direction, rise = rays(camera, pose, x), (camera.height / 2 - y) / camera.focal_length
    shape = len(y), len(x)
    nearest = np.broadcast_to(np.where(rise < 0, camera.eye_height / -rise, np.inf), shape).copy()
    colour = np.broadcast_to(np.where(rise[..., None] > 0, arena.ceiling, arena.floor), (*shape, 3)).astype(
        float
    )

    faces = arena.surfaces
    for start, end, height, material, offset in zip(*faces[:5], strict=True):
        side, to_start = end - start, start - pose[:2]
        across = direction @ (side[1], -side[0])
        depth = (to_start @ (side[1], -side[0])) / across
        share = (direction @ (-to_start[1], to_start[0])) / across
        z = camera.eye_height + depth * rise
        met = (depth > 0) & (share >= 0) & (share < 1) & (z >= 0) & (z < height) & (depth < nearest)
        u = np.broadcast_to(offset + share * np.hypot(*side), shape)
        nearest[met] = np.broadcast_to(depth, shape)[met]
        colour[met] = sampler(faces.materials[material], u[met], z[met])
    for solid in (*arena.boxes, *arena.pillars):
        depth = (solid.height - camera.eye_height) / rise
        if solid.height < camera.eye_height:
            met = inside(pose[:2] + depth[..., None] * direction, solid) & (depth > 0) & (depth < nearest)
            colour[met] = 0.8 * texture(solid.material).mean(axis=(0, 1))
    return colour.reshape(camera.height, samples, camera.width, samples, 3).mean(axis=(1, 3))


@pytest.mark.parametrize("name", ["open_field", "furnished", "pillar"])
@pytest.mark.parametrize("make", [Camera.perspective, Camera.panoramic])
def test_depth_is_that_of_segment_queries(name: str, make: Callable[..., Camera]) -> None:
    arena, camera = Arena.load(name), make(100, 2)
    space = pymunk.Space()
    for a, b in zip(arena.surfaces.start.tolist(), arena.surfaces.end.tolist(), strict=True):
        space.add(pymunk.Segment(space.static_body, a, b, 0.0))
    poses = free_poses(arena, 20)
    for pose, depth in zip(poses, camera.depth(arena, poses), strict=True):
        direction = rays(camera, pose, np.arange(100) + 0.5)
        ends = pose[:2] + 20 * direction / np.linalg.norm(direction, axis=1, keepdims=True)
        hits = [
            space.segment_query_first(tuple(pose[:2]), tuple(end), 0.0, pymunk.ShapeFilter()) for end in ends
        ]
        np.testing.assert_allclose(depth, [20 * hit.alpha for hit in hits], rtol=0, atol=2e-4)


@pytest.mark.parametrize("name", ["furnished", "pillar"])
@pytest.mark.parametrize("camera", CAMERAS)
def test_pixels_are_means_of_the_texture_they_cover(name: str, camera: Camera) -> None:
    arena = Arena.load(name)
    poses = free_poses(arena, 3)
    wanted = np.stack([supersampled(arena, camera, pose, 12) for pose in poses])
    error = np.abs(camera.render(arena, poses) - wanted)
    assert error.mean() < 0.5
    assert np.quantile(error, 0.99) < 6.5


@pytest.mark.parametrize("camera", CAMERAS)
def test_boxes_lower_than_the_eye_show_their_lids_and_what_stands_behind(camera: Camera) -> None:
    wanted = np.stack([supersampled(BEHIND_LOW_BOXES, camera, pose, 10) for pose in BEFORE_BOXES])
    error = np.abs(camera.render(BEHIND_LOW_BOXES, BEFORE_BOXES) - wanted)
    assert error.mean() < 0.3
    assert np.quantile(error, 0.99) < 4


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

    def lid(name: str) -> np.ndarray:
        return np.rint(0.8 * texture(name).mean(axis=(0, 1)))

    assert (between(-1.0, seen(0.5, 0)) == BEHIND_LOW_BOXES.floor).all()
    assert (between(seen(0.5, 0.15), seen(2.5, 0.15)) == lid("plaid")).all()
    assert (between(seen(2.5, 0.2), seen(3.1, 0.2)) == lid("tiles")).all()
    assert between(seen(3.1, 0.2), seen(3.9, 1)).std(axis=0).min() > 5
    assert (between(seen(3.9, 1), 1.0) == BEHIND_LOW_BOXES.ceiling).all()


@pytest.mark.parametrize("heading", [0.0, 0.9])
def test_magnified_texels_are_interpolated(heading: float) -> None:
    camera, pose = Camera.perspective(64, 48, field_of_view=0.1), np.array([3.6, 0.3, heading])
    wanted = supersampled(BEHIND_LOW_BOXES, camera, pose, 3, between_texels)
    error = np.abs(camera.render(BEHIND_LOW_BOXES, pose[None])[0] - wanted)
    assert error.max() < 1.5


@pytest.mark.parametrize("make", [Camera.perspective, Camera.panoramic])
def test_depth_in_a_square_room_has_a_closed_form(make: Callable[..., Camera]) -> None:
    corners = [(-2, -2), (2, -2), (2, 2), (-2, 2)]
    walls = [
        {"start": a, "end": b, "material": "brick"}
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    ]
    room, camera = Arena.create(name="square", platform=PLATFORM, walls=walls), make(90, 1)
    poses = np.array([(0, 0, 0), (1.2, -0.4, 2.0), (-1.9, 1.9, -2.5), (0.5, 1.99, np.pi / 2)])
    for pose, depth in zip(poses, camera.depth(room, poses), strict=True):
        direction = rays(camera, pose, np.arange(90) + 0.5)
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        wanted = 1 / (np.abs(direction) / (2 - pose[:2] * np.sign(direction))).max(axis=1)
        np.testing.assert_allclose(depth, wanted, rtol=1e-9)


def test_nothing_ahead_is_infinitely_far() -> None:
    depth = Camera.perspective(9, 3).depth(BEHIND_LOW_BOXES, np.array([(0.0, 0.0, np.pi)]))
    assert np.isinf(depth).all()


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

    def one_colour(names: tuple[str, ...]) -> Weave:
        return Weave(
            sums=np.zeros((len(names), TILE[0] + 1, 3 * TILE[1] + 3), np.float32),
            mean=np.tile(
                np.outer(np.arange(TILE[1] + 1), colour).astype(np.float32).ravel(), (len(names), 1)
            ),
            lid=np.tile(np.array(colour, np.float32), (len(names), 1)),
        )

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(eye, "weave", one_colour)
        for camera in (Camera.panoramic(24, 11), Camera.perspective(24, 11)):
            assert (camera.render(room, np.array(poses)) == colour).all()
