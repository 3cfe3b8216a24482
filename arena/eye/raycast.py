"""Ray casting: where the rays of one upright eye meet vertical faces, the geometry behind every image.

The faces are projected once per view and listed by the image columns that they touch. A column is split
wherever a face in sight begins or ends inside it; in each part the faces are met from near to far. Within a
column all that is seen changes linearly.

Depth is along the view's axis in perspective and along the level ray in a panorama. Faces are kept by
1 / depth, which is linear in the image: no division is needed between the sides of a column.
"""

import typing

import numpy as np
from jaxtyping import Float, Int32, Shaped
from numba import prange

from arena.kernels import kernel

NEAREST = 1e-4
"""Nothing is seen nearer than this (m): its image would grow beyond all bounds."""
FLOOR, CEILING = -1, -2
"""What `identify` calls the two surfaces that are not of any face or solid."""

FACE = np.dtype(
    [
        *((name, "f8") for name in ("x0", "y0", "x1", "y1", "height", "offset")),
        *(("closed", "?"), ("solid", "i4"), ("start", "i8")),
        *((name, "f8") for name in ("left_light", "right_light", "red", "green", "blue")),
    ],
    align=True,
)
"""A vertical face of a room, as in `arena.rooms.surfaces.Surfaces`: its ends and height in m, where along its
material it starts (m), the solid it bounds, how bright its two sides are, and the colour of its solid's
top."""

PROJECTED_FACE = np.dtype(
    [(name, "f8") for name in ("ahead", "left", "at", "along", "across", "length", "aside")]
)
"""A face as seen from a pose: the ray towards (a, l) meets it at 1 / depth = ahead a + left l, which is
at + depth (along a + across l) m along its `length` m. Its left is seen if aside > 0."""

COLUMN_SPAN = np.dtype(
    [("face", "i8"), *((name, "f8") for name in ("begin", "end", "first", "last", "start", "stop"))]
)
"""A face in a column: where in it (0 to 1) the face begins and ends, and at the column's two sides 1 / depth
and how far along its material (m) it is met."""

RAY_HIT = np.dtype([("touch", "i8"), ("near", "f8")])
"""A face that a ray meets, by its number in the column, and 1 / depth."""

Faces = Shaped[np.ndarray, " faces"]
Poses = Float[np.ndarray, "views 3"]


class Lens(typing.NamedTuple):
    """How the eye projects; see `arena.eye.camera.Camera`."""

    width: int
    height: int
    focal: float
    """Pixels per unit of tangent (perspective) or per radian (panoramic)."""
    eye: float
    """Height above the floor, m."""
    panoramic: bool


@kernel(forceinline=True)
@typing.no_type_check
def _cover_around(a: tuple, b: tuple, lens: Lens) -> tuple[float, float, float]:
    """First and last image coordinate of a face, and the last of what of it lies beyond the seam."""
    # Column 0 looks straight back, and what follows is clockwise from there.
    xa = lens.focal * (np.pi - np.arctan2(a[1], a[0]))
    xb = lens.focal * (np.pi - np.arctan2(b[1], b[0]))
    low, high = min(xa, xb), max(xa, xb)
    # No straight face spans more than half a turn: what seems to goes the other way, across the seam.
    return (low, high, 0.0) if high - low <= 0.5 * lens.width else (high, float(lens.width), low)


@kernel(forceinline=True)
@typing.no_type_check
def _cover_ahead(a: tuple, b: tuple, lens: Lens) -> tuple[float, float, float]:
    """First and last image coordinate of a face that is not all behind the eye."""
    far, near = (a, b) if a[0] > b[0] else (b, a)
    x, y = near
    # What lies behind the eye would be projected to the other side, upside down. `_project` leaves out what
    # is all nearer than this, so that no quotient is by zero.
    if x < NEAREST:
        x, y = NEAREST, y + (far[1] - y) * (NEAREST - x) / (far[0] - x)
    # Cut to the image: the end of a face that is seen aslant may be projected any number of widths away.
    xa = min(max(0.5 * lens.width - lens.focal * far[1] / far[0], 0.0), float(lens.width))
    xb = min(max(0.5 * lens.width - lens.focal * y / x, 0.0), float(lens.width))
    return min(xa, xb), max(xa, xb), 0.0


