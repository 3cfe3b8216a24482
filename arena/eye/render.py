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

1. `projection.place` turns the room's faces into the eye's frame, once per view.
2. `stretches.look` cuts the image where what is in sight changes, and lists the faces of each stretch from
   near to far. A column that is cut is painted in parts, each with the faces of its own stretch. Within a
   column 1 / depth of a face is linear, and so are the rows of its foot and top.
3. `_climb` lets the gaze climb each part from the last row up, as in the drawing. What has been passed is
   never painted again, and so the near hides the far. A solid lower than the eye is ground from its near face
   to its far one, in the colour of its top.
4. Whatever is laid on a row is the mean over the area that the row covers, weighted by the share of the row
   that it fills and by the width of the part: the weights on a row add up to one. For a wall
   `texture_sampling.unroll` averages along it and `paint_wall` up it, each at the level of the mip maps at
   which a pixel covers one or two texels, so the cost does not grow with the distance.
5. Above the last face is the backdrop. `pixels.finish` cuts the sums to bytes, and four columns at a time are
   copied into the image.

Geometry is in doubles, colours are whole numbers (`arena.eye.simd`): an image is the same to the bit on every
processor.

Columns and not rows, because textures are stored from the floor up: a column reads them in order, the
channels of several texels in one instruction.
"""

import typing

import numpy as np
from jaxtyping import Float, UInt8

from arena.eye import pixels, stretches
from arena.eye import texture_sampling as sampling
from arena.eye.background import Backdrop
from arena.eye.projection import PROJECTED_FACE, Lens, Poses, met_at, place, ray_at
from arena.eye.scene import Scene
from arena.eye.stretches import Sweep
from arena.eye.texture_sampling import BLANK, BLOCK, Ground
from arena.kernels import bare_kernel, kernel
from arena.rooms.materials import LEVELS, TEXEL

UPRIGHT = np.dtype([("face", "i8"), *((name, "f8") for name in ("near", "next_near", "along", "next_along"))])
"""A face of a stretch, and at the two sides of a part of a column 1 / depth and how far along its material
(m) it is met."""

PART = np.dtype([("first", "i8"), ("last", "i8"), ("share", "f8")])
"""A part of a column: which rows it has painted, the first and past the last, and how much of the column it
fills."""


class Brush(typing.NamedTuple):
    """Memory that a view is painted in; the next one uses it again."""

    projected: np.ndarray
    """The room's faces as the eye sees them, of dtype `arena.eye.PROJECTED_FACE`."""
    sweep: Sweep
    uprights: np.ndarray
    """The faces of one stretch, from near to far."""
    parts: np.ndarray
    """Those of one column."""
    strip: np.ndarray
    """Texels of a wall from the floor up, averaged along what a part of the column covers."""
    column: np.ndarray
    """Red, green, blue and a spare number for each row, summed up part by part."""
    quad: np.ndarray
    """Four columns that are finished."""
    rows: np.ndarray
    """For each of the four the rows that are more than backdrop: the first, and past the last."""


@kernel(forceinline=True)
@typing.no_type_check
def _brush(scene: Scene, length: int) -> Brush:
    """Make room for views of a room; a column of the backdrop has this length."""
    rows = 2 * len(scene.faces)
    return Brush(
        np.empty(len(scene.faces), PROJECTED_FACE),
        stretches.sweep_over(len(scene.faces)),
        np.empty(rows, UPRIGHT),
        # A stretch begins at the left of the image, at an end of a row, or where a column does.
        np.empty(2 * rows + 2, PART),
        np.empty(4 * (int(scene.tallest / TEXEL) + BLOCK), np.uint16),
        np.full(length, BLANK),
        np.empty((4, length), np.uint8),
        np.empty((4, 2), np.int64),
    )


