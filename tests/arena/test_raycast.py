from collections.abc import Callable

import numpy as np
import pymunk
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arena import camera as eye
from arena.arena import Arena
from arena.camera import Camera
from arena.materials import TEXEL, Weave, texture

PLATFORM = [[[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]]]
Sampler = Callable[[str, np.ndarray, np.ndarray], np.ndarray]


def wall(start: tuple[float, float], end: tuple[float, float], **fields: object) -> dict[str, object]:
    return {"start": start, "end": end, "material": "brick", **fields}


def room(*walls: dict[str, object], **parts: object) -> Arena:
    return Arena.create(name="room", platform=PLATFORM, walls=walls, **parts)


SQUARE = room(*(wall(a, b) for a, b in [((-2, -2), (2, -2)), ((2, -2), (2, 2)), ((2, 2), (-2, 2)), ((-2, 2), (-2, -2))]))
BEHIND_A_STEP = room(
    wall((2.5, -3), (2.5, 3), material="granite"),
    boxes=[
        {"center": (1.6, 0.1), "size": (0.8, 1.0), "angle_deg": 20, "height": 0.15, "material": "plaid"},
        {"center": (2.0, 1.3), "size": (0.4, 0.6), "height": 0.45, "material": "oak"},
    ],
    pillars=[{"center": (1.7, -1.2), "radius": 0.3, "height": 0.2, "material": "mosaic"}],
)  # fmt: skip


def free_poses(arena: Arena, count: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.c_[arena.sample_free(count, 0.18, rng), rng.uniform(-np.pi, np.pi, count)]


def rays(camera: Camera, pose: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Directions in the room of image coordinates x, as long as one unit of depth."""
    if camera.projection == "panoramic":
        ahead, left = np.cos(np.pi - x / camera.focal_length), np.sin(np.pi - x / camera.focal_length)
    else:
        ahead, left = np.ones_like(x), (camera.width / 2 - x) / camera.focal_length
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return np.stack([c * ahead - s * left, s * ahead + c * left], axis=-1)


def nearest_texel(name: str, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    tile = texture(name)
    return tile[np.floor(u / TEXEL).astype(int) % len(tile), np.floor(v / TEXEL).astype(int) % tile.shape[1]]


def between_texels(name: str, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    half = TEXEL / 2
    fu, fv = ((w / TEXEL - 0.5) % 1 for w in (u[..., None], v[..., None]))
    below = (1 - fu) * nearest_texel(name, u - half, v - half) + fu * nearest_texel(name, u + half, v - half)
    above = (1 - fu) * nearest_texel(name, u - half, v + half) + fu * nearest_texel(name, u + half, v + half)
    return (1 - fv) * below + fv * above


def inside(points: np.ndarray, outline: np.ndarray) -> np.ndarray:
    edges = np.roll(outline, -1, axis=0) - outline
    offset = points[..., None, :] - outline
    return np.all(edges[:, 0] * offset[..., 1] > edges[:, 1] * offset[..., 0], axis=-1)


def supersampled(
    arena: Arena, camera: Camera, pose: np.ndarray, samples: int, sampler: Sampler = nearest_texel
) -> np.ndarray:
    """Mean of samples × samples rays a pixel, each traced by itself through a room of opaque faces and lids."""
    x = (np.arange(camera.width * samples) + 0.5) / samples
    y = (np.arange(camera.height * samples)[:, None] + 0.5) / samples
    ray, slope = rays(camera, pose, x), (camera.height / 2 - y) / camera.focal_length
    shape = (len(y), len(x))
    nearest = np.full(shape, np.inf)
    colour = np.empty((*shape, 3))
    colour[:] = np.where(slope[..., None] > 0, arena.ceiling, arena.floor)
    nearest[:] = np.where(slope < 0, camera.eye_height / -slope, np.inf)

    def hide(seen: np.ndarray, depth: np.ndarray, paint: Callable[[np.ndarray, np.ndarray], object]) -> None:
        seen = seen & (depth < nearest)
        rows, columns = np.nonzero(seen)
        nearest[seen] = np.broadcast_to(depth, shape)[seen]
        colour[seen] = paint(rows, columns)

    faces = arena.surfaces
    for f, name in enumerate(faces.materials[m] for m in faces.material):
        side, offset = faces.end[f] - faces.start[f], faces.start[f] - pose[:2]
        with np.errstate(divide="ignore", invalid="ignore"):
            across = ray[:, 0] * side[1] - ray[:, 1] * side[0]
            depth = (offset[0] * side[1] - offset[1] * side[0]) / across
            share = (offset[0] * ray[:, 1] - offset[1] * ray[:, 0]) / across
        z = camera.eye_height + depth * slope
        met = (depth > 0) & (share >= 0) & (share < 1) & (z >= 0) & (z < faces.height[f])
        u = faces.offset[f] + share * np.hypot(*side)
        hide(met, depth, lambda r, c, u=u, z=z, name=name: sampler(name, u[c], z[r, c]))
    for solid in (*arena.boxes, *arena.pillars):
        with np.errstate(divide="ignore"):
            depth = (solid.height - camera.eye_height) / slope
        if solid.height < camera.eye_height:
            over = inside(pose[:2] + depth[..., None] * ray, solid.outline) & (slope < 0)
            lid = 0.8 * texture(solid.material).reshape(-1, 3).mean(axis=0)
            hide(over, depth, lambda *_, lid=lid: lid)
    return colour.reshape(camera.height, samples, camera.width, samples, 3).mean(axis=(1, 3))


@pytest.mark.parametrize("name", ["open_field", "furnished", "pillar"])
@pytest.mark.parametrize("camera", [Camera.perspective(100, 2), Camera.panoramic(100, 2)], ids=lambda c: c.projection)
def test_depth_is_that_of_segment_queries(name: str, camera: Camera) -> None:
    arena = Arena.load(name)
    space = pymunk.Space()
    for a, b in zip(arena.surfaces.start.tolist(), arena.surfaces.end.tolist(), strict=True):
        space.add(pymunk.Segment(space.static_body, a, b, 0.0))
    poses = free_poses(arena, 20, seed=1)
    depth = camera.depth(arena, poses)
    for pose, row in zip(poses, depth, strict=True):
        direction = rays(camera, pose, np.arange(100) + 0.5)
        ends = pose[:2] + 20 * direction / np.linalg.norm(direction, axis=1, keepdims=True)
        hits = [space.segment_query_first(tuple(pose[:2]), tuple(end), 0.0, pymunk.ShapeFilter()) for end in ends]
        np.testing.assert_allclose(row, [20 * hit.alpha for hit in hits], atol=2e-4)


print
