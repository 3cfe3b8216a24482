"""The eye once more, plainly: in doubles, part by part of a column, for rooms of a plain floor."""

from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from arena.eye.camera import Camera
from arena.rooms.arena import Arena
from arena.rooms.materials import LEVELS, TEXEL, TILE, mip_maps


class Face(NamedTuple):
    """A face in the eye's frame."""

    number: int
    solid: int
    begin: np.ndarray
    side: np.ndarray
    height: float
    far_side: bool
    span: tuple[float, float]

    def near(self, ray: np.ndarray) -> float:
        """1 / depth at which a ray meets its line."""
        return float(np.clip(_cross(ray, self.side) / _cross(self.begin, self.side), 1e-6, 1e4))

    def along(self, ray: np.ndarray) -> float:
        """How far along it a ray meets it, m."""
        length = np.hypot(*self.side)
        where = (ray / self.near(ray) - self.begin) @ self.side / length
        return float(np.clip(where, 0, length))


def plain_view(room: Arena, camera: Camera, pose: np.ndarray) -> np.ndarray:
    """Paint a view, (height, width, 3) in grey levels that need not be whole."""
    scene, horizon = room.scene, camera.height / 2
    assert scene.floor.start < 0
    out = np.zeros((camera.height, camera.width, 3))
    for first, last, faces in stretches(room, camera, pose):
        for c in range(int(first), int(np.ceil(last))):
            low, high = max(first, c), min(last, c + 1)
            gaze, ground, colour = float(camera.height), 0.0, np.array(scene.floor[:3])
            layers = []
            for face in faces:
                rays = [_direction(camera, x) for x in (low, high)]
                scale = camera.focal_length * 0.5 * sum(face.near(ray) for ray in rays)
                foot = max(horizon + scale * (camera.eye_height - ground), 0)
                layers.append((min(foot, gaze), gaze, colour))
                gaze = min(foot, gaze)
                table = scene.faces[face.number]
                if face.far_side:
                    ground, colour = 0.0, np.array(scene.floor[:3])
                    continue
                top = max(horizon + scale * (camera.eye_height - face.height), 0)
                if top < gaze:
                    ends = [table["offset"] + face.along(ray) for ray in rays]
                    material = room.surfaces.materials[room.surfaces.material[face.number]]
                    wall = _wall(material, sorted(ends), camera, scale, (top, gaze))
                    aside = _cross(face.begin, face.side)
                    layers.append((top, gaze, wall * table["left_light" if aside > 0 else "right_light"]))
                    gaze = top
                if table["closed"] and face.height < camera.eye_height:
                    ground, colour = face.height, np.array([table[k] for k in ("red", "green", "blue")])
            layers += [(min(horizon, gaze), gaze, colour), (0.0, min(horizon, gaze), _sky(room, camera, c))]
            for top, bottom, paint in layers:
                rows = np.arange(camera.height)
                share = np.clip(np.minimum(rows + 1, bottom) - np.maximum(rows, top), 0, None)
                out[:, c] += (high - low) * share[:, None] * paint
    return out


def _sky(room: Arena, camera: Camera, c: int) -> np.ndarray:
    rise = np.clip(camera.height / 2 - np.arange(camera.height) - 0.5, 0, None)
    aside = camera.focal_length
    if camera.projection == "perspective":
        aside = np.hypot(aside, c + 0.5 - camera.width / 2)
    sine = (rise / np.hypot(aside, rise))[:, None]
    return (1 - sine) * room.ceiling + sine * (room.zenith or room.ceiling)


