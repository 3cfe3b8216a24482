"""The kernels of the eye: what one upright camera sees of vertical faces on a flat floor.

Every pixel is the mean of the texture over the area it covers, so that the image changes smoothly as the eye
moves. The faces are projected once per view and sorted into the image columns they touch. A column is split
wherever a face begins or ends inside it; in each part the faces are met from near to far, and the gaze climbs
from the floor at the animal's feet to the ceiling, painting whatever is not hidden behind something nearer. A
solid lower than the eye is ground from its near face to its far one, in the colour of its lid.
"""

import typing

import numpy as np
from jaxtyping import Bool, Float, Float32, Int, UInt8
from numba import njit, prange

from arena.materials import TEXEL, TILE

_NEAREST, _FARTHEST = 1e-4, 1e6
"""Depths (m) that the eye tells apart."""
_AWAY_FIRST = 1 + 1e-9
"""Where two solids touch, the far face of one is met before the near face of the other."""


class Lens(typing.NamedTuple):
    """How the eye projects; see `arena.camera.Camera`."""

    width: int
    focal: float
    """Pixels per unit of tangent (perspective) or per radian (panoramic)."""
    eye: float
    """Height above the floor, m."""
    panoramic: bool


class Faces(typing.NamedTuple):
    """The vertical faces of a room; see `arena.arena.Surfaces`."""

    start: Float[np.ndarray, "faces 2"]
    end: Float[np.ndarray, "faces 2"]
    height: Float[np.ndarray, "faces"]
    material: Int[np.ndarray, "faces"]
    offset: Float[np.ndarray, "faces"]
    closed: Bool[np.ndarray, "faces"]


class Paints(typing.NamedTuple):
    """The running sums of the textures, as in `arena.materials.Weave`, and the plain colours."""

    sums: Float32[np.ndarray, "materials along_and_one up_and_one_times_3"]
    mean: Float32[np.ndarray, "materials up_and_one_times_3"]
    lid: Float32[np.ndarray, "materials 3"]
    floor: Float32[np.ndarray, "3"]
    ceiling: Float32[np.ndarray, "3"]


