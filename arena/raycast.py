"""The kernels of the eye: what one upright camera sees of vertical faces on a flat floor.

Every pixel is the mean of the texture over the area it covers, so that the image changes smoothly as the eye moves. The
faces are projected once per view and sorted into the image columns they touch. A column is split wherever a face begins
or ends inside it; in each part the faces are met from near to far, and the gaze climbs from the floor at the animal's
feet to the ceiling, painting whatever is not hidden behind something nearer. A face lower than the eye shows what stands
behind it, and its lid: the far face of such a box is painted in the colour of its top.
"""

import typing

import numpy as np
from numba import njit, prange

from arena.materials import TEXEL, TILE

_NEAR = 1e-4
"""Nearest depth (m) a perspective camera can see."""


@njit(cache=True)
@typing.no_type_check
def _ray(x, width, focal, panoramic):
    """Direction (forward, left) of image coordinate x; its forward part is 1 in perspective."""
    if panoramic:
        azimuth = np.pi - x / focal
        return np.cos(azimuth), np.sin(azimuth)
    return 1.0, (0.5 * width - x) / focal


@njit(cache=True)
@typing.no_type_check
def _project(pose, start, end, width, focal, panoramic, span, ends):
    """Put the faces into the eye's frame (`ends`: forward and left of both ends) and find what they cover.

    Rows of `span` are (first, last) image coordinates; a face across the seam of a panorama gets two rows, f and
    f + faces. Rows that cover nothing have last <= first.
    """
    faces = len(start)
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    for f in range(faces):
        for k in range(2):
            point = start[f] if k == 0 else end[f]
            dx, dy = point[0] - pose[0], point[1] - pose[1]
            ends[f, 2 * k] = cosine * dx + sine * dy
            ends[f, 2 * k + 1] = cosine * dy - sine * dx
        span[f] = 0.0
        span[f + faces] = 0.0
        ax, ay, bx, by = ends[f]
        if panoramic:
            xa = focal * (np.pi - np.arctan2(ay, ax))
            xb = focal * (np.pi - np.arctan2(by, bx))
            low, high = min(xa, xb), max(xa, xb)
            if high - low <= 0.5 * width:
                span[f, 0], span[f, 1] = low, high
            else:
                span[f, 0], span[f, 1] = high, width
                span[f + faces, 0], span[f + faces, 1] = 0.0, low
        else:
            if ax < _NEAR and bx < _NEAR:
                continue
            if ax < _NEAR:
                ay += (by - ay) * (_NEAR - ax) / (bx - ax)
                ax = _NEAR
            elif bx < _NEAR:
                by += (ay - by) * (_NEAR - bx) / (ax - bx)
                bx = _NEAR
            xa = 0.5 * width - focal * ay / ax
            xb = 0.5 * width - focal * by / bx
            span[f, 0] = min(max(min(xa, xb), 0.0), width)
            span[f, 1] = min(max(max(xa, xb), 0.0), width)


@njit(cache=True)
@typing.no_type_check
def _bucket(span, width, first):
    """List the rows of `span` that touch each column: those of column c are listed[first[c]:first[c + 1]]."""
    first[:] = 0
    for row in range(len(span)):
        if span[row, 1] > span[row, 0]:
            for c in range(int(span[row, 0]), min(int(np.ceil(span[row, 1])), width)):
                first[c + 1] += 1
    for c in range(width):
        first[c + 1] += first[c]
    listed = np.empty(first[width], np.int32)
    fill = first[:-1].copy()
    for row in range(len(span)):
        if span[row, 1] > span[row, 0]:
            for c in range(int(span[row, 0]), min(int(np.ceil(span[row, 1])), width)):
                listed[fill[c]] = row
                fill[c] += 1
    return listed


@njit(cache=True)
@typing.no_type_check
def _hits(x, touching, span, ends, width, focal, panoramic, face, depth):
    """Find the faces that the ray at x meets, from near to far; their number."""
    dx, dy = _ray(x, width, focal, panoramic)
    faces = len(ends)
    count = 0
    for row in touching:
        if span[row, 0] <= x < span[row, 1]:
            f = row % faces
            ax, ay, bx, by = ends[f]
            across = (by - ay) * dx - (bx - ax) * dy
            t = ((by - ay) * ax - (bx - ax) * ay) / across if across != 0.0 else np.inf
            k = count
            while k > 0 and depth[k - 1] > t:
                depth[k], face[k] = depth[k - 1], face[k - 1]
                k -= 1
            depth[k], face[k] = t, f
            count += 1
    return count


