"""Heights: coordinates of a cloud along which it does not close, beside the phases of its loops."""

import warnings
from itertools import product

import numpy as np
from jaxtyping import Float

from cogmap.errors import SeparatePiecesWarning
from cogmap.shape.isomap import LandmarkIsomap

HARMONICS = 3
"""Waves are sums of so many phases at most: a loop's own shape is made of the first three harmonics."""


def heights(
    codes: Float[np.ndarray, "points features"],
    phases: Float[np.ndarray, "points loops"],
    count: int,
    *,
    one_sided: int | None = None,
    seed: int = 0,
) -> Float[np.ndarray, "points heights"]:
    """Find as many coordinates as there are degrees of freedom beside the loops, each of deviation 1.

    A product of circles and lines has an embedding with two coordinates a circle and one a line. What the
    harmonics of the phases do not explain of it (`LandmarkIsomap`) varies along the lines, and most along its
    principal axes. Points beside the largest piece of the neighbour graph have none: NaN.

    Parameters
    ----------
    codes
        Points.
    phases
        rad, around each loop.
    count
        How many.
    one_sided
        Of the neighbour graph.
    seed
        Draws the landmarks.
    """
    if not count:
        return np.empty((len(codes), 0))
    isomap = LandmarkIsomap(2 * phases.shape[1] + count, one_sided=one_sided, seed=seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SeparatePiecesWarning)  # the others get NaN
        isomap.fit(codes)
    known = isomap.pieces_.labels == 0
    turns = [
        phases[known] @ np.array(times)
        for times in product(range(-HARMONICS, HARMONICS + 1), repeat=phases.shape[1])
        # A wave and its mirror image are one.
        if times > (0,) * len(times) and sum(map(abs, times)) <= HARMONICS
    ]
    waves = np.column_stack(
        [np.ones(known.sum()), *(wave(turn) for turn in turns for wave in (np.cos, np.sin))]
    )
    embedding = isomap.embedding_[known]
    rest = embedding - waves @ np.linalg.lstsq(waves, embedding, rcond=None)[0]
    axes = np.linalg.svd(rest.T @ rest)[0][:, :count]
    # Singular vectors have no sign of their own.
    axes *= np.sign(axes[np.abs(axes).argmax(axis=0), np.arange(count)])
    found = np.full((len(codes), count), np.nan)
    found[known] = rest @ axes / (rest @ axes).std(axis=0)
    return found
