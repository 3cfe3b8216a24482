"""Ratios, of which nothing over nothing means that nothing is known."""

from __future__ import annotations

import numpy as np
from jaxtyping import Inexact


def ratio(
    numerator: Inexact[np.ndarray, "..."], denominator: Inexact[np.ndarray, "..."]
) -> Inexact[np.ndarray, "..."]:
    """Divide with broadcasting, NaN where the denominator is not positive."""
    shape = np.broadcast_shapes(numerator.shape, denominator.shape)
    dtype = np.result_type(numerator, float)
    unknown = np.full(shape, np.nan, dtype)
    return np.asarray(np.divide(numerator, denominator, out=unknown, where=denominator > 0, dtype=dtype))
