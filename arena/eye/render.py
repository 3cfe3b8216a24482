"""Rendering: the kernels that paint what the eye sees.

Within a part of a column the gaze climbs from the floor at the animal's feet to the ceiling, painting
whatever is not hidden behind something nearer. A solid lower than the eye is ground from its near face to its
far one, in the colour of its top.
"""

import typing

import numpy as np
from jaxtyping import Float, Int, UInt8, UInt32
from numba import njit, prange

from arena.eye.pixels import emit, emit_words, fill, finish
from arena.eye.raycast import (
    COLUMN_SPAN,
    PROJECTED_FACE,
    RAY_HIT,
    Faces,
    Lens,
    Poses,
    along,
    meet,
    nearness,
    project,
    split,
    touch,
)
from arena.eye.texture_sampling import (
    BLOCK,
    Ground,
    fade_in,
    in_blocks,
    paint_backdrop,
    paint_ground,
    paint_wall,
    unroll,
)
from arena.rooms.materials import LEVELS, TEXEL

ROUNDS = np.float32(0.5)
"""What a column starts from, so that it is rounded when it is cut to whole grey levels."""


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
    level_starts: np.ndarray,
    strip: np.ndarray,
    texel: np.ndarray,
    mix: tuple,
    column: np.ndarray,
) -> None:
    """Add a face to the rows between two image heights of a part of a column, `scale` pixels to a metre."""
    gain = face.left_light if sight.aside > 0.0 else face.right_light
    stretch = one.start, one.stop
    if part != (0.0, 1.0):
        stretch = along(part[0], one, face, sight, rays), along(part[1], one, face, sight, rays)
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
        unroll(stretch, up, level, gain, face.start, texels, level_starts, strip)
        paint_wall(rows, share, (v - up[0], step), strip, texel, mix, column)


@njit(cache=True, error_model="numpy", forceinline=True)
@typing.no_type_check
def _climb(
    eye: tuple,
    part: tuple,
    rows: tuple,
    met: int,
    hits: np.ndarray,
    touches: np.ndarray,
    faces: np.ndarray,
    sights: np.ndarray,
    rays: tuple,
    lens: Lens,
    floor: Ground,
    texels: np.ndarray,
    level_starts: np.ndarray,
    backdrop: np.ndarray,
    behind: int,
    strip: np.ndarray,
    texel: np.ndarray,
    mix: tuple,
    column: np.ndarray,
) -> None:
    """Let the gaze climb one part of a column past the faces it meets."""
    weight = part[1] - part[0]
    peak, gaze, horizon = float(rows[0]), float(rows[1]), 0.5 * lens.height
    ground, colour = 0.0, floor
    for i in range(met):
        one, scale = touches[hits[i].touch], lens.focal * hits[i].near
        face, sight = faces[one.face], sights[one.face]
        foot = max(horizon + scale * (lens.eye - ground), peak)
        if foot < gaze:
            paint_ground(foot, gaze, weight, colour, eye, lens, texels, level_starts, column)
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
                level_starts,
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
        paint_ground(horizon, gaze, weight, colour, eye, lens, texels, level_starts, column)
        gaze = horizon
    paint_backdrop(peak, gaze, weight, backdrop, behind, column)


