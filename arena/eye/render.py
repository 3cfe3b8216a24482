"""Rendering: the kernels that paint what the eye sees, one image column after the other.

How a column is painted::

            the image                             the room from the side

    row 0   +---+---+                                                      B
            |   :   |  5 backdrop                                5  . - '  #
            |   :   |                                        . '           #
            +---+---+                                   . '                #
            |###:###|  4 face of B             eye o - - - - - - - - - - - # - -  horizon
            |###:###|                              | ` .  '  .         4   #
            +---+---+                              |   ` .     ' .  3      #
            |   :   |  3 top of A                  |     ` .       +=======#
            +---+---+                              |       ` .   2 |A A A A#
            |%%%:%%%|  2 face of A                 |         ` .   | A A A #
            +---+---+                              |  1        ` . |A A A A#
            |   :   |  1 floor              floor -+---------------+-------#
    row -1  +---+---+
              ^   ^ parts of the column

1. `raycast.project` turns the room's faces into the eye's frame, once per view, and lists the columns that
   each one touches. Within a column 1 / depth of a face is linear, and so are the rows of its foot and top.
2. `raycast.split` cuts the column where a face begins or ends inside it. All rays of a part meet the same
   faces; `raycast.meet` sorts them from near to far along the part's middle ray.
3. `_climb` lets the gaze climb each part from the last row up, as in the drawing. What has been passed is
   never painted again, and so the near hides the far. A solid lower than the eye is ground from its near face
   to its far one, in the colour of its top.
4. Whatever is laid on a row is the mean over the area that the row covers, weighted by the share of the row
   that it fills and by the width of the part: the weights on a row add up to one. For a wall
   `texture_sampling.unroll` averages along it and `paint_wall` up it, each at the level of the mip maps at
   which a pixel covers one or two texels, so the cost does not grow with the distance.
5. Above the last face is the backdrop. `pixels.finish` cuts the sums to bytes, and four columns at a time are
   copied into the image.

Columns and not rows, because textures are stored from the floor up: a column reads them in order, four
channels in one instruction.
"""

import typing

import numpy as np
from jaxtyping import Float, UInt8, UInt32
from numba import prange

from arena.eye import pixels, raycast
from arena.eye import texture_sampling as sampling
from arena.eye.raycast import Faces, Lens, Poses, along, nearness
from arena.eye.scene import Scene
from arena.eye.texture_sampling import BLOCK, Ground, in_blocks
from arena.kernels import kernel
from arena.rooms.materials import LEVELS, TEXEL


class Column(typing.NamedTuple):
    """Where a column of the image looks."""

    eye: tuple[float, ...]
    """Where the eye stands (m) and the direction in the room of the column's middle ray."""
    rays: tuple[float, ...]
    """Directions (ahead, left) at the column's two sides."""
    rows: tuple[int, int]
    """The first row that is not backdrop, and the first below it that is again."""
    behind: int
    """Its column of the backdrop."""


class Sight(typing.NamedTuple):
    """The faces of a room as the eye sees them, of the dtypes in `arena.eye.raycast`."""

    faces: Faces
    projected: np.ndarray
    touches: np.ndarray
    hits: np.ndarray
    """For one part of a column, from near to far."""


class Brush(typing.NamedTuple):
    """Memory that a column is painted in; the next column uses it again."""

    strip: np.ndarray
    """Texels of a wall from the floor up, averaged along what a part of the column covers."""
    texel: np.ndarray
    """For each row the first texel of the strip that it covers."""
    mix: tuple[np.ndarray, ...]
    """For each row the weights of that texel and the next two."""
    column: np.ndarray
    """Red, green, blue and a spare number for each row, summed up part by part."""


