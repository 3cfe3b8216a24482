"""Units of tracks: what makes metres and radians of them, and what looks like neither."""

from __future__ import annotations

from numbers import Real

import numpy as np
from jaxtyping import Float

from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.inputs import check_choice

METRES = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "km": 1000.0, "in": 0.0254, "ft": 0.3048}
"""In one of each."""
_WORDS = {
    "met": "m", "centimet": "cm", "millimet": "mm", "decimet": "dm", "kilomet": "km", "inch": "in",
    "foot": "ft", "feet": "ft",
}  # fmt: skip
NARROWEST, WIDEST = 0.05, 20.0
"""m; what 98 % of a track span: less is a still animal, more no box, maze or track of a laboratory."""
DIGITS = 9
"""A nanometre."""
TELLING = (
    "say unit='cm' or 'mm', or metres_per_unit=, the length in m of something seen there over its length in "
    "the track (a box of 0.8 m that is 400 pixels wide: 0.002)"
)


def positive(name: str, value: object, *, or_zero: bool = False) -> float:
    """Return a finite number above 0, or say what is wrong with it.

    Raises
    ------
    CogmapError
        For anything else.
    """
    number = float(value) if isinstance(value, Real) and not isinstance(value, bool) else np.nan
    if not (0 < number < np.inf or (or_zero and number == 0)):
        wanted = "number of 0 or more" if or_zero else "positive number"
        raise CogmapError(f"{name} is {value!r}; give a {wanted}")
    return number


def metres_per(said: str | None, unit: str | None, metres_per_unit: object) -> float:
    """Give the metres in one unit of a track.

    Parameters
    ----------
    said
        The unit as its source calls it; None where it does not.
    unit, metres_per_unit
        What the user says, which goes before; one of them at most.

    Raises
    ------
    CogmapError
        For both, for a unit that is none of length, for a number that cannot be.
    """
    if unit is not None and metres_per_unit is not None:
        raise CogmapError("both unit and metres_per_unit are given; leave one of them out")
    if metres_per_unit is not None:
        return positive("metres_per_unit", metres_per_unit)
    told = unit if unit is not None else said
    if told is None:
        return 1.0
    short = _short(told)
    if short not in METRES:
        whose = "unit is" if unit is not None else "the source says that positions are in"
        raise CogmapError(f"{whose} {told!r}, which is no length; {TELLING}")
    return METRES[short]


def scaled(values: Float[np.ndarray, "samples *axes"], factor: float) -> Float[np.ndarray, "samples *axes"]:
    """Bring values to another unit, so that 70 cm are the 0.7 m that somebody else has written.

    Trackers give whole centimetres or pixels, which lie on the edges of bins; 70 · 0.01 is not 0.7.
    """
    return values if factor == 1 else np.round(values * factor, DIGITS)


def check_metres(positions: Float[np.ndarray, "samples 2"], *, told: bool) -> None:
    """Refuse positions that span what no animal's room does, unless the user says that they are metres.

    Raises
    ------
    CogmapError
        With what they span, and how to tell their unit.
    """
    known = positions[np.isfinite(positions).all(axis=1)]
    if told or not len(known):
        return
    spans = np.ptp(np.percentile(known, [1, 99], axis=0), axis=0)
    if spans.max() > WIDEST:
        raise CogmapError(
            f"positions span {spans[0]:.4g} × {spans[1]:.4g}, which cannot be metres of a laboratory and "
            f"looks like centimetres or pixels; {TELLING}; if they are metres, say unit='m'"
        )
    if 0 < spans.max() < NARROWEST:
        raise CogmapError(
            f"positions span {spans[0]:.2g} × {spans[1]:.2g} m, which no animal walks about in: the unit may "
            f"be taken twice; {TELLING}; if they are metres, say unit='m'"
        )


def in_radians(
    headings: Float[np.ndarray, "samples"], said: str | None, unit: str | None
) -> Float[np.ndarray, "samples"]:
    """Give headings in rad, in (−π, π].

    Parameters
    ----------
    headings
        NaN where lost.
    said
        The unit as its source calls it: what begins with `deg` or `°` is degrees.
    unit
        "rad" or "deg", what the user says, which goes before.

    Raises
    ------
    CogmapError
        For another unit, for radians of more than a turn that nobody has said to be radians.
    """
    if unit is not None:
        check_choice("heading_unit", unit, ("rad", "deg"))
    degrees = unit == "deg" or (unit is None and (said or "").strip().lower().startswith(("deg", "°")))
    if degrees:
        return wrap_angle(np.deg2rad(headings))
    most = float(np.nanmax(np.abs(headings), initial=0.0))
    if unit is None and most > 2 * np.pi + 1e-3:
        raise CogmapError(
            f"headings reach {most:.4g}, more than one turn in radians: they look like degrees; say "
            "heading_unit='deg', or heading_unit='rad' where they count turns"
        )
    return wrap_angle(headings)


def _short(unit: str) -> str:
    word = unit.strip().lower()
    return next((short for start, short in _WORDS.items() if word.startswith(start)), word)
