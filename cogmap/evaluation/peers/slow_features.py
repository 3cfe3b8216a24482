"""Slow feature analysis, the peer: then independent components, on the order of views."""

from __future__ import annotations

import warnings
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from sklearn.decomposition import FastICA
from sklearn.exceptions import ConvergenceWarning

from cogmap.threads import one_thread


class SlowCells(NamedTuple):
    """What views evoke."""

    features: Float[np.ndarray, "views cells"]
    """Independent components, skewed to the positive; a rotation of the slow features."""
    rates: Float[np.ndarray, "views cells"]
    """Their positive parts, Hz."""


class _Stage(NamedTuple):
    """Slow features of a quadratic expansion."""

    mean: Float[np.ndarray, "expanded"]
    weights: Float[np.ndarray, "expanded features"]

    def __call__(self, x: Float[np.ndarray, "views inputs"]) -> Float[np.ndarray, "views features"]:
        slow = (_expand(x) - self.mean) @ self.weights
        clipped: np.ndarray = np.clip(slow, -7.0, 7.0)  # standard deviations: the next stage squares it again
        return clipped


def slow_cells(
    walk: Float[np.ndarray, "views components"],
    *test: Float[np.ndarray, "_ components"],
    slow: int = 32,
    cells: int = 16,
    peak: float = 20.0,
    seed: int = 0,
) -> list[SlowCells]:
    """Learn slow features of views in the order of a walk, make them sparse, and evoke them by other views.

    Twice: expand to all products of two inputs, whiten, and keep what varies least from view to view. The
    slowest outputs of the second stage are then turned by independent component analysis into cells, whose
    sign makes them fire seldom and strongly.

    Parameters
    ----------
    walk
        Codes of views in the order in which they were seen.
    *test
        Codes that evoke the cells.
    slow
        Features that the first stage hands to the second, which expands 32 to 560.
    cells
        Independent components of the slowest features of the second stage.
    peak
        Highest rate of each cell on the walk, Hz.
    seed
        Of the independent components.

    References
    ----------
    Wiskott & Sejnowski (2002), Slow feature analysis: unsupervised learning of invariances. Neural
    Computation 14.
    Franzius, Sprekeler & Wiskott (2007), Slowness and sparseness lead to place, head-direction, and
    spatial-view cells. PLoS Computational Biology 3.
    """
    with one_thread(), warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)
        scale = walk.std(axis=0)
        first = learn_stage(walk / scale, slow)
        middle = first(walk / scale)
        second = learn_stage(middle, min(cells, middle.shape[1]))
        slowest = second(middle)
        ica = FastICA(whiten="unit-variance", random_state=seed, max_iter=500).fit(slowest)
        train = ica.transform(slowest)
        sign = np.where((train**3).mean(axis=0) < 0, -1.0, 1.0)
        most = np.maximum((sign * train).max(axis=0), np.finfo(float).tiny)
        features = [sign * ica.transform(second(first(codes / scale))) for codes in test]
        return [SlowCells(found, peak * np.maximum(found, 0) / most) for found in features]


def learn_stage(x: Float[np.ndarray, "views inputs"], count: int) -> _Stage:
    """Find the unit-variance quadratic features that change least from one row to the next, slowest first."""
    expanded = _expand(x)
    mean = expanded.mean(axis=0)
    expanded -= mean
    variance, axes = np.linalg.eigh(expanded.T @ expanded / len(expanded))
    kept = variance > 1e-7 * variance[-1]  # whitening a fainter direction amplifies rounding
    white = axes[:, kept] / np.sqrt(variance[kept])
    change = np.diff(expanded, axis=0)
    _, turn = np.linalg.eigh(white.T @ (change.T @ change / len(change)) @ white)
    return _Stage(mean, white @ turn[:, :count])


def _expand(x: Float[np.ndarray, "views inputs"]) -> Float[np.ndarray, "views expanded"]:
    rows, columns = np.triu_indices(x.shape[1])
    return np.concatenate([x, x[:, rows] * x[:, columns]], axis=1)