def _cross(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def _direction(camera: Camera, x: float) -> np.ndarray:
    """The ray at image coordinate x, linear between the sides of a column."""

    def exactly(side: int) -> np.ndarray:
        if camera.projection == "perspective":
            return np.array([1.0, (camera.width / 2 - side) / camera.focal_length])
        azimuth = np.pi - side / camera.focal_length
        return np.array([np.cos(azimuth), np.sin(azimuth)])

    c = min(int(x), camera.width - 1)
    return (c + 1 - x) * exactly(c) + (x - c) * exactly(c + 1)


def _faces(room: Arena, camera: Camera, pose: np.ndarray) -> Iterator[Face]:
    cosine, sine, width, focal = np.cos(pose[2]), np.sin(pose[2]), camera.width, camera.focal_length
    turned = np.array([[cosine, -sine], [sine, cosine]])
    for f, table in enumerate(room.scene.faces):
        a, b = (
            (np.array([table[k] for k in ends]) - pose[:2]) @ turned for ends in (("x0", "y0"), ("x1", "y1"))
        )
        back = bool(table["closed"] and _cross(a, b) > 0)
        if back and table["height"] >= camera.eye_height:
            continue
        if camera.projection == "panoramic":
            low, high = sorted(focal * (np.pi - np.arctan2(p[1], p[0])) for p in (a, b))
            spans = [(low, high)] if high - low <= width / 2 else [(high, width), (0.0, low)]
        else:
            if max(a[0], b[0]) < 1e-4:
                continue
            ends = [
                p if p[0] >= 1e-4 else p + (q - p) * (1e-4 - p[0]) / (q[0] - p[0])
                for p, q in ((a, b), (b, a))
            ]
            spans = [tuple(sorted(np.clip(width / 2 - focal * p[1] / p[0], 0, width) for p in ends))]
        for span in spans:
            yield Face(f, int(table["solid"]), a, b - a, float(table["height"]), back, span)


def stretches(room: Arena, camera: Camera, pose: np.ndarray) -> Iterator[tuple[float, float, list[Face]]]:
    """Cut the image where what is in sight changes."""
    faces = list(_faces(room, camera, pose))
    edges = sorted({0.0, float(camera.width), *(x for face in faces for x in face.span)})
    found: list[tuple[float, float, list[Face]]] = []
    for begin, high in pairwise(edges):
        low = begin
        while high - low > 1e-7:
            seen, in_order = _in_sight(faces, low, high, camera)
            end = high
            if not in_order and int(low) + 1 < high:
                # Faces cross: each column has the order of its own middle.
                end = int(low) + 1.0
                seen, _ = _in_sight(faces, low, end, camera)
            if found and [face.number for face in found[-1][2]] == [face.number for face in seen]:
                found[-1] = (found[-1][0], end, seen)
            else:
                found.append((low, end, seen))
            low = end
    yield from found


def _in_sight(faces: list[Face], low: float, high: float, camera: Camera) -> tuple[list[Face], bool]:
    """What is not hidden between two image coordinates, from near to far, and whether that is so at both."""
    rays = [_direction(camera, x) for x in (low, high)]
    met = [face for face in faces if face.span[0] <= low + 1e-7 and face.span[1] > low + 1e-7]
    met.sort(key=lambda face: -sum(face.near(ray) for ray in rays) * (1 + 1e-9 * face.far_side))
    depths = np.array([[face.near(ray) for ray in rays] for face in met]).reshape(-1, 2)
    seen: list[Face] = []
    for face in met:
        rise = [[one.near(ray) * (one.height - camera.eye_height) for ray in rays] for one in (*seen, face)]
        if face.far_side:
            visible = any(one.solid == face.solid for one in seen)
        else:
            visible = not any(np.less_equal(rise[-1], nearer).all() for nearer in rise[:-1])
        if visible:
            seen.append(face)
    return seen, bool((np.diff(depths, axis=0) < 1e-6 * depths[1:]).all())


@cache
def _level(material: str, i: int, j: int) -> np.ndarray:
    mips = mip_maps((material,))
    start, shape = mips.level_starts[i, j], (TILE[0] >> i, TILE[1] >> j, 4)
    return mips.texels[0, start : start + np.prod(shape)].reshape(shape)[..., :3].astype(float)


def _resolutions(step: float, coarsest: int) -> list[tuple[int, float]]:
    """At which levels to look at what covers so many texels, and the weight of each."""
    level = 0
    while step > 2 and level < coarsest - 2:
        step, level = step / 2, level + 1
    fade = np.clip((step - 1.9) / 0.1, 0, 1)
    return [(level, 1 - fade), (level + 1, fade)]


def _mean(texels: np.ndarray, low: float, high: float) -> np.ndarray:
    """Average repeating texels over a stretch."""
    k = np.arange(int(np.floor(low)), int(np.ceil(high)) + 1)
    weights = np.clip(np.minimum(high, k + 1) - np.maximum(low, k), 0, None)
    return np.tensordot(weights / weights.sum(), texels[k % len(texels)], 1)


def _window(low: float, high: float) -> tuple[float, float]:
    """Widen a stretch to a texel, or narrow it to two, about its middle."""
    half = 0.5 * np.clip(high - low, 1, 2)
    return 0.5 * (low + high) - half, 0.5 * (low + high) + half


def _wall(
    material: str, ends: list[float], camera: Camera, scale: float, rows: tuple[float, float]
) -> np.ndarray:
    """The wall's colour in each row, (height, 3)."""
    out = np.zeros((camera.height, 3))
    u0, u1 = (end / TEXEL for end in ends)
    step = 1 / (scale * TEXEL)
    for j, down in _resolutions(step, LEVELS[1]):
        for i, across in _resolutions(u1 - u0, LEVELS[0]):
            if down * across == 0:
                continue
            texels = _level(material, i, j)
            column = _mean(texels, *_window(u0 / 2**i, u1 / 2**i))
            for r in range(int(rows[0]), int(np.ceil(rows[1]))):
                above, below = max(r, rows[0]), min(r + 1, rows[1])
                v = [
                    (camera.eye_height + (camera.height / 2 - y) / scale) / TEXEL / 2**j
                    for y in (below, above)
                ]
                low, high = _window(*v)
                out[r] += down * across * _mean(column, max(low, 0), high + max(-low, 0))
    return out
