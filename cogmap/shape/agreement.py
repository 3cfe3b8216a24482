"""Agreement of Betti numbers: what one sense or cloud counts, but not another, is left unresolved."""

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


def unless_contradicted(found: Betti, other: Betti, name: str) -> Betti:
    """Leave unresolved what another cloud of the same manifold, called `name`, counts otherwise.

    A cloud that bulges between near edges has a false loop that stands out in its every draw and graph; one
    that maps the same poses otherwise does not bulge there.
    """
    told = f"{name} says {list(other.numbers)}"
    reasons = (
        reason or ("" if number == counted else told)
        for number, counted, reason in zip(found.numbers, other.numbers, found.reasons, strict=True)
    )
    return replace(found, reasons=tuple(reasons))


def unless_lower_is_unresolved(found: Betti) -> Betti:
    """Leave unresolved what stands on holes of a lower dimension that are, as voids on loops."""
    reasons: list[str] = []
    for reason in found.reasons:
        lower = next((dimension for dimension, doubt in enumerate(reasons) if doubt), None)
        reasons.append(reason or ("" if lower is None else f"H{lower} is unresolved"))
    return replace(found, reasons=tuple(reasons))
