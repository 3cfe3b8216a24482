"""Samples of a track: how long each lasts, how fast the animal was, which spikes fell into it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Complex, Float, Int
from scipy import sparse

from cogmap.cells.sessions.recorded import Series

AROUND = 0.25
"""s before and after a sample between which speed is taken: a tracker's jitter is no speed."""


def sample_durations(times: Float[np.ndarray, "samples"]) -> Float[np.ndarray, "samples"]:
    """Tell how long each sample lasts, s: until the next, or twice the median of that where this is shorter.

    In the gaps of a track nobody looks. The times increase, and there are two or more.
    """
    steps = np.diff(times)
    usual = float(np.median(steps))
    return np.asarray(np.minimum(np.append(steps, usual), 2 * usual))


def speeds(
    times: Float[np.ndarray, "samples"], positions: Float[np.ndarray, "samples 2"]
) -> Float[np.ndarray, "samples"]:
    """Speed in the unit of the positions per s, from the places a quarter of a second before and after.

    Lost samples (NaN) are bridged by straight lines; at the ends of a track the one place is that of its end.
    """
    known = np.isfinite(positions).all(axis=1)
    if not known.any():
        return np.full(len(times), np.nan)
    ends = [np.clip(times + by, times[known][0], times[known][-1]) for by in (-AROUND, AROUND)]
    before, after = (
        np.stack([np.interp(end, times[known], along[known]) for along in positions.T]) for end in ends
    )
    lapse = ends[1] - ends[0]
    gone = np.hypot(*(after - before))
    return np.asarray(np.divide(gone, lapse, out=np.zeros_like(gone), where=lapse > 0))


def count_spikes(
    trains: Sequence[Float[np.ndarray, "_"]],
    times: Float[np.ndarray, "samples"],
    lasting: Float[np.ndarray, "samples"],
) -> tuple[Int[np.ndarray, "samples cells"], int]:
    """Count the spikes of each cell in each sample, and all those in none: before, after, or in gaps."""
    counts, outside = [], 0
    for train in trains:
        at = np.searchsorted(times, train, side="right") - 1
        inside = (at >= 0) & (train - times[at] <= lasting[at])
        outside += int(np.count_nonzero(~inside))
        counts.append(sparse.csc_array(np.bincount(at[inside], minlength=len(times))[:, None]))
    return sparse.hstack(counts).toarray().astype(np.int64), outside


def headings_at(series: Series, times: Float[np.ndarray, "samples"]) -> Float[np.ndarray, "samples"]:
    """Give headings in rad at other times, along the shorter arc between neighbours.

    NaN before the first, after the last, in a gap of more than twice the usual interval, and beside a heading
    that is lost.
    """
    if np.array_equal(series.times, times):
        return np.asarray(series.data)
    directions = _between(series.times, np.exp(1j * series.data), times)
    after = np.clip(np.searchsorted(series.times, times), 1, len(series.times) - 1)
    gap = np.diff(series.times)[after - 1] > 2 * np.median(np.diff(series.times))
    beyond = (times < series.times[0]) | (times > series.times[-1])
    on_one = np.isin(times, series.times)
    return np.where(beyond | (gap & ~on_one), np.nan, np.angle(directions))


def within(
    times: Float[np.ndarray, "samples"], epochs: Float[np.ndarray, "epochs 2"]
) -> Bool[np.ndarray, "samples"]:
    """Say which times lie in one of some epochs."""
    return np.asarray(((epochs[:, :1] <= times) & (times <= epochs[:, 1:])).any(axis=0))


def _between(
    known: Float[np.ndarray, "samples"],
    values: Complex[np.ndarray, "samples"],
    times: Float[np.ndarray, "moments"],
) -> Complex[np.ndarray, "moments"]:
    return np.asarray(np.interp(times, known, values.real) + 1j * np.interp(times, known, values.imag))
