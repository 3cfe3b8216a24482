"""Noise of a sensor: what is added to painted views."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import UInt8

from arena.errors import ArenaError

Generators = np.random.Generator | Sequence[np.random.Generator]
"""One generator, or one for each view."""


def add_noise(views: UInt8[np.ndarray, "views height width 3"], share: float, rng: Generators | None) -> None:
    """Add independent Gaussian noise, of a standard deviation that is a share of the brightest grey level.

    Raises
    ------
    ArenaError
        For noise without a generator.
    """
    if not share:
        return
    if rng is None:
        raise ArenaError(f"the camera has noise {share:g}; give `rng`, a numpy.random.Generator")
    each = [rng] * len(views) if isinstance(rng, np.random.Generator) else rng
    for image, its in zip(views, each, strict=True):
        grain = its.standard_normal(image.shape, dtype=np.float32)
        image[:] = np.clip(np.rint(image + 255 * share * grain), 0, 255)
