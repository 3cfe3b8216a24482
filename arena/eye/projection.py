"""Projection: how the eye sees a vertical face, in an upright plane or all around.

Depth is along the view's axis in perspective and along the level ray in a panorama. Faces are kept by
1 / depth, which is linear in the image: no division is needed between two rays.
"""

import typing

import numpy as np
from jaxtyping import Float, Shaped

from arena.kernels import bare_kernel

NEAREST = 1e-4
"""Nothing is seen nearer than this (m): its image would grow beyond all bounds."""

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


@bare_kernel(forceinline=True)
@typing.no_type_check
def _cover_around(a: tuple, b: tuple, lens: Lens) -> tuple[float, float, float]:
    """First and last image coordinate of a face, and the last of what of it lies beyond the seam."""
    # Column 0 looks straight back, and what follows is clockwise from there.
    xa = lens.focal * (np.pi - np.arctan2(a[1], a[0]))
    xb = lens.focal * (np.pi - np.arctan2(b[1], b[0]))
    low, high = min(xa, xb), max(xa, xb)
    # No straight face spans more than half a turn: what seems to goes the other way, across the seam.
    return (low, high, 0.0) if high - low <= 0.5 * lens.width else (high, float(lens.width), low)


@bare_kernel(forceinline=True)
@typing.no_type_check
def _cover_ahead(a: tuple, b: tuple, lens: Lens) -> tuple[float, float, float]:
    """First and last image coordinate of a face that is not all behind the eye."""
    far, near = (a, b) if a[0] > b[0] else (b, a)
    x, y = near
    # What lies behind the eye would be projected to the other side, upside down. `place` leaves out what
    # is all nearer than this, so that no quotient is by zero.
    if x < NEAREST:
        x, y = NEAREST, y + (far[1] - y) * (NEAREST - x) / (far[0] - x)
    # Cut to the image: the end of a face that is seen aslant may be projected any number of widths away.
    xa = min(max(0.5 * lens.width - lens.focal * far[1] / far[0], 0.0), float(lens.width))
    xb = min(max(0.5 * lens.width - lens.focal * y / x, 0.0), float(lens.width))
    return min(xa, xb), max(xa, xb), 0.0


@bare_kernel()
@typing.no_type_check
def place(pose: np.ndarray, faces: np.ndarray, lens: Lens, sights: np.ndarray, span: np.ndarray) -> None:
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


@bare_kernel()
@typing.no_type_check
def direction(x: float, lens: Lens) -> tuple[float, float]:
    """Direction (ahead, left) of image coordinate x; its part ahead is 1 in perspective."""
    # Pixel centres lie at half integers, and x = width / 2 looks straight ahead.
    if lens.panoramic:
        azimuth = np.pi - x / lens.focal
        return np.cos(azimuth), np.sin(azimuth)
    return 1.0, (0.5 * lens.width - x) / lens.focal


@bare_kernel(forceinline=True)
@typing.no_type_check
def ray_at(x: float, ray: np.ndarray) -> tuple[float, float]:
    """Direction (ahead, left) of image coordinate x: exact between columns, linear within."""
    c = min(int(x), len(ray) - 2)
    t = x - c
    return ray[c, 0] + t * (ray[c + 1, 0] - ray[c, 0]), ray[c, 1] + t * (ray[c + 1, 1] - ray[c, 1])


@bare_kernel(forceinline=True)
@typing.no_type_check
def met_at(sight: np.record, ray: tuple[float, float]) -> float:
    """1 / depth at which a ray meets a face."""
    # Past the ends of the face the line goes on to 0 and below; 1000 km are as good as infinity.
    return min(max(sight.ahead * ray[0] + sight.left * ray[1], 1e-6), 1.0 / NEAREST)


@bare_kernel()
@typing.no_type_check
def unsound(poses: Poses) -> int:
    """Find the first pose that is not finite; −1 when all are."""
    for i in range(len(poses)):
        # Spelt out, since `isfinite` of a row would allocate an array for each pose.
        if not (np.isfinite(poses[i, 0]) and np.isfinite(poses[i, 1]) and np.isfinite(poses[i, 2])):
            return i
    return -1