@kernel()
@typing.no_type_check
def _project(pose: np.ndarray, faces: np.ndarray, lens: Lens, sights: np.ndarray, span: np.ndarray) -> None:
    """Put the faces into the eye's frame and find what they cover."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    for f in range(len(faces)):
        face, sight = faces[f], sights[f]
        # Shifted before it is turned: a difference of close numbers is exact, that of turned ones is not.
        dx, dy = face.x0 - pose[0], face.y0 - pose[1]
        a = cosine * dx + sine * dy, cosine * dy - sine * dx
        dx, dy = face.x1 - pose[0], face.y1 - pose[1]
        b = cosine * dx + sine * dy, cosine * dy - sine * dx
        # Empty, so that no column lists it, until it is known to be seen.
        span[f, 0] = span[f, 1] = span[f + len(faces), 0] = span[f + len(faces), 1] = 0.0
        # Twice the area between eye and face; positive if the eye is to the left of the face.
        cross = b[1] * a[0] - b[0] * a[1]
        hidden = cross > 0.0 and face.closed and face.height >= lens.eye  # the back of a tall solid
        if hidden or (not lens.panoramic and a[0] < NEAREST and b[0] < NEAREST):
            continue
        # Rooms are within a kilometre, whose square cannot overflow: hypot's scaling would only cost time.
        length = np.sqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2)
        along, across = (b[0] - a[0]) / length, (b[1] - a[1]) / length
        # Edge-on, 1 / depth would be 0 / 0; from 1e-12 m aside it is the same image.
        aside = cross / length if cross != 0.0 else 1e-12
        sight.ahead, sight.left = across / aside, -along / aside
        sight.at = -(a[0] * along + a[1] * across)
        sight.along, sight.across = along, across
        sight.length, sight.aside = length, aside
        span[f, 0], span[f, 1], beyond = (
            _cover_around(a, b, lens) if lens.panoramic else _cover_ahead(a, b, lens)
        )
        span[f + len(faces), 0], span[f + len(faces), 1] = 0.0, beyond


@kernel()
@typing.no_type_check
def project(pose: np.ndarray, faces: np.ndarray, lens: Lens, sights: np.ndarray, span: np.ndarray) -> tuple:
    """Project the faces, and list by columns which of them touch it.

    Fills `sights` and `span`, of twice as many rows: first and last image coordinate of each face and, from
    row `faces` on, of what of it lies beyond the seam of a panorama. Those that touch column c are the rows
    listed[first[c]:first[c + 1]].
    """
    _project(pose, faces, lens, sights, span)
    # Count, sum up, fill: one array for all columns, in which those of a column lie together. int32 takes
    # half the memory, and 8192 columns, the most there are, can still list 100,000 faces twice.
    first = np.zeros(lens.width + 1, np.int32)
    for row in range(len(span)):
        if span[row, 1] > span[row, 0]:
            # A turn times the focal length may be rounded to beyond the width, where there is no column.
            for c in range(int(span[row, 0]), min(int(np.ceil(span[row, 1])), lens.width)):
                first[c + 1] += 1
    for c in range(lens.width):
        first[c + 1] += first[c]
    listed, fill = np.empty(first[-1], np.int32), first[:-1].copy()
    for row in range(len(span)):
        if span[row, 1] > span[row, 0]:
            for c in range(int(span[row, 0]), min(int(np.ceil(span[row, 1])), lens.width)):
                listed[fill[c]] = row
                fill[c] += 1
    return first, listed


@kernel()
@typing.no_type_check
def direction(x: float, lens: Lens) -> tuple[float, float]:
    """Direction (ahead, left) of image coordinate x; its part ahead is 1 in perspective."""
    # Pixel centres lie at half integers, and x = width / 2 looks straight ahead.
    if lens.panoramic:
        azimuth = np.pi - x / lens.focal
        return np.cos(azimuth), np.sin(azimuth)
    return 1.0, (0.5 * lens.width - x) / lens.focal


@kernel(forceinline=True)
@typing.no_type_check
def nearness(one: np.record, x: float) -> float:
    """1 / depth of a touching face at x."""
    # Past the ends of the face the line goes on to 0 and below; 1000 km are as good as infinity.
    return min(max(one.first + x * (one.last - one.first), 1e-6), 1.0 / NEAREST)


@kernel(forceinline=True)
@typing.no_type_check
def along(x: float, one: np.record, face: np.record, sight: np.record, rays: tuple) -> float:
    """How far along its material (m) a touching face is met at x."""
    (a0, l0), (a1, l1) = rays
    ahead, left = a0 + x * (a1 - a0), l0 + x * (l1 - l0)
    where = sight.at + (sight.along * ahead + sight.across * left) / nearness(one, x)
    # A column may be wider than what it sees of the face: beyond its ends is the material of a neighbour.
    return face.offset + min(max(where, 0.0), sight.length)


@kernel(forceinline=True)
@typing.no_type_check
def touch(
    c: int,
    within: tuple,
    listed: np.ndarray,
    rays: tuple,
    faces: np.ndarray,
    sights: np.ndarray,
    span: np.ndarray,
    touches: np.ndarray,
) -> None:
    """Fill these `touches` with the faces listed there as they lie in column c, between two rays."""
    (a0, l0), (a1, l1) = rays
    for k in range(within[0], within[1]):
        # Rows past those of the faces are what lies of them beyond the seam.
        row, one = listed[k], touches[k]
        one.face = row if row < len(sights) else row - len(sights)
        face, sight = faces[one.face], sights[one.face]
        # Cut to exactly 0 and 1 where the face goes on beside the column: `split` compares without tolerance.
        one.begin, one.end = max(span[row, 0] - c, 0.0), min(span[row, 1] - c, 1.0)
        one.first = sight.ahead * a0 + sight.left * l0
        one.last = sight.ahead * a1 + sight.left * l1
        one.start = along(0.0, one, face, sight, rays)
        one.stop = along(1.0, one, face, sight, rays)


@kernel(forceinline=True)
@typing.no_type_check
def _hidden(one: np.record, occluder: np.record, faces: np.ndarray, lens: Lens) -> bool:
    """Whether a face is behind another that fills the column and rises higher in the image."""
    # A height is seen at focal times height over depth from the horizon: no division is needed to compare.
    middle = 0.5 * (one.begin + one.end)
    near, before = nearness(one, middle), nearness(occluder, middle)
    # Strictly nearer: of two faces at the same place neither may hide the other, whichever is met first.
    rise, skyline = faces[one.face].height - lens.eye, faces[occluder.face].height - lens.eye
    return near < before and near * rise <= before * skyline


@kernel(forceinline=True)
@typing.no_type_check
def split(within: tuple, faces: np.ndarray, lens: Lens, touches: np.ndarray, edges: np.ndarray) -> int:
    """Cut a column where a face in sight begins or ends; the number of parts.

    The column's faces are touches[within[0]:within[1]], here as above and below.
    """
    occluder, skyline = -1, -np.inf  # the face that fills the column and rises highest
    for k in range(within[0], within[1]):
        one = touches[k]
        rise = nearness(one, 0.5) * (faces[one.face].height - lens.eye)
        if one.begin == 0.0 and one.end == 1.0 and rise > skyline:
            occluder, skyline = k, rise
    edges[0], edges[1], parts = 0.0, 1.0, 1
    for k in range(within[0], within[1]):
        one = touches[k]
        # A face over the whole column has no edge in it; edges behind the occluder are not seen, and each
        # part costs as much as a column.
        if one.begin == 0.0 and one.end == 1.0:
            continue
        if occluder >= 0 and _hidden(one, touches[occluder], faces, lens):
            continue
        # Insertion, since a column has hardly ever more than three edges.
        for x in (one.begin, one.end):
            i = parts
            while edges[i - 1] > x:
                i -= 1
            # Strictly between, so that an edge of two faces is one: a part of no width would cost as much.
            if edges[i - 1] < x < edges[i]:
                for j in range(parts, i - 1, -1):
                    edges[j + 1] = edges[j]
                edges[i] = x
                parts += 1
    return parts


@kernel(forceinline=True)
@typing.no_type_check
def meet(
    x: float,
    within: tuple,
    faces: np.ndarray,
    sights: np.ndarray,
    touches: np.ndarray,
    hits: np.ndarray,
) -> int:
    """Find which touching faces the ray at x meets, from near to far; their number."""
    met = 0
    for k in range(within[0], within[1]):
        one = touches[k]
        # Half open: a ray through the edge that two faces share meets one of them, not both and not none.
        if one.begin <= x < one.end:
            near = nearness(one, x)
            # Where two solids touch, the far face of one is met before the near face of the other, whatever
            # the rounding: its top ends, and then the other begins.
            if faces[one.face].closed and sights[one.face].aside > 0.0:
                near *= 1 + 1e-9
            # Sorted as they come: for the few faces of a column nothing is faster.
            i = met
            while i > 0 and hits[i - 1].near < near:
                hits[i].near, hits[i].touch = hits[i - 1].near, hits[i - 1].touch
                i -= 1
            hits[i].near, hits[i].touch = near, k
            met += 1
    return met


@kernel()
@typing.no_type_check
def _middles(pose: np.ndarray, faces: np.ndarray, lens: Lens) -> tuple:
    """Find what the rays through the middles of the columns meet, exactly.

    Column c meets the touching faces of hits[first[c]:last[c]], from near to far.
    """
    sights, span = np.empty(len(faces), PROJECTED_FACE), np.empty((2 * len(faces), 2))
    first, listed = project(pose, faces, lens, sights, span)
    touches, hits, last = np.empty(len(listed), COLUMN_SPAN), np.empty(len(listed), RAY_HIT), first[1:].copy()
    for c in range(lens.width):
        within = first[c], first[c + 1]
        # Both sides of the column are its middle: interpolating between sides would be off by what lies
        # between, as the cosine of an angle is not linear.
        ray = direction(c + 0.5, lens)
        touch(c, within, listed, (ray, ray), faces, sights, span, touches)
        last[c] = first[c] + meet(0.5, within, faces, sights, touches, hits[first[c] :])
    return sights, touches, hits, first, last


@kernel()
@typing.no_type_check
def unsound(poses: Poses) -> int:
    """Find the first pose that is not finite; −1 when all are."""
    for i in range(len(poses)):
        # Spelt out, since `isfinite` of a row would allocate an array for each pose.
        if not (np.isfinite(poses[i, 0]) and np.isfinite(poses[i, 1]) and np.isfinite(poses[i, 2])):
            return i
    return -1


@kernel(parallel=True)
@typing.no_type_check
def measure(poses: Poses, faces: Faces, lens: Lens, out: Float[np.ndarray, "views width"]) -> None:
    """Write the distance (m) along each column's middle ray into `out`; infinity where nothing is met."""
    for i in prange(len(poses)):
        _, _, hits, first, last = _middles(poses[i], faces, lens)
        for c in range(lens.width):
            ahead, left = direction(c + 0.5, lens)
            # Depth along the axis times the length of the ray is the distance.
            out[i, c] = np.hypot(ahead, left) / hits[first[c]].near if last[c] > first[c] else np.inf


