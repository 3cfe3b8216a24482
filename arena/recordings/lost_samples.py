"""Lost samples: where a tracker lost the animal, by what it wrote there or by how fast it would have been."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from arena.errors import ArenaError

FAST = 10.0
"""A jump is this many times as fast as the path usually is; animals run up to about five times as fast."""
FAR = 0.2
"""A jump goes this share of the path's extent."""
BACK = 0.5
"""Where a path goes on after an excursion, in lengths of the jumps: from where it was, not from beyond."""
MOSTLY = 0.5
"""Share of the visits to a place that must be jumps for it to be none."""
SENTINELS = 20
"""Places that are looked for at most."""
FEWEST = 10
"""Samples of a path in which jumps are looked for."""
EDGE = 3
"""Samples on either side of a step that is too fast that are judged one by one, not with their stretch."""
WINDOW = 1000
"""Stretches in which the best one to go on from is looked for."""
MOST_BREAKS = 0.5
"""Share of the steps that may be too fast before the speed is refused, not the steps."""

Times = Float[np.ndarray, " samples"]
Positions = Float[np.ndarray, "samples 2"]
Mask = Bool[np.ndarray, " samples"]


class Sentinel(NamedTuple):
    """A pair of numbers that a tracker seems to write where it has lost the animal."""

    x: float
    y: float
    samples: int


def equal_to(positions: Positions, values: Iterable[float | tuple[float, float]]) -> Mask:
    """Find samples at exactly one of some positions; a number v stands for the position (v, v).

    A sample of which only one coordinate is v is none: animals cross the axes.
    """
    lost = np.zeros(len(positions), dtype=bool)
    for value in values:
        lost |= (positions == np.broadcast_to(value, 2)).all(axis=1)
    return lost


def too_fast(times: Times, positions: Positions, fastest: float) -> Mask:
    """Find the samples that must go so that nobody goes faster than `fastest`, m/s, and the most are left.

    Of two stretches that exclude each other the longer one stays; samples that are not known are left as they
    are. Exact for stretches that are lost in up to a thousand pieces, one after the other.

    Parameters
    ----------
    times, positions
        s, increasing, and m, NaN where lost.
    fastest
        m/s.

    Raises
    ------
    ArenaError
        When half of all steps are faster: it is not the samples that are wrong then.
    """
    known = np.flatnonzero(np.isfinite(positions).all(axis=1))
    t, place = times[known], positions[known]
    step, lapse = np.hypot(*np.diff(place, axis=0).T), np.diff(t)
    # Rounding must not make a steady speed too fast.
    breaks = np.flatnonzero(step > fastest * lapse * (1 + 1e-9))
    lost = np.zeros(len(times), dtype=bool)
    if not len(breaks):
        return lost
    if len(breaks) > MOST_BREAKS * len(step):
        usual = float(np.median(step / lapse))
        raise ArenaError(
            f"fastest is {fastest:g} m/s, and {len(breaks)} of {len(step)} steps are faster; half of all go "
            f"at {usual:.3g} m/s: give a higher one, or say by scale or calibration how long a unit is"
        )
    starts = _stretches(breaks, len(t))
    ends = np.append(starts[1:], len(t))
    kept = np.zeros(len(t), dtype=bool)
    for at in _longest_way(t, place, starts, ends, fastest * (1 + 1e-9)):
        kept[starts[at] : ends[at]] = True
    lost[known[~kept]] = True
    return lost


def jumps(times: Times, positions: Positions) -> Mask:
    """Find samples at which the path jumps off and comes back, in whatever unit it is.

    A stay at one place counts when the ways there and away are `FAST` times as fast as the path usually is,
    as long as `FAR` of its extent, and it goes on from near where it was, or had stayed for several samples.
    A place that is jumped at twice or more, and mostly when it is visited, is lost wherever it occurs. The
    one that is jumped at most goes first: what was between two of its samples has better neighbours then.
    """
    doubtful = np.zeros(len(times), dtype=bool)
    left = np.flatnonzero(np.isfinite(positions).all(axis=1))
    for _ in range(SENTINELS):
        if len(left) < FEWEST:
            break
        stay, off = _excursions(times[left], positions[left])
        # Complex numbers are sorted ten times as fast as rows.
        place = positions[left] @ [1, 1j]
        first = np.unique(stay, return_index=True)[1]
        places, jumped = np.unique(place[first[off[first]]], return_counts=True)
        most = int(np.argmax(jumped)) if len(places) else 0
        if not len(places) or jumped[most] < 2:
            doubtful[left[off]] = True
            break
        there = place == places[most]
        always = jumped[most] >= MOSTLY * there[first].sum()
        lost = there if always else there & off
        doubtful[left[lost]] = True
        left = left[~lost]
    return doubtful