# Kernels that make no arrays are bare: numba would count who holds which, an atomic instruction each time
# that one is taken out of a tuple.
@bare_kernel(forceinline=True)
@typing.no_type_check
def _paint_face(
    rows: tuple, weight: float, scale: float, one: np.record, lens: Lens, scene: Scene, brush: Brush
) -> None:
    """Add a face to the rows between two image heights of a part of a column, `scale` pixels to a metre."""
    face = scene.faces[one.face]
    gain = weight * (face.left_light if brush.projected[one.face].aside > 0.0 else face.right_light)
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
        share = gain * (fade if layer == 1 else 1.0 - fade)
        if layer == 1:
            step, v, level = 0.5 * step, 0.5 * v, level + 1
        # One texel below and two above what is seen: a row is blended from three.
        up = max(int(v - bottom * step) - 1, 0), int(v - top * step) + 3
        share /= 2.0 * sampling.row_size(step)
        along = one.along, one.next_along
        sampling.unroll(along, up, level, share, face.start, scene.texels, scene.level_starts, brush.strip)
        sampling.paint_wall(rows, (v - up[0], step), brush.strip, brush.column)


@bare_kernel(forceinline=True)
@typing.no_type_check
def _climb(
    count: int,
    part: np.record,
    eye: tuple,
    scene: Scene,
    lens: Lens,
    backdrop: np.ndarray,
    brush: Brush,
) -> None:
    """Let the gaze climb one part of a column past so many faces.

    `eye` is where the eye stands (m) and the direction in the room of the column's middle ray.
    """
    peak, gaze, horizon = float(part.first), float(part.last), 0.5 * lens.height
    ground, colour = 0.0, scene.floor
    for k in range(count):
        one = brush.uprights[k]
        face, scale = scene.faces[one.face], 0.5 * lens.focal * (one.near + one.next_near)
        # Cut at the peak: the image of a near face reaches far above row 0, where there is no memory.
        foot = max(horizon + scale * (lens.eye - ground), peak)
        if foot < gaze:
            sampling.paint_ground((foot, gaze), part.share, colour, eye, lens, scene, brush.column)
            gaze = foot
        # The far side of a solid is its back; there its top ends and the floor goes on.
        if face.closed and brush.projected[one.face].aside > 0.0:
            ground, colour = 0.0, scene.floor
            continue
        top = max(horizon + scale * (lens.eye - face.height), peak)
        if top < gaze:
            _paint_face((top, gaze), part.share, scale, one, lens, scene, brush)
            gaze = top
        # Nothing of the column is left for what is behind.
        if gaze <= peak:
            return
        if face.closed and face.height < lens.eye:
            # Brightness 1, as the light is in a top's colour already.
            ground, colour = face.height, Ground(face.red, face.green, face.blue, -1, 1.0)
    # Past the last face the ground goes on to the horizon, whatever it is: rooms need not be closed.
    if gaze > horizon:
        sampling.paint_ground((horizon, gaze), part.share, colour, eye, lens, scene, brush.column)
        gaze = horizon
    sampling.paint_backdrop((peak, gaze), part.share, backdrop, brush.column)


@bare_kernel(forceinline=True)
@typing.no_type_check
def _outline(count: int, scene: Scene, lens: Lens, uprights: np.ndarray, part: np.record) -> None:
    """Find which rows of a part of a column are not backdrop."""
    horizon = 0.5 * lens.height
    top, bottom = horizon, horizon
    for k in range(count):
        one = uprights[k]
        scale = 0.5 * lens.focal * (one.near + one.next_near)
        top = min(top, horizon - scale * (scene.faces[one.face].height - lens.eye))
        bottom = max(bottom, horizon + scale * lens.eye)
    if scene.floor.start >= 0:
        bottom = float(lens.height)
    part.first, part.last = int(max(top, 0.0)), int(np.ceil(min(bottom, float(lens.height))))


