"""Aliasing: what one sense says of a shape, but not two."""

from dataclasses import replace

import numpy as np

from cogmap.shape.homology import Betti


def unless_aliased(alone: Betti, joint: Betti, *, turning: bool = False) -> Betti:
    """Leave unresolved what sight and smell together do not tell too, or are not sure of.

    Parameters
    ----------
    alone
        Of a cloud that one sense has made.
    joint
        Of what both tell.
    turning
        Whether `joint` has a circle of headings as well, by which the other is to be multiplied.
    """
    numbers = np.convolve(alone.numbers, (1, 1))[: len(alone.numbers)] if turning else alone.numbers
    aliased = f"aliased: sight alone says {list(alone.numbers)}, with smell {list(joint.numbers)}"
    reasons = tuple(
        aliased if number != wanted else reason or (other and f"with smell {other}")
        for number, wanted, reason, other in zip(
            numbers, joint.numbers, alone.reasons, joint.reasons, strict=True
        )
    )
    return replace(alone, reasons=reasons)