class _View(typing.NamedTuple):
    """The faces as seen from one pose, and room to work in."""

    faces: Faces
    lens: Lens
    span: Float[np.ndarray, "twice_faces 2"]
    """First and last image coordinate of each face: row f, and row f + faces for what is beyond the seam of a
    panorama. Rows that cover nothing have last <= first."""
    line: Float[np.ndarray, "faces 7"]
    """The ray towards (ahead, left) meets a face at 1 / depth = line[0] ahead + line[1] left, which is
    line[2] + depth (line[3] ahead + line[4] left) m along its line[5] m. Its left is seen if line[6] > 0."""
    face: Int[np.ndarray, "twice_faces"]
    """The faces that a ray meets, from near to far."""
    nearness: Float[np.ndarray, "twice_faces"]
    """1 / depth where it meets them."""
    strip: Float32[np.ndarray, "texels_times_3"]
    """Running sums of a texture up the stretch of wall in sight."""
    column: Float32[np.ndarray, "height_times_3"]


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _view(faces: Faces, lens: Lens, height: int) -> _View:
    count = len(faces.start)
    return _View(
        faces,
        lens,
        np.zeros((2 * count, 2)),
        np.empty((count, 7)),
        np.empty(2 * count, np.int64),
        np.empty(2 * count),
        np.empty(3 * (int(faces.height.max() / TEXEL) + 8), np.float32),
        np.empty(3 * height, np.float32),
    )


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _ray(x: float, lens: Lens) -> tuple[float, float]:
    """Direction (forward, left) of image coordinate x; its forward part is 1 in perspective."""
    if lens.panoramic:
        azimuth = np.pi - x / lens.focal
        return np.cos(azimuth), np.sin(azimuth)
    return 1.0, (0.5 * lens.width - x) / lens.focal


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _project(pose: np.ndarray, view: _View) -> None:
    """Put the faces into the eye's frame and find what they cover."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    start, end = view.faces.start, view.faces.end
    for f in range(len(start)):
        dx, dy = start[f, 0] - pose[0], start[f, 1] - pose[1]
        ax, ay = cosine * dx + sine * dy, cosine * dy - sine * dx
        dx, dy = end[f, 0] - pose[0], end[f, 1] - pose[1]
        bx, by = cosine * dx + sine * dy, cosine * dy - sine * dx
        length = np.hypot(bx - ax, by - ay)
        ex, ey = (bx - ax) / length, (by - ay) / length
        aside = ey * ax - ex * ay
        aside = aside if aside != 0.0 else 1e-12
        view.line[f, 0], view.line[f, 1] = ey / aside, -ex / aside
        view.line[f, 2] = -(ax * ex + ay * ey)
        view.line[f, 3], view.line[f, 4] = ex, ey
        view.line[f, 5], view.line[f, 6] = length, aside
        if view.lens.panoramic:
            _cover_around(f, (ax, ay), (bx, by), view)
        else:
            _cover_ahead(f, (ax, ay), (bx, by), view)


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _cover_around(f: int, a: tuple[float, float], b: tuple[float, float], view: _View) -> None:
    width, focal, span = view.lens.width, view.lens.focal, view.span
    xa = focal * (np.pi - np.arctan2(a[1], a[0]))
    xb = focal * (np.pi - np.arctan2(b[1], b[0]))
    low, high = min(xa, xb), max(xa, xb)
    if high - low <= 0.5 * width:
        span[f, 0], span[f, 1] = low, high
    else:
        beyond = f + len(view.line)
        span[f, 0], span[f, 1] = high, width
        span[beyond, 0], span[beyond, 1] = 0.0, low


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _cover_ahead(f: int, a: tuple[float, float], b: tuple[float, float], view: _View) -> None:
    width, focal, span = view.lens.width, view.lens.focal, view.span
    far, near = (a, b) if a[0] > b[0] else (b, a)
    if far[0] < _NEAREST:
        return
    x, y = near
    if x < _NEAREST:
        x, y = _NEAREST, y + (far[1] - y) * (_NEAREST - x) / (far[0] - x)
    xa = min(max(0.5 * width - focal * far[1] / far[0], 0.0), width)
    xb = min(max(0.5 * width - focal * y / x, 0.0), width)
    span[f, 0], span[f, 1] = min(xa, xb), max(xa, xb)


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _bucket(view: _View) -> tuple[np.ndarray, np.ndarray]:
    """List the rows of `span` that touch each column: those of column c are listed[first[c]:first[c + 1]]."""
    span, width = view.span, view.lens.width
    first = np.zeros(width + 1, np.int64)
    for row in range(len(span)):
        if span[row, 1] > span[row, 0]:
            for c in range(int(span[row, 0]), min(int(np.ceil(span[row, 1])), width)):
                first[c + 1] += 1
    for c in range(width):
        first[c + 1] += first[c]
    listed = np.empty(first[width], np.int64)
    fill = first[:-1].copy()
    for row in range(len(span)):
        if span[row, 1] > span[row, 0]:
            for c in range(int(span[row, 0]), min(int(np.ceil(span[row, 1])), width)):
                listed[fill[c]] = row
                fill[c] += 1
    return first, listed


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _split(x: float, touching: np.ndarray, view: _View) -> float:
    """Where the first face after x begins or ends, or else the column does."""
    edge = np.floor(x) + 1.0
    for i in range(len(touching)):
        for k in range(2):
            if x < view.span[touching[i], k] < edge:
                edge = view.span[touching[i], k]
    return edge


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _meet(x: float, touching: np.ndarray, view: _View) -> int:
    """Find the faces that the ray at x meets, from near to far; their number."""
    ahead, left = _ray(x, view.lens)
    face, nearness, line = view.face, view.nearness, view.line
    count = 0
    for i in range(len(touching)):
        row = touching[i]
        if view.span[row, 0] <= x < view.span[row, 1]:
            f = row % len(line)
            near = line[f, 0] * ahead + line[f, 1] * left
            near = min(max(near, 1.0 / _FARTHEST), 1.0 / _NEAREST)
            if view.faces.closed[f] and line[f, 6] > 0.0:
                near *= _AWAY_FIRST
            k = count
            while k > 0 and nearness[k - 1] < near:
                nearness[k], face[k] = nearness[k - 1], face[k - 1]
                k -= 1
            nearness[k], face[k] = near, f
            count += 1
    return count


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _texel(x: float, f: int, view: _View) -> float:
    """Where along its texture face f is met by the ray at x."""
    line = view.line
    ahead, left = _ray(x, view.lens)
    near = max(line[f, 0] * ahead + line[f, 1] * left, 1.0 / _FARTHEST)
    along = line[f, 2] + (line[f, 3] * ahead + line[f, 4] * left) / near
    return (view.faces.offset[f] + min(max(along, 0.0), line[f, 5])) / TEXEL


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _blend(low: tuple, high: tuple, mean: np.ndarray, scale: np.float32, strip: np.ndarray) -> None:
    """Fill `strip` with the sums between two points amid texels; slices of equal length allow SIMD."""
    a0, b0, f0 = low
    a1, b1, f1 = high
    for k in range(len(strip)):
        strip[k] = mean[k] + scale * (a1[k] - a0[k] + f1 * (b1[k] - a1[k]) - f0 * (b0[k] - a0[k]))


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _unroll(along: tuple, up: tuple, m: int, paints: Paints, strip: np.ndarray) -> None:
    """Fill `strip` with the running sums of material m, averaged along a stretch of wall (texels)."""
    sums, mean = paints.sums, paints.mean
    u0, u1 = min(along), max(along)
    if u1 - u0 < 1.0:  # an average over one texel, which is linear interpolation
        u0, u1 = 0.5 * (u0 + u1) - 0.5, 0.5 * (u0 + u1) + 0.5
    tile, rise = TILE
    i0, i1 = int(np.floor(u0)), int(np.floor(u1))
    f0, f1 = np.float32(u0 - i0), np.float32(u1 - i1)
    i0, i1 = i0 % tile, i1 % tile
    v, at = up[0], 0
    while v < up[1]:
        low = 3 * (v % rise)
        n = min(3 * (up[1] - v), 3 * rise - low) + 3
        c0, c1, c2 = strip[at], strip[at + 1], strip[at + 2]
        _blend(
            (sums[m, i0, low : low + n], sums[m, i0 + 1, low : low + n], f0),
            (sums[m, i1, low : low + n], sums[m, i1 + 1, low : low + n], f1),
            mean[m, low : low + n],
            np.float32(1.0 / (u1 - u0)),
            strip[at : at + n],
        )
        if at > 0:  # the tile starts anew from nothing
            c0, c1, c2 = c0 - strip[at], c1 - strip[at + 1], c2 - strip[at + 2]
            for k in range(at, at + n, 3):
                strip[k] += c0
                strip[k + 1] += c1
                strip[k + 2] += c2
        at += n - 3
        v += n // 3 - 1


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _read(strip: np.ndarray, v: float) -> tuple[float, float, float]:
    """Give the running sums of red, green and blue up to v texels."""
    i = int(v)
    f, i = np.float32(v - i), 3 * i
    return (
        strip[i] + f * (strip[i + 3] - strip[i]),
        strip[i + 1] + f * (strip[i + 4] - strip[i + 1]),
        strip[i + 2] + f * (strip[i + 5] - strip[i + 2]),
    )


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _paint_plain(top: float, bottom: float, weight: float, colour: np.ndarray, column: np.ndarray) -> None:
    """Add an even colour to the rows between two image heights."""
    for r in range(int(top), int(np.ceil(bottom))):
        share = np.float32(weight * (min(r + 1.0, bottom) - max(float(r), top)))
        for c in range(3):
            column[3 * r + c] += share * colour[c]


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _paint_wall(rows: tuple, weight: float, texels: tuple, strip: np.ndarray, column: np.ndarray) -> None:
    """Add the texture of a wall to the rows between two image heights; `texels` at height 0, and per row."""
    top, bottom = rows
    v, step = texels
    share = np.float32(weight / max(step, 1.0))
    l0, l1, l2 = _read(strip, v - bottom * step)
    for r in range(int(np.ceil(bottom)) - 1, int(top) - 1, -1):
        above, below = max(float(r), top), min(r + 1.0, bottom)
        if step < 1.0:  # an average over one texel, which is linear interpolation
            middle = v - 0.5 * (above + below) * step
            share = np.float32(weight * (below - above))
            l0, l1, l2 = _read(strip, middle - 0.5)
            h0, h1, h2 = _read(strip, middle + 0.5)
        else:
            h0, h1, h2 = _read(strip, v - above * step)
        column[3 * r] += share * (h0 - l0)
        column[3 * r + 1] += share * (h1 - l1)
        column[3 * r + 2] += share * (h2 - l2)
        l0, l1, l2 = h0, h1, h2


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _climb(part: tuple[float, float], count: int, paints: Paints, view: _View) -> None:
    """Let the gaze climb one part of a column past the faces it meets."""
    faces, column, eye = view.faces, view.column, view.lens.eye
    weight = part[1] - part[0]
    gaze = float(len(column) // 3)
    horizon = 0.5 * gaze
    ground, colour = 0.0, paints.floor
    for k in range(count):
        f, scale = view.face[k], view.lens.focal * view.nearness[k]
        foot = max(horizon + scale * (eye - ground), 0.0)
        if foot < gaze:
            _paint_plain(foot, gaze, weight, colour, column)
            gaze = foot
        if faces.closed[f] and view.line[f, 6] > 0.0:
            ground, colour = 0.0, paints.floor
            continue
        top = max(horizon + scale * (eye - faces.height[f]), 0.0)
        if top < gaze:
            step = 1.0 / (scale * TEXEL)
            v = eye / TEXEL + horizon * step
            up = max(int(np.floor(v - gaze * step)) - 1, 0), int(np.floor(v - top * step)) + 2
            along = _texel(part[0], f, view), _texel(part[1], f, view)
            _unroll(along, up, faces.material[f], paints, view.strip)
            _paint_wall((top, gaze), weight, (v - up[0], step), view.strip, column)
            gaze = top
        if gaze <= 0.0:
            return
        if faces.closed[f] and faces.height[f] < eye:
            ground, colour = faces.height[f], paints.lid[faces.material[f]]
    if gaze > horizon:
        _paint_plain(horizon, gaze, weight, colour, column)
        gaze = horizon
    _paint_plain(0.0, gaze, weight, paints.ceiling, column)


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _look(pose: np.ndarray, faces: Faces, paints: Paints, lens: Lens, out: np.ndarray) -> None:
    """Paint the view from one pose."""
    height = len(out)
    view = _view(faces, lens, height)
    grey = np.empty(3 * height, np.uint8)
    _project(pose, view)
    first, listed = _bucket(view)
    for c in range(lens.width):
        touching = listed[first[c] : first[c + 1]]
        view.column[:] = 0.5  # rounds when cut to whole grey levels below
        x = float(c)
        while x < c + 1:
            edge = _split(x, touching, view)
            count = _meet(0.5 * (x + edge), touching, view)
            _climb((x, edge), count, paints, view)
            x = edge
        for k in range(3 * height):
            grey[k] = np.uint8(min(max(view.column[k], np.float32(0)), np.float32(255)))
        for r in range(height):
            for k in range(3):
                out[r, c, k] = grey[3 * r + k]


@njit(cache=True, error_model="numpy")
@typing.no_type_check
def _measure(pose: np.ndarray, faces: Faces, lens: Lens, out: np.ndarray) -> None:
    """Measure the distances from one pose."""
    view = _view(faces, lens, 0)
    _project(pose, view)
    first, listed = _bucket(view)
    for c in range(lens.width):
        ahead, left = _ray(c + 0.5, lens)
        count = _meet(c + 0.5, listed[first[c] : first[c + 1]], view)
        out[c] = np.hypot(ahead, left) / view.nearness[0] if count > 0 else np.inf


@njit(parallel=True, cache=True, error_model="numpy")
@typing.no_type_check
def render(
    poses: Float[np.ndarray, "views 3"],
    faces: Faces,
    paints: Paints,
    lens: Lens,
    out: UInt8[np.ndarray, "views height width 3"],
) -> None:
    """Paint the view from every pose (m, m, rad) into `out`; views run in parallel."""
    for i in prange(len(poses)):
        _look(poses[i], faces, paints, lens, out[i])


@njit(parallel=True, cache=True, error_model="numpy")
@typing.no_type_check
def depths(
    poses: Float[np.ndarray, "views 3"], faces: Faces, lens: Lens, out: Float[np.ndarray, "views width"]
) -> None:
    """Write the distance (m) along each column's middle ray into `out`; infinity where nothing is met."""
    for i in prange(len(poses)):
        _measure(poses[i], faces, lens, out[i])