@njit(cache=True)
@typing.no_type_check
def _along(x, ax, ay, bx, by, width, focal, panoramic):
    """How far along a face (m, clipped to it) the ray at x meets its line."""
    dx, dy = _ray(x, width, focal, panoramic)
    ex, ey = bx - ax, by - ay
    length = np.hypot(ex, ey)
    across = ey * dx - ex * dy
    if across == 0.0:
        return 0.0
    along = (ay * dx - ax * dy) / across * -length
    return min(max(along, 0.0), length)


@njit(cache=True)
@typing.no_type_check
def _blend(mean, a0, b0, f0, a1, b1, f1, scale, out):
    """Mean of each texel row over a footprint: slices of equal length, so that the compiler can use SIMD."""
    for k in range(len(out)):
        out[k] = mean[k] + scale * (a1[k] - a0[k] + f1 * (b1[k] - a1[k]) - f0 * (b0[k] - a0[k]))


@njit(cache=True)
@typing.no_type_check
def _unroll(u0, u1, v0, v1, sums, mean, strip):
    """Fill `strip` with running sums, from texel row v0 up to v1, of the texture's mean over [u0, u1] (texels)."""
    if u1 - u0 < 1.0:  # a footprint of one texel at least is linear interpolation when magnified
        u0, u1 = 0.5 * (u0 + u1) - 0.5, 0.5 * (u0 + u1) + 0.5
    tile, rise = TILE
    i0, i1 = int(np.floor(u0)), int(np.floor(u1))
    f0, f1 = np.float32(u0 - i0), np.float32(u1 - i1)
    a0, b0 = sums[i0 % tile], sums[i0 % tile + 1]
    a1, b1 = sums[i1 % tile], sums[i1 % tile + 1]
    scale = np.float32(1.0 / (u1 - u0))
    at = 3
    v = v0
    while v < v1:
        low = 3 * (v % rise)
        n = min(3 * (v1 - v), 3 * rise - low)
        _blend(
            mean[low : low + n], a0[low : low + n], b0[low : low + n], f0, a1[low : low + n], b1[low : low + n], f1,
            scale, strip[at : at + n],
        )  # fmt: skip
        at += n
        v += n // 3
    strip[:3] = 0.0
    for k in range(3, at):
        strip[k] += strip[k - 3]


@njit(cache=True)
@typing.no_type_check
def _paint_plain(top, bottom, weight, colour, column):
    """Add an even colour to the rows between two image heights."""
    for r in range(int(top), min(int(np.ceil(bottom)), len(column))):
        share = np.float32(weight * (min(r + 1.0, bottom) - max(float(r), top)))
        for c in range(3):
            column[r, c] += share * colour[c]


@njit(cache=True)
@typing.no_type_check
def _paint_wall(top, bottom, weight, texels_per_row, eye, u0, u1, sums, mean, strip, column):
    """Add the texture of a wall to the rows between two image heights; `eye` is the eye's height in texels."""
    middle = 0.5 * len(column)
    v_low = int(np.floor(eye - (bottom - middle) * texels_per_row)) - 1
    v_high = int(np.floor(eye - (top - middle) * texels_per_row)) + 2
    _unroll(u0, u1, v_low, v_high, sums, mean, strip)
    for r in range(int(top), min(int(np.ceil(bottom)), len(column))):
        above, below = max(float(r), top), min(r + 1.0, bottom)
        va = eye - (below - middle) * texels_per_row - v_low
        vb = eye - (above - middle) * texels_per_row - v_low
        if vb - va < 1.0:
            va, vb = 0.5 * (va + vb) - 0.5, 0.5 * (va + vb) + 0.5
        i, j = int(va), int(vb)
        fi, fj = np.float32(va - i), np.float32(vb - j)
        i, j = 3 * i, 3 * j
        share = np.float32(weight * (below - above) / (vb - va))
        for c in range(3):
            low = strip[i + c] + fi * (strip[i + c + 3] - strip[i + c])
            high = strip[j + c] + fj * (strip[j + c + 3] - strip[j + c])
            column[r, c] += share * (high - low)


