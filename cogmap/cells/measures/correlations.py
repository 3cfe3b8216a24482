"""Pearson correlation, row by row."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from cogmap.cells.rates.ratios import ratio


def correlations(
    one: Float[np.ndarray, "rows samples"], other: Float[np.ndarray, "rows samples"]
) -> Float[np.ndarray, "rows"]:
    """Correlate each row of one with the same row of the other, over the samples where neither is NaN.

    r = Σ (a − ā)(b − b̄) / √(Σ (a − ā)² Σ (b − b̄)²), NaN where a row is constant or has nothing known.
    """
    known = ~(np.isnan(one) | np.isnan(other))
    a, b = (standardised(np.where(known, rows, np.nan)) for rows in (one, other))
    return np.asarray(np.sum(a * b, axis=1))


def standardised(rows: Float[np.ndarray, "rows samples"]) -> Float[np.ndarray, "rows samples"]:
    """Shift and scale each row to mean 0 and sum of squares 1; unknown samples become 0, constant rows NaN.

    The dot product of two such rows is their correlation.
    """
    known = ~np.isnan(rows)
    filled = np.where(known, rows, 0.0)
    mean = ratio(filled.sum(axis=1, keepdims=True), known.sum(axis=1, keepdims=True, dtype=float))
    deviation = np.where(known, rows - mean, 0.0)
    length = np.linalg.norm(deviation, axis=1, keepdims=True)
    size = np.linalg.norm(filled, axis=1, keepdims=True)
    # A row that varies by less than this part of its size is constant: the rest is rounding.
    return ratio(deviation, np.where(length > 1e-9 * size, length, 0.0))