# Tuples of arrays go to kernels that are inlined: there LLVM removes the counts of references that numba adds
# each time an array is taken out of a tuple, which would cost more than the painting.
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
    one, face, projected = met
    gain = face.left_light if projected.aside > 0.0 else face.right_light
    # Over the whole column the ends are known: a division less for each.
    stretch = one.start, one.stop
    if part != (0.0, 1.0):
        stretch = along(part[0], one, face, projected, rays), along(part[1], one, face, projected, rays)
    top, bottom = rows
    # Row r looks at texel v - r step up the wall; v is that of the upper edge of the image.
    step, level = 1.0 / (scale * TEXEL), 0
    v = lens.eye / TEXEL + 0.5 * lens.height * step
    # The coarsest level is left for the fade: it needs one coarser than that found here.
    while step > 2.0 and level < LEVELS[1] - 2:
        step, v, level = 0.5 * step, 0.5 * v, level + 1
    fade = sampling.fade_in(step)
    # A layer of no weight would change nothing and cost as much as the other: most walls need one only.
    for layer in range(2 if fade > 0.0 else 1):
        share = (part[1] - part[0]) * (fade if layer == 1 else 1.0 - fade)
        if layer == 1:
            step, v, level = 0.5 * step, 0.5 * v, level + 1
        # One texel below and two above what is seen: a row is blended from three.
        up = max(int(v - bottom * step) - 1, 0), int(v - top * step) + 3
        sampling.unroll(stretch, up, level, gain, face.start, scene.texels, scene.level_starts, brush.strip)
        sampling.paint_wall(rows, share, (v - up[0], step), brush.strip, brush.texel, brush.mix, brush.column)


@kernel(forceinline=True)
@typing.no_type_check
def _climb(
    part: tuple,
    met: int,
    where: Column,
    sight: Sight,
    scene: Scene,
    lens: Lens,
    backdrop: np.ndarray,
    brush: Brush,
) -> None:
    """Let the gaze climb one part of a column past the faces it meets."""
    weight = part[1] - part[0]
    peak, gaze, horizon = float(where.rows[0]), float(where.rows[1]), 0.5 * lens.height
    ground, colour = 0.0, scene.floor
    for i in range(met):
        one, scale = sight.touches[sight.hits[i].touch], lens.focal * sight.hits[i].near
        face, projected = sight.faces[one.face], sight.projected[one.face]
        # Cut at the peak: the image of a near face reaches far above row 0, where there is no memory.
        foot = max(horizon + scale * (lens.eye - ground), peak)
        if foot < gaze:
            rows = foot, gaze
            sampling.paint_ground(rows, weight, colour, where.eye, lens, scene, brush.column)
            gaze = foot
        # The far side of a solid is its back; there its top ends and the floor goes on.
        if face.closed and projected.aside > 0.0:
            ground, colour = 0.0, scene.floor
            continue
        top = max(horizon + scale * (lens.eye - face.height), peak)
        if top < gaze:
            _paint_face((top, gaze), part, scale, (one, face, projected), where.rays, lens, scene, brush)
            gaze = top
        # Nothing of the column is left for what is behind.
        if gaze <= peak:
            return
        if face.closed and face.height < lens.eye:
            # Brightness 1, as the light is in a top's colour already.
            ground, colour = face.height, Ground(face.red, face.green, face.blue, -1, 1.0)
    # Past the last face the ground goes on to the horizon, whatever it is: rooms need not be closed.
    if gaze > horizon:
        rows = horizon, gaze
        sampling.paint_ground(rows, weight, colour, where.eye, lens, scene, brush.column)
        gaze = horizon
    sampling.paint_backdrop((peak, gaze), weight, backdrop, where.behind, brush.column)


@kernel(forceinline=True)
@typing.no_type_check
def _rows(within: tuple, faces: np.ndarray, lens: Lens, touches: np.ndarray) -> tuple[int, int]:
    """Which rows of a column are not backdrop."""
    horizon = 0.5 * lens.height
    top, bottom = horizon, horizon
    for k in range(within[0], within[1]):
        one = touches[k]
        # 1 / depth is linear, so that it is largest at one of the ends.
        near = lens.focal * max(nearness(one, one.begin), nearness(one, one.end))
        top = min(top, horizon - near * (faces[one.face].height - lens.eye))
        bottom = max(bottom, horizon + near * lens.eye)
    # int cuts towards zero, which is a row too low only above the image, where it is row 0 anyway.
    return max(int(top), 0), min(int(np.ceil(bottom)), lens.height)


