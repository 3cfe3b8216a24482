"""Stretches: the image cut where what is in sight changes, and the faces that stand in each, near to far.

A plane is swept over the image from left to right. Between two ends of faces the same faces stand in the same
order, unless two of them cross, so that few sorts serve all columns. Faces that are hidden along the whole
stretch are left out: neighbours that then list the same faces are one stretch.
"""

import typing

import numpy as np

from arena.eye.projection import Lens, met_at, ray_at
from arena.kernels import bare_kernel, kernel

_TINY = 1e-7
"""What is narrower than this (pixels) is nothing: ends that should be the same differ by rounding."""


class Sweep(typing.NamedTuple):
    """Memory of a sweep over the image. A row is a face or, past those, what of it lies beyond the seam."""

    span: np.ndarray
    """First and last image coordinate of each row."""
    order: np.ndarray
    """Rows that cover something, by where they begin."""
    at: np.ndarray
    """How many of `order` have begun, how many rows are active, and how many `order` has."""
    active: np.ndarray
    """Rows that the plane cuts, from near to far."""
    near: np.ndarray
    """1 / depth of what is active, or how high over the eye by depth what is seen rises, at both sides."""
    seen: np.ndarray
    """The faces in sight, from near to far."""


@kernel(forceinline=True)
@typing.no_type_check
def sweep_over(faces: int) -> Sweep:
    """Make room for a sweep."""
    rows = 2 * faces
    order, active, seen = np.empty(rows, np.int64), np.empty(rows, np.int64), np.empty(rows, np.int64)
    return Sweep(np.empty((rows, 2)), order, np.zeros(3, np.int64), active, np.empty((rows, 2)), seen)


@bare_kernel(forceinline=True)
@typing.no_type_check
def face_of(row: int, faces: np.ndarray) -> int:
    """Which face a row is of."""
    return row if row < len(faces) else row - len(faces)


@bare_kernel()
@typing.no_type_check
def begin(sweep: Sweep) -> None:
    """Begin a sweep at the left of the image, once its spans are known."""
    span, order, count = sweep.span, sweep.order, 0
    for row in range(len(span)):
        if span[row, 1] > span[row, 0]:
            order[count] = row
            count += 1
    # Shell's sort: short, without memory, and fast for the few dozens of a room.
    gap = 1
    while 3 * gap < count:
        gap = 3 * gap + 1
    while gap > 0:
        for k in range(gap, count):
            row, i = order[k], k
            while i >= gap and span[order[i - gap], 0] > span[row, 0]:
                order[i] = order[i - gap]
                i -= gap
            order[i] = row
        gap //= 3
    sweep.at[0], sweep.at[1], sweep.at[2] = 0, 0, count


@bare_kernel()
@typing.no_type_check
def enter(x: float, sweep: Sweep) -> float:
    """Drop the rows that ended before x, take in those that begin there; where the next begins or ends."""
    span, order, active = sweep.span, sweep.order, sweep.active
    n, i = 0, sweep.at[0]
    for k in range(sweep.at[1]):
        if span[active[k], 1] > x + _TINY:
            active[n] = active[k]
            n += 1
    while i < sweep.at[2] and span[order[i], 0] <= x + _TINY:
        if span[order[i], 1] > x + _TINY:
            active[n] = order[i]
            n += 1
        i += 1
    sweep.at[0], sweep.at[1] = i, n
    end = span[order[i], 0] if i < sweep.at[2] else np.inf
    for k in range(n):
        end = min(end, span[active[k], 1])
    return end


@bare_kernel()
@typing.no_type_check
def sort(rays: tuple, faces: np.ndarray, sights: np.ndarray, sweep: Sweep) -> bool:
    """Sort what is active from near to far by the middle; whether that is the order at both sides, too."""
    active, near = sweep.active, sweep.near
    for k in range(sweep.at[1]):
        row = active[k]
        f = face_of(row, faces)
        low, high = met_at(sights[f], rays[0]), met_at(sights[f], rays[1])
        # Where two solids touch, the far face of one is met before the near face of the other, whatever the
        # rounding: its top ends, and then the other begins.
        if faces[f].closed and sights[f].aside > 0.0:
            low, high = low * (1 + 1e-9), high * (1 + 1e-9)
        i = k
        # Sorted nearly already, as the sweep comes from the stretch before.
        while i > 0 and near[i - 1, 0] + near[i - 1, 1] < low + high:
            active[i], near[i, 0], near[i, 1] = active[i - 1], near[i - 1, 0], near[i - 1, 1]
            i -= 1
        active[i], near[i, 0], near[i, 1] = row, low, high
    for k in range(1, sweep.at[1]):
        # Faces that share a vertex meet at a side: the tolerance is theirs.
        if near[k - 1, 0] < near[k, 0] * (1 - 1e-6) or near[k - 1, 1] < near[k, 1] * (1 - 1e-6):
            return False
    return True


@bare_kernel()
@typing.no_type_check
def look(x: float, sweep: Sweep, seen_by: tuple, lens: Lens, ray: np.ndarray) -> tuple[float, int]:
    """Find the faces in sight from x on, from near to far: to where that holds, and how many are `seen`.

    `seen_by` are the faces of the room and as the eye sees them.
    """
    faces, sights = seen_by
    end = min(enter(x, sweep), float(lens.width))
    # Where faces cross, each column has the order of its own middle.
    while not sort((ray_at(x, ray), ray_at(end, ray)), faces, sights, sweep) and end > int(x) + 1.0:
        end = int(x) + 1.0
    near, seen, count = sweep.near, sweep.seen, 0
    reach = 0.5 * lens.height / lens.focal
    for k in range(sweep.at[1]):
        f = face_of(sweep.active[k], faces)
        rise = faces[f].height - lens.eye
        low, high = near[k, 0] * rise, near[k, 1] * rise
        # The far side of a solid ends its top: it matters if its near side is seen. Other faces are hidden by
        # one that is nearer and seen higher at both sides. What was kept is in the front of `near`.
        far_side = faces[f].closed and sights[f].aside > 0.0
        hidden = far_side
        for j in range(count):
            if far_side:
                hidden = hidden and faces[seen[j]].solid != faces[f].solid
            else:
                hidden = hidden or (low <= near[j, 0] and high <= near[j, 1])
        if hidden:
            continue
        seen[count], near[count, 0], near[count, 1] = f, low, high
        count += 1
        if low >= reach and high >= reach:
            break  # up to the first row: nothing is left for what is behind
    return end, count
