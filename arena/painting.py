"""The kernels that paint what the eye sees.

Within a part of a column the gaze climbs from the floor at the animal's feet to the ceiling, painting
whatever is not hidden behind something nearer. A solid lower than the eye is ground from its near face to its
far one, in the colour of its lid. Four columns at a time are copied into the image.
"""

import typing

import numpy as np
from jaxtyping import Float, Int, UInt8, UInt32
from numba import njit, prange

from arena.materials import LEVELS, TEXEL
from arena.raycast import HIT, SIGHT, TOUCH, Faces, Lens, Poses, look, meet, nearness, split, touch
from arena.texturing import BLOCK, Ground, fade_in, paint_backdrop, paint_ground, paint_wall, unroll, whole


@njit(cache=True, error_model="numpy", forceinline=True)
@typing.no_type_check
def _texel(x: float, one: np.record, face: np.record, sight: np.record, rays: tuple) -> float:
    """Where along its texture a touching face is met by the ray at x."""
    (a0, l0), (a1, l1) = rays
    ahead, left = a0 + x * (a1 - a0), l0 + x * (l1 - l0)
    along = sight.at + (sight.along * ahead + sight.across * left) / nearness(one, x)
    return (face.offset + min(max(along, 0.0), sight.length)) * (1.0 / TEXEL)


@njit(cache=True, error_model="numpy", forceinline=True)
@typing.no_type_check
def _paint_face(
    rows: tuple,
    part: tuple,
    scale: float,
    one: np.record,
    face: np.record,
    sight: np.record,
    rays: tuple,
    lens: Lens,
    texels: np.ndarray,
    place: np.ndarray,
    strip: np.ndarray,
    texel: np.ndarray,
    mix: np.ndarray,
    column: np.ndarray,
) -> None:
    """Add a face to the rows between two image heights of a part of a column, `scale` pixels to a metre."""
    gain = face.left_light if sight.aside > 0.0 else face.right_light
    along = _texel(part[0], one, face, sight, rays), _texel(part[1], one, face, sight, rays)
    top, bottom = rows
    step, level = 1.0 / (scale * TEXEL), 0
    v = lens.eye / TEXEL + 0.5 * lens.height * step
    while step > 2.0 and level < LEVELS[1] - 2:
        step, v, level = 0.5 * step, 0.5 * v, level + 1
    fade = fade_in(step)
    for layer in range(2 if fade > 0.0 else 1):
        share = (part[1] - part[0]) * (fade if layer == 1 else 1.0 - fade)
        if layer == 1:
            step, v, level = 0.5 * step, 0.5 * v, level + 1
        up = max(int(v - bottom * step) - 1, 0), int(v - top * step) + 3
        unroll(along, up, level, gain, face.start, texels, place, strip)
        paint_wall(rows, share, (v - up[0], step), strip, texel, mix, column)


@njit(cache=True, error_model="numpy", forceinline=True)
@typing.no_type_check
def _climb(
    eye: tuple,
    part: tuple,
    rows: tuple,
    hits: np.ndarray,
    touches: np.ndarray,
    faces: np.ndarray,
    sights: np.ndarray,
    rays: tuple,
    lens: Lens,
    floor: Ground,
    texels: np.ndarray,
    place: np.ndarray,
    backdrop: np.ndarray,
    strip: np.ndarray,
    texel: np.ndarray,
    mix: np.ndarray,
    column: np.ndarray,
) -> None:
    """Let the gaze climb one part of a column past the faces it meets."""
    weight = part[1] - part[0]
    peak, gaze, horizon = float(rows[0]), float(rows[1]), 0.5 * lens.height
    ground, colour = 0.0, floor
    for i in range(len(hits)):
        one, scale = touches[hits[i].touch], lens.focal * hits[i].near
        face, sight = faces[one.face], sights[one.face]
        foot = max(horizon + scale * (lens.eye - ground), peak)
        if foot < gaze:
            paint_ground(foot, gaze, weight, colour, eye, lens, texels, place, column)
            gaze = foot
        if face.closed and sight.aside > 0.0:
            ground, colour = 0.0, floor
            continue
        top = max(horizon + scale * (lens.eye - face.height), peak)
        if top < gaze:
            _paint_face(
                (top, gaze),
                part,
                scale,
                one,
                face,
                sight,
                rays,
                lens,
                texels,
                place,
                strip,
                texel,
                mix,
                column,
            )
            gaze = top
        if gaze <= peak:
            return
        if face.closed and face.height < lens.eye:
            ground, colour = face.height, Ground(face.red, face.green, face.blue, -1, 1.0)
    if gaze > horizon:
        paint_ground(horizon, gaze, weight, colour, eye, lens, texels, place, column)
        gaze = horizon
    paint_backdrop(peak, gaze, weight, backdrop, column)


@njit(cache=True, error_model="numpy", forceinline=True)
@typing.no_type_check
def _finish(rows: tuple, backdrop: np.ndarray, column: np.ndarray, out: np.ndarray) -> None:
    """Cut a column to whole grey levels, between rows of backdrop."""
    low, high = np.uint64(4 * rows[0]), np.uint64(4 * rows[1])
    for k in range(len(out)):
        out[k] = backdrop[k]
    for n in range(whole(4 * (rows[1] - rows[0]))):
        k = low + np.uint64(n)
        out[k] = np.uint8(np.int32(column[k]))
    for n in range(32):
        k = high + np.uint64(n)
        out[k] = backdrop[k]


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _emit(quad: np.ndarray, c: int, count: int, out: np.ndarray) -> None:
    """Copy up to four columns of red, green, blue and a spare byte into the image."""
    for r in range(len(out)):
        for q in range(count):
            for k in range(3):
                out[r, c + q, k] = quad[q, 4 * r + k]


