"""Joints against coordinates that were found without them: windings, a regression on a held-out half, errors.

Joints are (views, joints), rad or m; `circles` tells which of them turn all round.
"""

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial import KDTree
from sklearn.kernel_ridge import KernelRidge
from sklearn.model_selection import GridSearchCV

from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.inputs import check_array
from cogmap.threads import one_thread

Joints = Float[np.ndarray, "views joints"]
Circles = Sequence[bool] | Bool[np.ndarray, "joints"]

WAYS, STEPS = 100, 48
"""Ways on which windings are counted for each joint, and steps of each."""
AROUND = 8
"""Views between which a phase is read on such a way."""
WIDTHS, RIDGES = (0.3, 1.0, 3.0, 10.0), (1e-5, 1e-3)
"""Kernels exp(−γ d²) and penalties of their weights among which the training half chooses."""


class Windings(NamedTuple):
    """How often phases go round while a joint does."""

    matrix: Float[np.ndarray, "loops joints"]
    """Whole turns of a phase a turn of a joint; rad per rad or m of one that has limits."""
    agreement: float
    """Share of the ways, over phases and joints that turn all round, on which as many turns are counted."""
    determinant: int | None
    """Of the whole numbers: ±1 where phases are angles up to a change of basis; None if not as many."""


class JointReading(NamedTuple):
    """Joints as a regression reads them from coordinates, on the half of the views that it is not shown."""

    views: Int[np.ndarray, "test"]
    errors: Float[np.ndarray, "test joints"]
    """Read minus true, rad the short way round, or m."""
    correlations: Float[np.ndarray, "joints"]
    """R between what is true and what is read."""


def windings(phases: Float[np.ndarray, "views loops"], joints: Joints, circles: Circles) -> Windings:
    """Count how often each phase goes round when one joint does and all others rest.

    Along such a way a phase is read between the views whose joints are nearest, and its steps add up to whole
    turns, to the bit, however uneven it is. What most ways say counts.

    Parameters
    ----------
    phases
        rad, as the first columns of `GeneralisedCoordinates.transform`.
    joints, circles
        The truth.
    """
    turning = _checked(phases, joints, circles)
    tree = KDTree(_unrolled(joints, turning))
    starts = joints[np.linspace(0, len(joints) - 1, min(WAYS, len(joints))).astype(int)]
    matrix, shares = np.empty((phases.shape[1], joints.shape[1])), []
    for joint, closed in enumerate(turning):
        first, last = (
            (-np.pi, np.pi) if closed else map(float, (joints[:, joint].min(), joints[:, joint].max()))
        )
        way = np.repeat(starts[:, None], STEPS, axis=1)
        way[:, :, joint] = np.linspace(first, last, STEPS, endpoint=not closed)
        near = tree.query(_unrolled(way.reshape(-1, joints.shape[1]), turning), k=AROUND)[1]
        read = np.angle(np.exp(1j * phases[near]).mean(axis=1)).reshape(*way.shape[:2], phases.shape[1])
        gone = wrap_angle(np.diff(read, axis=1, append=read[:, :1] if closed else read[:, -1:])).sum(axis=1)
        if not closed:
            matrix[:, joint] = np.median(gone, axis=0) / (last - first)
            continue
        turns = np.rint(gone / (2 * np.pi)).astype(int)
        for loop, counted in enumerate(turns.T):
            values, counts = np.unique(counted, return_counts=True)
            matrix[loop, joint] = values[counts.argmax()]
            shares.append(counts.max() / len(counted))
    whole = matrix[:, turning]
    square = whole.shape[0] == whole.shape[1] > 0
    determinant = round(float(np.linalg.det(whole))) if square else None
    return Windings(matrix, float(np.mean(shares)) if shares else 1.0, determinant)


