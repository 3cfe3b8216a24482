"""Objects of neo: spike trains and signals, which carry their units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import Float

from cogmap.cells.sessions.recorded import Series
from cogmap.errors import CogmapError


def is_neo_train(value: object) -> bool:
    """Whether it has what a neo `SpikeTrain` has: times in a unit of their own, of which it is made."""
    return all(hasattr(value, name) for name in ("times", "units", "rescale", "t_start", "t_stop")) and (
        not is_neo_signal(value)
    )


def is_neo_signal(value: object) -> bool:
    """Whether it has what neo's signals have, regularly sampled or not."""
    return all(hasattr(value, name) for name in ("times", "units", "magnitude", "rescale")) and (
        getattr(value, "ndim", 0) == 2
    )


def neo_trains(source: Any) -> list[Any] | None:
    """Give the spike trains of a `Block` of one segment or of a `Segment`; None for what is neither.

    Raises
    ------
    CogmapError
        For a block of several segments.
    """
    segments = getattr(source, "segments", None)
    if segments is not None:
        if len(segments) != 1:
            raise CogmapError(
                f"the block has {len(segments)} segments; give one of them, as block.segments[0]"
            )
        source = segments[0]
    found = getattr(source, "spiketrains", None)
    return None if found is None else list(found)


def name_trains(trains: Sequence[Any]) -> dict[str, Float[np.ndarray, "_"]]:
    """Give spike times (s) by the names of the trains, or their place where names are missing or the same."""
    told = [getattr(train, "name", None) for train in trains]
    distinct = None not in told and "" not in told and len(set(told)) == len(told)
    names = [str(name) for name in told] if distinct else [str(index) for index in range(len(trains))]
    return dict(zip(names, map(neo_spike_times, trains), strict=True))


def neo_spike_times(train: Any) -> Float[np.ndarray, "_"]:
    """Give the spike times of one train in s."""
    return _magnitude(train.times, "s")


def neo_series(signal: Any) -> Series:
    """Give times (s) and values of a signal, in the unit that it has."""
    unit = str(getattr(signal.units, "dimensionality", signal.units))
    return Series(_magnitude(signal.times, "s"), np.asarray(signal.magnitude, dtype=float), unit)


def _magnitude(quantity: Any, unit: str) -> np.ndarray:
    return np.asarray(quantity.rescale(unit).magnitude, dtype=float)
