"""Rendering: the kernels that paint what the eye sees.

Within a part of a column the gaze climbs from the floor at the animal's feet to the ceiling, painting
whatever is not hidden behind something nearer. A solid lower than the eye is ground from its near face to its
far one, in the colour of its top.
"""

import typing

import numpy as np
from jaxtyping import Float, Int, UInt8, UInt32
from numba import prange

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
from arena.eye.scene import Scene
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
from arena.kernels import kernel
from arena.rooms.materials import LEVELS, TEXEL

ROUNDS = np.float32(0.5)
"""What a column starts from, so that it is rounded when it is cut to whole grey levels."""


class Column(typing.NamedTuple):
    """Where one column of the image looks; numbers only, which cost nothing to take out."""

    eye: tuple
    """Where the eye stands (m) and the direction in the room of the column's middle ray."""
    rays: tuple
    """Directions (ahead, left) at the column's two sides."""
    rows: tuple
    """The first row that is not backdrop, and the first below it that is again."""
    behind: int
    """Its column of the backdrop."""


class Sight(typing.NamedTuple):
    """What the eye has found of a room's faces."""

    faces: Faces
    projected: np.ndarray
    """Of dtype `PROJECTED_FACE`, a row for each face."""
    touches: np.ndarray
    """Of dtype `COLUMN_SPAN`."""
    hits: np.ndarray
    """Of dtype `RAY_HIT`, for one part of a column."""


class Brush(typing.NamedTuple):
    """What one column is painted with, used again for each."""

    strip: np.ndarray
    """Texels of a wall up its height, averaged along what the column covers of it."""
    texel: np.ndarray
    """For each row the first texel of `strip` under it."""
    mix: tuple
    """For each row the weights of that texel and the next two."""
    column: np.ndarray
    """Red, green, blue and a spare number for each row."""


@kernel(forceinline=True)
@typing.no_type_check
def _paint_face(
    rows: tuple,
    part: tuple,
    scale: float,
    met: tuple,
    rays: tuple,
    lens: Lens,
    scene: Scene,
    brush: Brush,
) -> None:
    """Add a face to the rows between two image heights of a part of a column, `scale` pixels to a metre."""
    one, face, sight = met
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
        unroll(stretch, up, level, gain, face.start, scene.texels, scene.level_starts, brush.strip)
        paint_wall(rows, share, (v - up[0], step), brush.strip, brush.texel, brush.mix, brush.column)


@kernel(forceinline=True)
@typing.no_type_check
def _climb(
    part: tuple,
    met: int,
    column: Column,
    sight: Sight,
    scene: Scene,
    lens: Lens,
    backdrop: np.ndarray,
    brush: Brush,
) -> None:
    """Let the gaze climb one part of a column past the faces it meets."""
    weight = part[1] - part[0]
    peak, gaze, horizon = float(column.rows[0]), float(column.rows[1]), 0.5 * lens.height
    ground, colour = 0.0, scene.floor
    for i in range(met):
        one, scale = sight.touches[sight.hits[i].touch], lens.focal * sight.hits[i].near
        face, projected = sight.faces[one.face], sight.projected[one.face]
        foot = max(horizon + scale * (lens.eye - ground), peak)
        if foot < gaze:
            paint_ground(foot, gaze, weight, colour, column.eye, lens, scene.texels, scene.level_starts, brush.column)
            gaze = foot
        if face.closed and projected.aside > 0.0:
            ground, colour = 0.0, scene.floor
            continue
        top = max(horizon + scale * (lens.eye - face.height), peak)
        if top < gaze:
            _paint_face((top, gaze), part, scale, (one, face, projected), column.rays, lens, scene, brush)
            gaze = top
        if gaze <= peak:
            return
        if face.closed and face.height < lens.eye:
            ground, colour = face.height, Ground(face.red, face.green, face.blue, -1, 1.0)
    if gaze > horizon:
        paint_ground(horizon, gaze, weight, colour, column.eye, lens, scene.texels, scene.level_starts, brush.column)
        gaze = horizon
    paint_backdrop(peak, gaze, weight, backdrop, column.behind, brush.column)


@kernel(forceinline=True)
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


@kernel()
@typing.no_type_check
def _paint(
    pose: np.ndarray,
    scene: Scene,
    lens: Lens,
    backdrop: np.ndarray,
    ray: np.ndarray,
    out: np.ndarray,
    words: np.ndarray,
) -> None:
    """Paint the view from one pose."""
    faces = scene.faces
    sights, span = np.empty(len(faces), PROJECTED_FACE), np.empty((2 * len(faces), 2))
    hits, edges = np.empty(len(span), RAY_HIT), np.empty(2 * len(span) + 2)
    strip = np.zeros(4 * (int(faces["height"].max() / TEXEL) + BLOCK), np.float32)
    texel, rows = np.empty(lens.height + BLOCK, np.int32), lens.height + BLOCK
    mix = np.empty(rows, np.float32), np.empty(rows, np.float32), np.empty(rows, np.float32)
    column, quad = np.empty(backdrop.shape[1], np.float32), np.empty((4, backdrop.shape[1]), np.uint8)
    quad_words, columns = quad.view(np.uint32), len(backdrop)
    brush = Brush(strip, texel, mix, column)
    first, listed = project(pose, faces, lens, sights, span)
    touches, painted = np.empty(len(listed), COLUMN_SPAN), np.empty((lens.width, 2), np.int64)
    seen = Sight(faces, sights, touches, hits)
    for c in range(lens.width):
        rays = (ray[c, 0], ray[c, 1]), (ray[c + 1, 0], ray[c + 1, 1])
        touch(c, first[c], first[c + 1], listed, rays, faces, sights, span, touches)
        painted[c] = _rows(first[c], first[c + 1], faces, lens, touches)
    if scene.floor.start >= 0:
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
        where = Column(eye, rays, (top, bottom), behind)
        for n in range(in_blocks(4 * (bottom - top))):
            column[np.uint64(4 * top) + np.uint64(n)] = ROUNDS
        for p in range(split(low, high, faces, lens, touches, edges)):
            part = edges[p], edges[p + 1]
            met = meet(0.5 * (part[0] + part[1]), low, high, faces, sights, touches, hits)
            _climb(part, met, where, seen, scene, lens, backdrop, brush)
        finish((top, bottom), sight, backdrop, behind, column, quad, c & 3)
        if c & 3 == 3 and len(words) > 0:
            emit_words(quad_words, c - 3, sight, words)
        elif c & 3 == 3 or c == lens.width - 1:
            emit(quad, c & ~3, (c & 3) + 1, sight, out)


@kernel()
@typing.no_type_check
def render_alone(
    poses: Poses,
    scene: Scene,
    lens: Lens,
    backdrop: UInt8[np.ndarray, "columns blocks"],
    ray: Float[np.ndarray, "width_and_one 2"],
    out: UInt8[np.ndarray, "views height width 3"],
    words: UInt32[np.ndarray, "views rows words"],
) -> None:
    """Do the work of `render` without threads, which take a while to start."""
    for i in range(len(poses)):
        _paint(poses[i], scene, lens, backdrop, ray, out[i], words[i])


@kernel(parallel=True)
@typing.no_type_check
def render(
    poses: Poses,
    scene: Scene,
    lens: Lens,
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
    faces, (red, green, blue, start, light), texels, level_starts = scene
    for i in prange(len(poses)):
        # Packed again here: numba hands no tuple within a tuple to its threads.
        seen = Scene(faces, Ground(red, green, blue, start, light), texels, level_starts)
        _paint(poses[i], seen, lens, backdrop, ray, out[i], words[i])
