"""Ray casting: what single rays meet, those of columns for depth and those of pixels for names."""

import typing

import numpy as np
from jaxtyping import Float, Int32

from arena.eye import stretches
from arena.eye.projection import PROJECTED_FACE, Faces, Lens, Poses, direction, place
from arena.eye.stretches import Sweep
from arena.kernels import bare_kernel, kernel

FLOOR, CEILING = -1, -2
"""What `identify` calls the two surfaces that are not of any face or solid."""


@kernel(forceinline=True)
@typing.no_type_check
def _look(pose: np.ndarray, faces: np.ndarray, lens: Lens) -> tuple:
    """Project the faces, and begin a sweep over the image."""
    sights, sweep = np.empty(len(faces), PROJECTED_FACE), stretches.sweep_over(len(faces))
    place(pose, faces, lens, sights, sweep.span)
    stretches.begin(sweep)
    return sights, sweep


@bare_kernel(forceinline=True)
@typing.no_type_check
def _meet(c: int, sweep: Sweep, faces: np.ndarray, sights: np.ndarray, lens: Lens) -> int:
    """Find what is active at the middle ray of column c, from near to far; its number."""
    stretches.enter(c + 0.5, sweep)
    # Exactly there: between the sides of a column the cosine of an angle is not linear.
    ray = direction(c + 0.5, lens)
    stretches.sort((ray, ray), faces, sights, sweep)
    return sweep.at[1]


@kernel(nogil=True)
@typing.no_type_check
def measure(poses: Poses, faces: Faces, lens: Lens, out: Float[np.ndarray, "views width"]) -> None:
    """Write the distance (m) along each column's middle ray into `out`; infinity where nothing is met."""
    for i in range(len(poses)):
        sights, sweep = _look(poses[i], faces, lens)
        for c in range(lens.width):
            ahead, left = direction(c + 0.5, lens)
            # Depth along the axis times the length of the ray is the distance.
            met = _meet(c, sweep, faces, sights, lens)
            out[i, c] = np.hypot(ahead, left) / sweep.near[0, 0] if met > 0 else np.inf


@kernel()
@typing.no_type_check
def _name(pose: np.ndarray, faces: np.ndarray, lens: Lens, out: np.ndarray) -> None:
    """Name the surface at the middle of every pixel of one view."""
    sights, sweep = _look(pose, faces, lens)
    horizon = 0.5 * lens.height
    for c in range(lens.width):
        row, ground, beneath = lens.height - 1, 0.0, FLOOR
        for i in range(_meet(c, sweep, faces, sights, lens)):
            f, scale = stretches.face_of(sweep.active[i], faces), lens.focal * sweep.near[i, 0]
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


@kernel(nogil=True)
@typing.no_type_check
def identify(poses: Poses, faces: Faces, lens: Lens, out: Int32[np.ndarray, "views height width"]) -> None:
    """Write what is seen at the middle of each pixel into `out`; see `arena.eye.camera.Camera.identify`."""
    for i in range(len(poses)):
        _name(poses[i], faces, lens, out[i])