@njit(cache=True)
@typing.no_type_check
def _climb(count, face, depth, ends, surface, weave, plain, lens, x0, x1, strip, column):
    """Let the gaze climb one part [x0, x1] of a column past the faces it meets."""
    height, material, offset, closed = surface
    sums, mean, lid = weave
    floor, ceiling = plain
    width, focal, eye, panoramic = lens
    weight = x1 - x0
    horizon = 0.5 * len(column)
    gaze = float(len(column))
    for k in range(count):
        f, t = face[k], depth[k]
        ax, ay, bx, by = ends[f]
        away = closed[f] and (ax * by - ay * bx) > 0.0
        if away and height[f] >= eye:
            continue
        foot = max(horizon + focal * eye / t, 0.0)
        if foot < gaze:
            _paint_plain(foot, gaze, weight, floor, column)
            gaze = foot
        top = max(horizon - focal * (height[f] - eye) / t, 0.0)
        if top < gaze:
            m = material[f]
            if away:
                _paint_plain(top, gaze, weight, lid[m], column)
            else:
                ua = (offset[f] + _along(x0, ax, ay, bx, by, width, focal, panoramic)) / TEXEL
                ub = (offset[f] + _along(x1, ax, ay, bx, by, width, focal, panoramic)) / TEXEL
                step = t / (focal * TEXEL)
                _paint_wall(
                    top,
                    gaze,
                    weight,
                    step,
                    eye / TEXEL,
                    min(ua, ub),
                    max(ua, ub),
                    sums[m],
                    mean[m],
                    strip,
                    column,
                )
            gaze = top
        if gaze <= 0.0:
            return
    if gaze > horizon:
        _paint_plain(horizon, gaze, weight, floor, column)
        gaze = horizon
    _paint_plain(0.0, gaze, weight, ceiling, column)


@njit(parallel=True, cache=True)
@typing.no_type_check
def render(poses, start, end, surface, weave, plain, lens, out):
    """Paint the view from every pose into `out`, (views, height, width, 3) uint8; views run in parallel.

    `surface` is (height, material, offset, closed) per face, `weave` the running sums of the textures, `plain` the
    colours of floor and ceiling, `lens` is (width, focal length in pixels, eye height in m, panoramic).
    """
    width, focal, eye, panoramic = lens
    faces = len(start)
    rows = out.shape[1]
    reach = int(surface[0].max() / TEXEL) + 8
    for view in prange(len(poses)):
        span = np.empty((2 * faces, 2))
        ends = np.empty((faces, 4))
        first = np.empty(width + 1, np.int64)
        face = np.empty(2 * faces, np.int64)
        depth = np.empty(2 * faces)
        strip = np.empty(3 * reach, np.float32)
        column = np.empty((rows, 3), np.float32)
        _project(poses[view], start, end, width, focal, panoramic, span, ends)
        listed = _bucket(span, width, first)
        for c in range(width):
            touching = listed[first[c] : first[c + 1]]
            column[:] = 0.5  # rounds when cut to whole grey levels below
            x0 = float(c)
            while x0 < c + 1:
                x1 = c + 1.0
                for row in touching:
                    for edge in span[row]:
                        if x0 < edge < x1:
                            x1 = edge
                count = _hits(0.5 * (x0 + x1), touching, span, ends, width, focal, panoramic, face, depth)
                _climb(count, face, depth, ends, surface, weave, plain, lens, x0, x1, strip, column)
                x0 = x1
            for r in range(rows):
                for k in range(3):
                    out[view, r, c, k] = np.uint8(min(max(column[r, k], 0.0), 255.0))


@njit(parallel=True, cache=True)
@typing.no_type_check
def depths(poses, start, end, lens, out):
    """Write the distance (m) along the middle ray of every column to the nearest face into `out`, else infinity."""
    width, focal, _, panoramic = lens
    faces = len(start)
    for view in prange(len(poses)):
        span = np.empty((2 * faces, 2))
        ends = np.empty((faces, 4))
        first = np.empty(width + 1, np.int64)
        face = np.empty(2 * faces, np.int64)
        depth = np.empty(2 * faces)
        _project(poses[view], start, end, width, focal, panoramic, span, ends)
        listed = _bucket(span, width, first)
        for c in range(width):
            touching = listed[first[c] : first[c + 1]]
            count = _hits(c + 0.5, touching, span, ends, width, focal, panoramic, face, depth)
            dx, dy = _ray(c + 0.5, width, focal, panoramic)
            out[view, c] = depth[0] * np.hypot(dx, dy) if count > 0 else np.inf