def sentinel(positions: Positions, doubtful: Mask) -> Sentinel | None:
    """Give the place that most of the doubtful samples are at exactly, if it is more than one's."""
    if not doubtful.any():
        return None
    places, counts = np.unique(positions[doubtful], axis=0, return_counts=True)
    most = int(np.argmax(counts))
    if counts[most] < 2:
        return None
    return Sentinel(float(places[most, 0]), float(places[most, 1]), int(counts[most]))


def _excursions(
    times: Float[np.ndarray, " known"], positions: Float[np.ndarray, "known 2"]
) -> tuple[Int[np.ndarray, " known"], Bool[np.ndarray, " known"]]:
    """Give the number of the stay at one place that each sample is in, and whether it is jumped at."""
    moved = (np.diff(positions, axis=0) != 0).any(axis=1)
    stay = np.concatenate([[0], np.cumsum(moved)])
    starts = np.append(0, np.flatnonzero(moved) + 1)
    ends = np.append(starts[1:], len(times)) - 1
    if len(starts) < 3:
        return stay, np.zeros(len(times), dtype=bool)
    places = positions[starts]
    length = np.hypot(*np.diff(places, axis=0).T)
    speed = length / (times[starts[1:]] - times[ends[:-1]])
    extent = np.hypot(*(np.quantile(places, 0.99, axis=0) - np.quantile(places, 0.01, axis=0)))
    leap = (speed > FAST * np.median(speed)) & (length > FAR * extent)
    onward = np.hypot(*(places[2:] - places[:-2]).T) < BACK * np.minimum(length[1:], length[:-1])
    within = leap[1:] & leap[:-1] & (onward | (ends > starts)[1:-1])
    # Of the first and the last stay only one way is known; a jump to the next one is that one's.
    off = np.concatenate([[leap[0] & ~within[0]], within, [leap[-1] & ~within[-1]]])
    return stay, off[stay]


def _stretches(breaks: Int[np.ndarray, " breaks"], samples: int) -> Int[np.ndarray, " stretches"]:
    """Cut at the breaks, and samples near one off by themselves; give where each stretch starts."""
    near = (breaks[:, None] + 1 + np.arange(-EDGE, EDGE + 1)).ravel()
    return np.unique(np.append(0, near[(near > 0) & (near < samples)]))


def _longest_way(
    times: Float[np.ndarray, " known"],
    positions: Float[np.ndarray, "known 2"],
    starts: Int[np.ndarray, " stretches"],
    ends: Int[np.ndarray, " stretches"],
    fastest: float,
) -> list[int]:
    """Give the stretches, in their order, of which each can be reached from the last, of the most samples."""
    first, last = positions[starts], positions[ends - 1]
    begun, left = times[starts], times[ends - 1]
    score = (ends - starts).astype(int)
    before = np.full(len(starts), -1)
    top = score[0]
    for at in range(1, len(starts)):
        top = max(top, score[at - 1])
        near = np.hypot(*(first[at] - last[at - 1])) <= fastest * (begun[at] - left[at - 1])
        if near and score[at - 1] == top:
            before[at] = at - 1
            score[at] += top
            continue
        # Who has been lost for long is looked for further back.
        for high in range(at, 0, -WINDOW):
            low = max(0, high - WINDOW)
            way = np.hypot(*(first[at] - last[low:high]).T)
            reached = np.flatnonzero(way <= fastest * (begun[at] - left[low:high]))
            if len(reached):
                best = low + int(reached[np.argmax(score[low:high][reached])])
                before[at] = best
                score[at] += score[best]
                break
    way_back = [int(np.argmax(score))]
    while before[way_back[-1]] >= 0:
        way_back.append(int(before[way_back[-1]]))
    return way_back[::-1]