@kernel()
@typing.no_type_check
def _name(pose: np.ndarray, faces: np.ndarray, lens: Lens, out: np.ndarray) -> None:
    """Name the surface at the middle of every pixel of one view."""
    sights, touches, hits, first, last = _middles(pose, faces, lens)
    horizon = 0.5 * lens.height
    for c in range(lens.width):
        row, ground, beneath = lens.height - 1, 0.0, FLOOR
        for i in range(first[c], last[c]):
            f, scale = touches[hits[i].touch].face, lens.focal * hits[i].near
            # A row is where its middle is; the gaze climbs as in `arena.eye.render`.
            while row >= 0 and row + 0.5 >= horizon + scale * (lens.eye - ground):
                out[row, c] = beneath
                row -= 1
            if faces[f].closed and sights[f].aside > 0.0:
                ground, beneath = 0.0, FLOOR
                continue
            while row >= 0 and row + 0.5 >= horizon + scale * (lens.eye - faces[f].height):
                out[row, c] = f
                row -= 1
            if faces[f].closed and faces[f].height < lens.eye:
                ground, beneath = faces[f].height, len(faces) + faces[f].solid
        # Past the last face: ground up to the horizon, as a room need not be closed.
        for r in range(row + 1):
            out[r, c] = CEILING if r + 0.5 < horizon else beneath


@kernel(parallel=True)
@typing.no_type_check
def identify(poses: Poses, faces: Faces, lens: Lens, out: Int32[np.ndarray, "views height width"]) -> None:
    """Write what is seen at the middle of each pixel into `out`; see `arena.eye.camera.Camera.identify`."""
    for i in prange(len(poses)):
        _name(poses[i], faces, lens, out[i])