@njit(cache=True, error_model="numpy", forceinline=True)
@typing.no_type_check
def _rows(low: int, high: int, faces: np.ndarray, lens: Lens, touches: np.ndarray) -> tuple[int, int]:
    """Which rows of a column are not backdrop."""
    horizon = 0.5 * lens.height
    top, bottom = horizon, horizon
    for k in range(low, high):
        one = touches[k]
        near = lens.focal * max(nearness(one, one.begin), nearness(one, one.end))
        top = min(top, horizon - near * (faces[one.face].height - lens.eye))
        bottom = max(bottom, horizon + near * lens.eye)
    return max(int(top), 0), min(int(np.ceil(bottom)), lens.height)


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _paint(
    pose: np.ndarray,
    faces: np.ndarray,
    lens: Lens,
    floor: Ground,
    texels: np.ndarray,
    level_starts: np.ndarray,
    backdrop: np.ndarray,
    ray: np.ndarray,
    out: np.ndarray,
    words: np.ndarray,
) -> None:
    """Paint the view from one pose."""
    sights, span = np.empty(len(faces), PROJECTED_FACE), np.empty((2 * len(faces), 2))
    hits, edges = np.empty(len(span), RAY_HIT), np.empty(2 * len(span) + 2)
    strip = np.zeros(4 * (int(faces["height"].max() / TEXEL) + BLOCK), np.float32)
    texel, rows = np.empty(lens.height + BLOCK, np.int32), lens.height + BLOCK
    mix = np.empty(rows, np.float32), np.empty(rows, np.float32), np.empty(rows, np.float32)
    column, quad = np.empty(backdrop.shape[1], np.float32), np.empty((4, backdrop.shape[1]), np.uint8)
    quad_words, columns = quad.view(np.uint32), len(backdrop)
    first, listed = project(pose, faces, lens, sights, span)
    touches, painted = np.empty(len(listed), COLUMN_SPAN), np.empty((lens.width, 2), np.int64)
    for c in range(lens.width):
        rays = (ray[c, 0], ray[c, 1]), (ray[c + 1, 0], ray[c + 1, 1])
        touch(c, first[c], first[c + 1], listed, rays, faces, sights, span, touches)
        painted[c] = _rows(first[c], first[c + 1], faces, lens, touches)
    if floor.start >= 0:
        painted[:, 1] = lens.height
    sight = painted[:, 0].min(), painted[:, 1].max()
    fill(0, sight[0], backdrop, out, words)
    fill(sight[1], lens.height, backdrop, out, words)
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    for c in range(lens.width):
        low, high = first[c], first[c + 1]
        rays = (ray[c, 0], ray[c, 1]), (ray[c + 1, 0], ray[c + 1, 1])
        ahead, left = 0.5 * (ray[c, 0] + ray[c + 1, 0]), 0.5 * (ray[c, 1] + ray[c + 1, 1])
        eye = pose[0], pose[1], cosine * ahead - sine * left, sine * ahead + cosine * left
        top, bottom = painted[c, 0], painted[c, 1]
        behind = c if columns > 1 else 0
        for n in range(in_blocks(4 * (bottom - top))):
            column[np.uint64(4 * top) + np.uint64(n)] = ROUNDS
        for p in range(split(low, high, faces, lens, touches, edges)):
            part = edges[p], edges[p + 1]
            met = meet(0.5 * (part[0] + part[1]), low, high, faces, sights, touches, hits)
            _climb(
                eye,
                part,
                (top, bottom),
                met,
                hits,
                touches,
                faces,
                sights,
                rays,
                lens,
                floor,
                texels,
                level_starts,
                backdrop,
                behind,
                strip,
                texel,
                mix,
                column,
            )
        finish((top, bottom), sight, backdrop, behind, column, quad, c & 3)
        if c & 3 == 3 and len(words) > 0:
            emit_words(quad_words, c - 3, sight, words)
        elif c & 3 == 3 or c == lens.width - 1:
            emit(quad, c & ~3, (c & 3) + 1, sight, out)


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def render_alone(
    poses: Poses,
    faces: Faces,
    lens: Lens,
    floor: Ground,
    texels: UInt8[np.ndarray, " bytes"],
    level_starts: Int[np.ndarray, "levels_along levels_up"],
    backdrop: UInt8[np.ndarray, "columns blocks"],
    ray: Float[np.ndarray, "width_and_one 2"],
    out: UInt8[np.ndarray, "views height width 3"],
    words: UInt32[np.ndarray, "views rows words"],
) -> None:
    """Do the work of `render` without threads, which take a while to start."""
    for i in range(len(poses)):
        _paint(poses[i], faces, lens, floor, texels, level_starts, backdrop, ray, out[i], words[i])


@njit(parallel=True, cache=True, error_model="numpy")
@typing.no_type_check
def render(
    poses: Poses,
    faces: Faces,
    lens: Lens,
    floor: Ground,
    texels: UInt8[np.ndarray, " bytes"],
    level_starts: Int[np.ndarray, "levels_along levels_up"],
    backdrop: UInt8[np.ndarray, "columns blocks"],
    ray: Float[np.ndarray, "width_and_one 2"],
    out: UInt8[np.ndarray, "views height width 3"],
    words: UInt32[np.ndarray, "views rows words"],
) -> None:
    """Paint the view from every pose (m, m, rad) into `out`; views run in parallel.

    `texels` and `level_starts` are the textures, as in `arena.eye.scene.Scene`; `backdrop` is an empty
    world, as in `arena.eye.background`. `ray` is the direction (ahead, left) between columns. `words` is the
    memory of `out` in words of four bytes, or has no rows where a row is not made of whole words.
    """
    for i in prange(len(poses)):
        _paint(poses[i], faces, lens, floor, texels, level_starts, backdrop, ray, out[i], words[i])
