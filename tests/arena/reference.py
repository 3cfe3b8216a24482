"""A second eye, slow and plain: every ray by itself, in numpy."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import shapely

from arena.eye.camera import Camera
from arena.eye.raycast import CEILING, FLOOR
from arena.rooms.arena import Arena
from arena.rooms.materials import TEXEL, TILE, texture

Sampler = Callable[[str, np.ndarray, np.ndarray], np.ndarray]

PLATFORM = [[[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]]]
BEHIND_LOW_BOXES = Arena.create(
    name="a tall wall behind solids lower than the eye, two of which touch",
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
    blocks=[
        {
            "corners": [(2.4, -1.0), (3.4, -1.2), (3.2, -2.4), (2.9, -1.6)],
            "height": 0.25,
            "material": ("brick", "oak", "leather", "books"),
        }
    ],
)
BEFORE_BOXES = np.array([(0.1, 0.0, 0.0), (-0.5, -0.5, 0.3), (0.2, 0.8, -0.2)])


def free_poses(arena: Arena, count: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
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


class Trace(NamedTuple):
    """What a grid of rays meets, all of one shape."""

    index: np.ndarray
    """As `Camera.identify`."""
    u: np.ndarray
    """Where along its material a face is met, m."""
    z: np.ndarray
    """How high above the floor, m."""
    ground: np.ndarray
    """Where the floor is met, (x, y) in m."""
    elevation: np.ndarray
    """Sine of the angle above the horizon."""


def trace(arena: Arena, camera: Camera, pose: np.ndarray, samples: int) -> Trace:
    """Send samples × samples rays a pixel into a room of opaque faces and lids."""
    x = (np.arange(camera.width * samples) + 0.5) / samples
    y = (np.arange(camera.height * samples)[:, None] + 0.5) / samples
    direction, rise = rays(camera, pose, x), (camera.height / 2 - y) / camera.focal_length
    shape = len(y), len(x)
    depth = np.where(rise < 0, camera.eye_height / -np.where(rise < 0, rise, -1.0), np.inf)
    ground = pose[:2] + np.where(rise < 0, depth, 0.0)[..., None] * direction
    nearest = np.broadcast_to(depth, shape).copy()
    index = np.where(np.broadcast_to(rise <= 0, shape), FLOOR, CEILING)
    u, z = np.zeros(shape), np.zeros(shape)
    faces = arena.surfaces
    for f, (start, end) in enumerate(zip(faces.start, faces.end, strict=True)):
        side, to_start = end - start, start - pose[:2]
        across = direction @ (side[1], -side[0])
        depth = (to_start @ (side[1], -side[0])) / across
        share = (direction @ (-to_start[1], to_start[0])) / across
        columns = np.flatnonzero((depth > 0) & (share >= 0) & (share < 1))
        height = camera.eye_height + depth[columns] * rise
        met = (height >= 0) & (height < faces.height[f]) & (depth[columns] < nearest[:, columns])
        rows, which = np.nonzero(met)
        columns = columns[which]
        nearest[rows, columns], index[rows, columns] = depth[columns], f
        z[rows, columns] = height[rows, which]
        u[rows, columns] = faces.offset[f] + share[columns] * np.hypot(*side)
    for s, solid in enumerate(arena.solids):
        if solid.height < camera.eye_height:
            depth = np.where(
                rise < 0, (solid.height - camera.eye_height) / np.where(rise < 0, rise, -1), np.inf
            )
            points = pose[:2] + np.where(rise < 0, depth, 0.0)[..., None] * direction
            outline = shapely.Polygon(solid.outline)
            shapely.prepare(outline)
            met = shapely.contains_xy(outline, points[..., 0], points[..., 1]) & (depth < nearest)
            nearest[met], index[met] = np.broadcast_to(depth, shape)[met], len(faces.height) + s
    return Trace(index, u, z, ground, np.broadcast_to(rise, shape) / np.hypot(np.hypot(*direction.T), rise))


def nearest_texel(name: str, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    i, j = (np.floor(w / TEXEL).astype(int) for w in (u, v))
    return texture(name)[i % TILE[0], j % TILE[1]].astype(float)


def between_texels(name: str, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Interpolate between the middles of texels; below the lowest of a wall there is nothing."""
    u, v = u - TEXEL / 2, np.maximum(v - TEXEL / 2, 0)
    fu, fv = (((w / TEXEL) % 1)[..., None] for w in (u, v))
    low, high = (
        (1 - fu) * nearest_texel(name, u, w) + fu * nearest_texel(name, u + TEXEL, w) for w in (v, v + TEXEL)
    )
    return (1 - fv) * low + fv * high


def supersampled(
    arena: Arena, camera: Camera, pose: np.ndarray, samples: int, sampler: Sampler = nearest_texel
) -> np.ndarray:
    """Paint a view as the mean over samples × samples rays a pixel, in grey levels that need not be whole."""
    return paint_samples(arena, camera, pose, samples, sampler).mean(axis=(1, 3))


def paint_samples(
    arena: Arena, camera: Camera, pose: np.ndarray, samples: int, sampler: Sampler = nearest_texel
) -> np.ndarray:
    """The colours of all rays, (height, samples, width, samples, 3)."""
    index, u, z, ground, elevation = trace(arena, camera, pose, samples)
    above = _lit(arena, np.array([0.0, 0.0, 1.0]))
    sky = np.array(arena.ceiling)
    zenith = sky if arena.zenith is None else np.array(arena.zenith)
    colour = sky + elevation[..., None] * (zenith - sky)
    met = index == FLOOR
    if isinstance(arena.floor, str):
        colour[met] = above * sampler(arena.floor, *ground[met].T)
    else:
        colour[met] = above * np.array(arena.floor)
    faces = arena.surfaces
    for f, (start, end) in enumerate(zip(faces.start, faces.end, strict=True)):
        met = index == f
        left = np.array([-(end - start)[1], (end - start)[0], 0.0]) / np.hypot(*(end - start))
        facing = left if left[:2] @ (pose[:2] - start) > 0 else -left
        colour[met] = _lit(arena, facing) * sampler(faces.materials[faces.material[f]], u[met], z[met])
    for s, solid in enumerate(arena.solids):
        top_colour = np.mean([texture(side).mean(axis=(0, 1)) for side in solid.sides], axis=0)
        colour[index == len(faces.height) + s] = above * top_colour
    return colour.reshape(camera.height, samples, camera.width, samples, 3)


def _lit(arena: Arena, normal: np.ndarray) -> float:
    """How bright a surface is in the room's light."""
    if arena.light is None:
        return 1.0
    azimuth, elevation = np.deg2rad([arena.light.azimuth_deg, arena.light.elevation_deg])
    lamp = np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)
    return 1 - arena.light.strength * (1 - max(0.0, float(normal @ np.array(lamp))))