@kernel(forceinline=True)
@typing.no_type_check
def _rays(ray: np.ndarray, c: int) -> tuple:
    return (ray[c, 0], ray[c, 1]), (ray[c + 1, 0], ray[c + 1, 1])


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
    projected, span = np.empty(len(faces), raycast.PROJECTED_FACE), np.empty((2 * len(faces), 2))
    first, listed = raycast.project(pose, faces, lens, projected, span)
    touches, hits = np.empty(len(listed), raycast.COLUMN_SPAN), np.empty(len(span), raycast.RAY_HIT)
    # Both ends of all that may touch a column, and the column's own.
    edges, painted = np.empty(2 * len(span) + 2), np.empty((lens.width, 2), np.int64)
    # A block longer than what is read: loops write whole blocks.
    length = lens.height + BLOCK
    # Zeros, as what is there is taken times zero, and memory that was never written may hold a NaN.
    strip = np.zeros(4 * (int(faces["height"].max() / TEXEL) + BLOCK), np.float32)
    # Of four bytes like the weights, so that SIMD takes as many of these as of those.
    texel = np.empty(length, np.int32)
    mix = np.empty(length, np.float32), np.empty(length, np.float32), np.empty(length, np.float32)
    column, quad = np.empty(backdrop.shape[1], np.float32), np.empty((4, backdrop.shape[1]), np.uint8)
    quad_words = quad.view(np.uint32)
    brush = Brush(strip, texel, mix, column)
    sight = Sight(faces, projected, touches, hits)
    for c in range(lens.width):
        within = first[c], first[c + 1]
        raycast.touch(c, within, listed, _rays(ray, c), faces, projected, span, touches)
        painted[c] = _rows(within, faces, lens, touches)
    # A plain floor is part of the backdrop, a textured one is painted to the last row.
    if scene.floor.start >= 0:
        painted[:, 1] = lens.height
    # Rows that are backdrop in every column, often half the image, are copied row by row.
    visible = painted[:, 0].min(), painted[:, 1].max()
    pixels.fill(0, visible[0], backdrop, out, words)
    pixels.fill(visible[1], lens.height, backdrop, out, words)
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    for c in range(lens.width):
        within, rays, rows = (first[c], first[c + 1]), _rays(ray, c), (painted[c, 0], painted[c, 1])
        # The mean of the rays at the sides, not that through the middle: it moves as they do.
        ahead, left = 0.5 * (ray[c, 0] + ray[c + 1, 0]), 0.5 * (ray[c, 1] + ray[c + 1, 1])
        eye = pose[0], pose[1], cosine * ahead - sine * left, sine * ahead + cosine * left
        where = Column(eye, rays, rows, c if len(backdrop) > 1 else 0)
        # Half a grey level, so that cutting the sums to bytes rounds them.
        for n in range(in_blocks(4 * (rows[1] - rows[0]))):
            column[np.uint64(4 * rows[0]) + np.uint64(n)] = np.float32(0.5)
        for p in range(raycast.split(within, faces, lens, touches, edges)):
            part = edges[p], edges[p + 1]
            met = raycast.meet(0.5 * (part[0] + part[1]), within, faces, projected, touches, hits)
            _climb(part, met, where, sight, scene, lens, backdrop, brush)
        pixels.finish(rows, visible, backdrop, where.behind, column, quad, c & 3)
        # Four columns of three bytes are three words; images of another width go byte by byte.
        if c & 3 == 3 and len(words) > 0:
            pixels.emit_words(quad_words, c - 3, visible, words)
        elif c & 3 == 3 or c == lens.width - 1:
            pixels.emit(quad, c & ~3, (c & 3) + 1, visible, out)


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

    `backdrop` is an empty world, as in `arena.eye.background`; `ray` is the direction (ahead, left) between
    columns; `words` is the memory of `out` in words of four bytes, or has no rows where a row is not made of
    whole words.
    """
    faces, (red, green, blue, start, light), texels, level_starts = scene
    for i in prange(len(poses)):
        # Packed again here: numba hands no tuple within a tuple to its threads.
        room = Scene(faces, Ground(red, green, blue, start, light), texels, level_starts)
        _paint(poses[i], room, lens, backdrop, ray, out[i], words[i])