def read_joints(
    coordinates: Float[np.ndarray, "views coordinates"],
    loops: int,
    joints: Joints,
    circles: Circles,
    *,
    most: int = 2000,
    seed: int = 0,
) -> JointReading:
    """Regress joints on coordinates of half of the views, and read them from those of the other half.

    Kernel ridge regression, for an angle of its cosine and sine; width and penalty are chosen by three-fold
    cross-validation within the first half.

    Parameters
    ----------
    coordinates
        `loops` phases (rad) first, then heights.
    joints, circles
        The truth.
    most
        Views that the regression is shown, and that it is asked.
    seed
        Draws the halves.

    References
    ----------
    A Visual Sense of Space, Table 2.
    """
    turning = _checked(coordinates, joints, circles)
    chosen = np.random.default_rng(seed).permutation(len(joints))
    train, test = (half[:most] for half in np.array_split(chosen, 2))
    phases, rest = coordinates[:, :loops], coordinates[:, loops:]
    given = np.hstack([np.cos(phases), np.sin(phases), rest])
    target = _unrolled(joints, turning)
    middle, spread = target[train].mean(axis=0), target[train].std(axis=0)
    search = GridSearchCV(KernelRidge(kernel="rbf"), {"gamma": WIDTHS, "alpha": RIDGES}, cv=3)
    with one_thread():
        search.fit(given[train], (target[train] - middle) / spread)
        read = search.predict(given[test]) * spread + middle
    errors = joint_errors(_rolled(read, turning), joints[test], turning)
    # θ with θ + error, so that an angle read just beyond π is near.
    correlations = [
        np.corrcoef(true, true + error)[0, 1] for true, error in zip(joints[test].T, errors.T, strict=True)
    ]
    return JointReading(test, errors, np.array(correlations))


def interpolated_joints(
    indices: Int[np.ndarray, "queries neighbours"],
    weights: Float[np.ndarray, "queries neighbours"],
    joints: Joints,
    circles: Circles,
) -> Float[np.ndarray, "queries joints"]:
    """Give Σ w · joint for each view that a `Localiser` placed; angles from the nearest's, the short way."""
    turning = np.asarray(circles)
    here = joints[indices[:, 0]]
    ways = joints[indices] - here[:, None]
    ways[:, :, turning] = wrap_angle(ways[:, :, turning])
    found: np.ndarray = here + np.einsum("qk,qkj->qj", weights, ways)
    found[:, turning] = wrap_angle(found[:, turning])
    return found


def joint_errors(read: Joints, truth: Joints, circles: Circles) -> Joints:
    """Subtract what is true from what is read, the short way round where a joint turns all round."""
    errors: np.ndarray = read - truth
    turning = np.asarray(circles)
    errors[:, turning] = wrap_angle(errors[:, turning])
    return errors


def joint_medians(errors: Joints, units: Sequence[Literal["rad", "m"]]) -> list[float]:
    """Take the median size of the errors of each joint, in degrees where its unit is rad, and else in m."""
    middle = np.median(abs(errors), axis=0)
    return [float(np.rad2deg(m) if unit == "rad" else m) for m, unit in zip(middle, units, strict=True)]


def _checked(coordinates: np.ndarray, joints: np.ndarray, circles: Circles) -> Bool[np.ndarray, "joints"]:
    check_array("joints", joints, (None, None))
    check_array("coordinates", coordinates, (len(joints), None))
    turning = np.asarray(circles, dtype=bool)
    if len(turning) != joints.shape[1]:
        raise CogmapError(f"there are {joints.shape[1]} joints but {len(turning)} circles; tell of each")
    return turning


def _unrolled(joints: Joints, turning: Bool[np.ndarray, "joints"]) -> Float[np.ndarray, "views features"]:
    """Give an angle its cosine and sine, so that its ends meet."""
    angles = joints[:, turning]
    return np.hstack([np.cos(angles), np.sin(angles), joints[:, ~turning]])


def _rolled(features: Float[np.ndarray, "views features"], turning: Bool[np.ndarray, "joints"]) -> Joints:
    count = int(turning.sum())
    joints = np.empty((len(features), len(turning)))
    joints[:, turning] = np.arctan2(features[:, count : 2 * count], features[:, :count])
    joints[:, ~turning] = features[:, 2 * count :]
    return joints
