"""Weighing: whether the codes of remembered views tell more of place than that a view is the nearest.

A regression on codes goes far between views where noise is small against the distance to the nearest view,
and follows the noise where it is not, as in bags of words alone. Which is the case is seen in the remembered
views, by what their neighbours say of features that the weights were not shown.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from cogmap.graph.affine_weights import affine_weights
from cogmap.graph.knn import Metric, Nearest, nearest_points
from cogmap.graph.points import Cloud
from cogmap.threads import one_thread

COUNTS = (5, 10, 15, 30, 60)
"""Neighbours among which a regression chooses."""
ASKED = 200
"""Remembered views that are asked, evenly spread."""
GAIN = 1.5
"""Misfit of the nearest view over that of the regression below which the latter is not believed: 1.0–1.2 for
bags of words, 2.4–80 for image codes, and for codes of panoramas that blur, exposure, noise and tilt vary."""
ALIKE, SHARP = 10, 8
"""Neighbours that are weighed by likeness, and its exponent."""


class Weighing(NamedTuple):
    """How views are weighed."""

    regressed: bool
    """Whether by a regression on codes, or by likeness."""
    neighbours: int

    def weigh(
        self,
        near: Nearest,
        codes: Float[np.ndarray, "views codes"],
        queries: Float[np.ndarray, "queries codes"],
        ridge: float,
    ) -> Float[np.ndarray, "queries neighbours"]:
        """Give the weights of the views near to each query, which sum to one."""
        return (
            affine_weights(codes, near.indices, queries, ridge) if self.regressed else likeness_weights(near)
        )


def choose_weighing(
    features: Cloud, codes: Float[np.ndarray, "views codes"] | None, ridge: float, metric: Metric
) -> Weighing:
    r"""Choose how to weigh neighbours, by how these make up remembered views.

    Each of some views is placed among the others, by half of the codes. With w its weights, x its other half
    and σ² the noise of these,

    .. math:: \frac{|x - \sum_j w_j x_j|^2}{1 + \sum_j w_j^2}

    is σ² on average if the weights put the view where it is, and more by as much as what is seen elsewhere
    differs; for the nearest view alone w = 1. The number of neighbours with the smallest mean is taken, and
    a regression at all only if it explains far more than the nearest view.

    Parameters
    ----------
    features
        Of remembered views, by which the nearest are found.
    codes
        Of the same views; the features themselves when None, of which half then finds the nearest as well.
    ridge, metric
        As for `Localiser`.
    """
    views, columns = features.shape if codes is None else codes.shape
    counts = sorted({min(count, views - 1) for count in COUNTS})
    if views < 3 or columns < 2:
        return Weighing(regressed=True, neighbours=min(views, COUNTS[-1]))
    asked = np.unique(np.linspace(0, views - 1, min(ASKED, views)).astype(int))
    shown, kept = np.array_split(np.random.default_rng(0).permutation(columns), 2)
    found = _among_others(features[:, shown] if codes is None else features, asked, counts[-1], metric)
    some = found[:, 0] >= 0
    asked, found = asked[some], found[some]
    if not len(asked):
        return Weighing(regressed=False, neighbours=min(views, ALIKE))
    half, other = (_dense(features if codes is None else codes, part) for part in (shown, kept))
    with one_thread():
        misfits = [_misfit(other, asked, found[:, :1], np.ones((len(asked), 1)))]
        for count in counts:
            near = found[:, :count]
            misfits.append(_misfit(other, asked, near, affine_weights(half, near, half[asked], ridge)))
    best = int(np.argmin(misfits[1:]))
    if misfits[0] >= GAIN * misfits[1 + best]:
        return Weighing(regressed=True, neighbours=counts[best])
    return Weighing(regressed=False, neighbours=min(views, ALIKE))


def likeness_weights(near: Nearest) -> Float[np.ndarray, "queries neighbours"]:
    r"""Weigh neighbours by how much nearer they are than the last of them.

    .. math:: w_j \propto (d_k^2 - d_j^2)^8

    Noise adds the same to all d², whatever the view, and so changes no weight. All weigh alike where all are
    equally far; 0 where there is no neighbour, NaN where there is none at all.
    """
    there = near.indices >= 0
    squared = np.where(there, np.square(near.distances), 0)
    nearer = np.where(there, squared.max(axis=1, keepdims=True) - squared, 0)
    largest = nearer.max(axis=1, keepdims=True)
    # over the largest first: small numbers to the eighth power are zero
    likeness = np.where(largest > 0, nearer / np.where(largest > 0, largest, 1), there) ** SHARP
    total = likeness.sum(axis=1, keepdims=True)
    return np.where(total > 0, likeness / np.where(total > 0, total, 1), np.nan)


def _among_others(
    features: Cloud, asked: Int[np.ndarray, "asked"], count: int, metric: Metric
) -> Int[np.ndarray, "asked neighbours"]:
    """Find the views nearest to some of them, without these themselves."""
    near = nearest_points(features, count + 1, queries=features[asked], metric=metric).indices
    others = np.argsort(near == asked[:, None], axis=1, kind="stable")[:, :count]
    return np.take_along_axis(near, others, 1)


def _dense(codes: Cloud, columns: Int[np.ndarray, "columns"]) -> Float[np.ndarray, "views columns"]:
    part = codes[:, columns]
    return np.asarray(part if isinstance(part, np.ndarray) else part.toarray(), np.float64)


def _misfit(
    codes: Float[np.ndarray, "views codes"],
    asked: Int[np.ndarray, "asked"],
    near: Int[np.ndarray, "asked neighbours"],
    weights: Float[np.ndarray, "asked neighbours"],
) -> float:
    made = np.stack([w @ codes[views] for w, views in zip(weights, near, strict=True)])
    missed = np.square(codes[asked] - made).sum(axis=1)
    return float((missed / (1 + np.square(weights).sum(axis=1))).mean())