@bare_kernel(forceinline=True)
@typing.no_type_check
def _move_on(x: float, count: int, faces: np.ndarray, brush: Brush, ray: np.ndarray) -> None:
    """Move so many faces of a stretch on: what was a part's right is the next one's left, and x the right."""
    ahead, left = ray_at(x, ray)
    for k in range(count):
        one = brush.uprights[k]
        face, to = faces[one.face], brush.projected[one.face]
        one.near, one.along = one.next_near, one.next_along
        one.next_near = met_at(to, (ahead, left))
        where = to.at + (to.along * ahead + to.across * left) / one.next_near
        # Cut, as where a face is seen edge-on the least rounding would lead far along it.
        one.next_along = face.offset + min(max(where, 0.0), to.length)


@bare_kernel()
@typing.no_type_check
def _paint(
    pose: np.ndarray,
    scene: Scene,
    lens: Lens,
    backdrop: Backdrop,
    ray: np.ndarray,
    brush: Brush,
    out: np.ndarray,
) -> None:
    """Paint the view from one pose."""
    faces, sweep, uprights, parts = scene.faces, brush.sweep, brush.uprights, brush.parts
    place(pose, faces, lens, brush.projected, sweep.span)
    # Most of the image is backdrop, which is copied in no time; columns are laid over it.
    pixels.copy(backdrop.image, out)
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    stretches.begin(sweep)
    end, seen = stretches.look(0.0, sweep, (faces, brush.projected), lens, ray)
    begin, count = 0.0, 0
    while begin < lens.width:
        for k in range(seen):
            uprights[k].face = sweep.seen[k]
        stop, met, same = end, seen, True
        while same and stop < lens.width:
            end, seen = stretches.look(stop, sweep, (faces, brush.projected), lens, ray)
            same = seen == met
            for k in range(met if same else 0):
                same = same and uprights[k].face == sweep.seen[k]
            if same:
                stop = end
        _move_on(begin, met, faces, brush, ray)
        for c in range(int(begin), int(np.ceil(stop))):
            low, high = max(begin, float(c)), min(stop, c + 1.0)
            part = parts[count]
            part.share = high - low
            _move_on(high, met, faces, brush, ray)
            _outline(met, scene, lens, uprights, part)
            # The mean of the rays at the sides, not that through the middle: it moves as they do.
            ahead, left = 0.5 * (ray[c, 0] + ray[c + 1, 0]), 0.5 * (ray[c, 1] + ray[c + 1, 1])
            eye = pose[0], pose[1], cosine * ahead - sine * left, sine * ahead + cosine * left
            behind = backdrop.columns[c if len(backdrop.columns) > 1 else 0]
            _climb(met, part, eye, scene, lens, behind, brush)
            count += 1
            # The next stretch goes on with this column.
            if high < c + 1.0:
                break
            pixels.finish(parts, count, behind, brush.column, brush.quad[c & 3], brush.rows[c & 3])
            count = 0
            if c & 3 == 3 or c == lens.width - 1:
                pixels.emit(brush.quad, brush.rows, c & ~3, (c & 3) + 1, backdrop.columns, out)
        begin = stop


@kernel(nogil=True)
@typing.no_type_check
def render(
    poses: Poses,
    room: tuple,
    lens: tuple,
    backdrop: tuple,
    ray: Float[np.ndarray, "width_and_one 2"],
    out: UInt8[np.ndarray, "views height bytes"],
) -> None:
    """Paint the view from every pose (m, m, rad) into `out`, without the lock of the interpreter.

    `room`, `lens` and `backdrop` are a `Scene`, `Lens` and `Backdrop` as plain tuples, and so is the floor in
    the first: to hand over one that has names takes longer than to paint ten columns. `ray` is the direction
    (ahead, left) between columns.
    """
    faces, (red, green, blue, start, light), texels, level_starts, tallest = room
    scene = Scene(faces, Ground(red, green, blue, start, light), texels, level_starts, tallest)
    width, height, focal, eye, panoramic = lens
    lens = Lens(width, height, focal, eye, panoramic)
    columns, image = backdrop
    backdrop = Backdrop(columns, image)
    brush = _brush(scene, backdrop.columns.shape[1])
    for i in range(len(poses)):
        _paint(poses[i], scene, lens, backdrop, ray, brush, out[i])