@njit(cache=True, error_model="numpy", forceinline=True)
@typing.no_type_check
def _emit_words(quad: np.ndarray, c: int, out: np.ndarray) -> None:
    """Copy four columns into the image, twelve bytes a row as three words."""
    at = np.uint32(c // 4 * 3)
    one, two = np.uint32(1), np.uint32(2)
    b, g, d = np.uint32(8), np.uint32(16), np.uint32(24)
    for r in range(len(out)):
        p0, p1, p2, p3 = quad[0, r], quad[1, r], quad[2, r], quad[3, r]
        out[r, at] = p0 | p1 << d
        out[r, at + one] = p1 >> b | p2 << g
        out[r, at + two] = p2 >> g | p3 << b


@njit(cache=True, error_model="numpy", forceinline=True)
@typing.no_type_check
def _rows(count: int, faces: np.ndarray, lens: Lens, touches: np.ndarray) -> tuple[int, int]:
    """Which rows of a column are not backdrop."""
    horizon = 0.5 * lens.height
    top, bottom = horizon, horizon
    for k in range(count):
        one = touches[k]
        near = lens.focal * max(nearness(one, one.begin), nearness(one, one.end))
        top = min(top, horizon - near * (faces[one.face].height - lens.eye))
        bottom = max(bottom, horizon + near * lens.eye)
    return max(int(top), 0), min(int(np.ceil(bottom)), lens.height)


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def paint(
    pose: np.ndarray,
    faces: np.ndarray,
    lens: Lens,
    floor: Ground,
    texels: np.ndarray,
    place: np.ndarray,
    backdrop: np.ndarray,
    ray: np.ndarray,
    out: np.ndarray,
    words: np.ndarray,
) -> None:
    """Paint the view from one pose."""
    sights, span = np.empty(len(faces), SIGHT), np.empty((2 * len(faces), 2))
    touches, hits, edges = np.empty(len(span), TOUCH), np.empty(len(span), HIT), np.empty(2 * len(span) + 2)
    strip = np.empty(4 * (int(faces["height"].max() / TEXEL) + BLOCK), np.float32)
    texel, mix = np.empty(lens.height + BLOCK, np.int32), np.empty((3, lens.height + BLOCK), np.float32)
    column, quad = np.empty(backdrop.shape[1], np.float32), np.empty((4, backdrop.shape[1]), np.uint8)
    first, listed = look(pose, faces, lens, sights, span)
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    for c in range(lens.width):
        rows = listed[first[c] : first[c + 1]]
        rays = (ray[c, 0], ray[c, 1]), (ray[c + 1, 0], ray[c + 1, 1])
        ahead, left = 0.5 * (ray[c, 0] + ray[c + 1, 0]), 0.5 * (ray[c, 1] + ray[c + 1, 1])
        eye = pose[0], pose[1], cosine * ahead - sine * left, sine * ahead + cosine * left
        touch(c, rows, rays, sights, span, touches)
        top, bottom = _rows(len(rows), faces, lens, touches)
        bottom = lens.height if floor.start >= 0 else bottom
        behind = backdrop[c % len(backdrop)]
        for k in range(whole(4 * (bottom - top))):
            column[4 * top + k] = np.float32(0.5)  # rounds when cut to whole grey levels below
        for p in range(split(len(rows), faces, lens, touches, edges)):
            part = edges[p], edges[p + 1]
            met = meet(0.5 * (part[0] + part[1]), len(rows), faces, sights, touches, hits)
            _climb(
                eye,
                part,
                (top, bottom),
                hits[:met],
                touches,
                faces,
                sights,
                rays,
                lens,
                floor,
                texels,
                place,
                behind,
                strip,
                texel,
                mix,
                column,
            )
        _finish((top, bottom), behind, column, quad[c % 4])
        if c % 4 == 3 and len(words) > 0:
            _emit_words(quad.view(np.uint32), c - 3, words)
        elif c % 4 == 3 or c == lens.width - 1:
            _emit(quad, c - c % 4, c % 4 + 1, out)


@njit(parallel=True, cache=True, error_model="numpy")
@typing.no_type_check
def render(
    poses: Poses,
    faces: Faces,
    lens: Lens,
    floor: Ground,
    texels: UInt8[np.ndarray, " bytes"],
    place: Int[np.ndarray, "levels_along levels_up"],
    backdrop: UInt8[np.ndarray, "columns blocks"],
    ray: Float[np.ndarray, "width_and_one 2"],
    out: UInt8[np.ndarray, "views height width 3"],
    words: UInt32[np.ndarray, "views height words"],
) -> None:
    """Paint the view from every pose (m, m, rad) into `out`; views run in parallel.

    `texels` and `place` are the textures, as in `arena.scene.Scene`; `backdrop` is an empty world, as in
    `arena.backdrop`. `ray` is the direction (ahead, left) between columns. `words` is the memory of `out` in
    words of four bytes, or has no rows where a row is not made of whole words.
    """
    for i in prange(len(poses)):
        paint(poses[i], faces, lens, floor, texels, place, backdrop, ray, out[i], words[i])
