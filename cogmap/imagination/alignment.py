"""Image alignment (Lucas & Kanade): the pose at which a view is imagined most like it is seen."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, Float32, Num

WIDTH = 90
"""Columns of the coarse panoramas that are compared."""
STEPS = 2
CUT = 3.0
"""Error, in units of its robust standard deviation, from which on a pixel counts less."""

Pose = Float[np.ndarray, "views 3"]


class Seen(NamedTuple):
    """What is imagined at the poses of some views."""

    coarse: Float32[np.ndarray, "views pixels"]
    unusual: Float32[np.ndarray, "views height width"]
    """How much the views differ from it, pixel by pixel (`surprise.unusual`)."""


Painter = Callable[[Pose], Float32[np.ndarray, "views pixels"]]


def coarse(view: Num[np.ndarray, "height width 3"]) -> Float32[np.ndarray, "pixels"]:
    """Average a panorama down to `WIDTH` columns: a step moves edges by a fraction of a pixel of these."""
    height, width = coarse_size(*view.shape[:2])
    small = cv2.resize(np.asarray(view, np.float32), (width, height), interpolation=cv2.INTER_AREA)
    return np.asarray(np.clip(small, 0, 255)).ravel()


def coarse_size(height: int, width: int) -> tuple[int, int]:
    """Give height and width of a coarse panorama."""
    shrunk = min(1.0, WIDTH / width)
    return max(1, round(height * shrunk)), round(width * shrunk)


def aligned(
    views: Float32[np.ndarray, "views pixels"],
    poses: Pose,
    there: Seen,
    *,
    fine: Callable[[Pose], Seen],
    quick: Painter,
    reach: Float[np.ndarray, "3"],
) -> tuple[Pose, Seen]:
    r"""Move poses until what is imagined there fits what is seen, whatever of it has changed.

    With D the imagined view and J its derivatives with respect to the pose, by central differences,

    .. math:: \delta = \arg\min \sum_i \rho(v_i - D_i - J_i \delta),

    with the loss of Geman & McClure (1987), under which pixels that do not fit at all have no say. A step
    that makes the fit worse is taken back.

    Parameters
    ----------
    views
        What is seen, `coarse`.
    poses, there
        Where they are perceived, position and phase, and what is imagined there.
    fine, quick
        Give imagined views; the second, `coarse`, for their derivatives.
    reach
        Differences of pose over which a view changes almost linearly.

    Returns
    -------
    poses, there
        After the moves.

    References
    ----------
    Lucas & Kanade (1981), An iterative image registration technique; Baker & Matthews (2004), Lucas-Kanade 20
    years on. Black & Anandan (1996), The robust estimation of multiple motions.
    """
    left = views - there.coarse
    for _ in range(STEPS):
        slopes = np.stack(
            [(quick(poses + step) - quick(poses - step)) / 2 for step in np.diag(reach)],
            axis=2,
        )
        scale = 1.4826 * np.median(np.abs(left), axis=1) + 0.5
        moves = np.stack([_step(*one) for one in zip(left, slopes, scale.tolist(), strict=True)])
        tried = poses + np.clip(moves, -3, 3) * reach
        new = fine(tried)
        better = _loss(views - new.coarse, scale) < _loss(left, scale)
        poses = np.where(better[:, None], tried, poses)
        there = Seen(
            np.where(better[:, None], new.coarse, there.coarse),
            np.where(better[:, None, None], new.unusual, there.unusual),
        )
        left = views - there.coarse
    return poses, there


def _step(
    left: Float32[np.ndarray, "pixels"], slopes: Float32[np.ndarray, "pixels 3"], scale: float
) -> Float[np.ndarray, "3"]:
    """Solve for a move, in units of the reach, by reweighted least squares."""
    move = np.zeros(3)
    prior = 1e-3 * np.square(slopes).sum() / 3 * np.eye(3) + 1e-9 * np.eye(3)
    for _ in range(5):
        weight = 1 / np.square(1 + np.square((left - slopes @ move) / (CUT * scale)))
        weighed = slopes * weight[:, None]
        move = np.linalg.solve(weighed.T @ slopes + prior, weighed.T @ left)
    return move


def _loss(
    left: Float32[np.ndarray, "views pixels"], scale: Float[np.ndarray, "views"]
) -> Float[np.ndarray, "views"]:
    squares = np.square(left / (CUT * scale[:, None]))
    return np.asarray((squares / (1 + squares)).mean(axis=1))
