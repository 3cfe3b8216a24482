"""Decoding of a session: where its cells say that the animal was and faced, learnt from other parts of it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from arena.angles import wrap_angle
from cogmap.cells.decoding.bayes import joint_posterior, poisson_posterior
from cogmap.cells.decoding.decoders import likeliest
from cogmap.cells.measures.place_by_direction import PlaceByDirection, place_by_direction
from cogmap.cells.rates.bins import bin_edges, heading_centres
from cogmap.cells.rates.maps import RateMaps, rate_maps
from cogmap.cells.sessions.session import Session
from cogmap.cells.sessions.units import positive

FOLDS = 5
DIRECTIONS = 36
BLOCK = 30.0
"""s that stay together: neighbouring samples are too alike to be told from each other."""


class Decoded(NamedTuple):
    """What was decoded, and what is true: means over windows."""

    times: Float[np.ndarray, "windows"]
    """s, of the first sample in each window."""
    positions: Float[np.ndarray, "windows 2"]
    decoded_positions: Float[np.ndarray, "windows 2"]
    headings: Float[np.ndarray, "windows"] | None
    """rad; None where nobody knows them."""
    decoded_headings: Float[np.ndarray, "windows"] | None

    @property
    def shuffled_positions(self) -> Float[np.ndarray, "windows 2"]:
        """What was decoded half a session away, by which chance is judged, m."""
        return _shuffled(self.decoded_positions)

    @property
    def figures(self) -> dict[str, float]:
        """Errors, and by how much a decoder that knows nothing of now would be wrong: medians and 95 %."""
        away = np.linalg.norm(self.decoded_positions - self.positions, axis=1)
        chance = np.linalg.norm(self.shuffled_positions - self.positions, axis=1)
        figures = {
            "position_median_m": float(np.median(away)),
            "position_p95_m": float(np.percentile(away, 95)),
            "chance_position_median_m": float(np.median(chance)),
        }
        if self.headings is None or self.decoded_headings is None:
            return figures
        turn = wrap_angle(self.decoded_headings - self.headings)
        lost = wrap_angle(_shuffled(self.decoded_headings) - self.headings)
        return figures | {
            "heading_median_deg": float(np.rad2deg(np.median(np.abs(turn)))),
            "heading_p95_deg": float(np.rad2deg(np.percentile(np.abs(turn), 95))),
            "heading_resultant": float(abs(np.mean(np.exp(1j * turn)))),
            "chance_heading_median_deg": float(np.rad2deg(np.median(np.abs(lost)))),
        }


def decode_session(
    session: Session,
    *,
    window: float = 0.5,
    bin: float = 0.1,  # noqa: A002
    smoothing: float = 0.15,
) -> Decoded | None:
    """Decode position and heading from the spikes of all cells, by Bayes' rule for independent Poisson cells.

    Where headings are known, place and direction are decoded together, each cell's rate being a map times a
    curve.

    The session is cut into blocks of 30 s (a tenth of it where it is short), dealt out to five folds in turn;
    each fold is decoded from what the other four tell of the cells. Where only rates are known, they stand
    for the spikes that are expected. A place is as likely as another before a cell is heard.

    Parameters
    ----------
    session
        With the cells to listen to.
    window
        s over which spikes are added up; as many samples as are nearest, without a gap between them.
    bin, smoothing
        Of the rate maps, m.

    Returns
    -------
    Decoded
        None for a session too short to have windows in every fold.

    References
    ----------
    Zhang, Ginzburg, McNaughton & Sejnowski 1998, J. Neurophysiol. 79.
    """
    window, bin, smoothing = (  # noqa: A001
        positive(name, value) for name, value in (("window", window), ("bin", bin), ("smoothing", smoothing))
    )
    size = max(1, round(window / session.seconds))
    windows = _windows(session, size)
    if len(windows) < 2 * FOLDS:
        return None
    span = session.times[-1] - session.times[0]
    block = min(BLOCK, span / (2 * FOLDS))
    starts = session.times[windows[:, 0]]
    fold = np.minimum((starts - session.times[0]) // block, span // block).astype(int) % FOLDS
    if len(np.unique(fold)) < FOLDS:
        return None
    edges = bin_edges(session.positions, bin)
    seconds = size * session.seconds
    heard = session.rates[windows].mean(axis=1) * seconds
    places, turns = np.empty((len(windows), 2)), np.empty(len(windows))
    for index in range(FOLDS):
        test, train = fold == index, windows[fold != index].ravel()
        maps = rate_maps(session.rates[train], session.positions[train], bin, smoothing, edges=edges)
        if session.headings is None:
            posterior = poisson_posterior(heard[test], maps.patterns, seconds=seconds)
        else:
            apart = _apart(session, train, maps, smoothing)
            seen = ~np.isnan(apart.gains).any(axis=0)
            posterior, of_heading = joint_posterior(
                heard[test], apart.rates, apart.gains[:, seen], seconds=seconds
            )
            turns[test] = likeliest(of_heading, heading_centres(len(seen))[seen])
        places[test] = likeliest(posterior, maps.places)
    truly = session.positions[windows].mean(axis=1)
    if session.headings is None:
        return Decoded(starts, truly, places, None, None)
    faced = np.angle(np.exp(1j * session.headings[windows]).mean(axis=1))
    return Decoded(starts, truly, places, faced, turns)


def _apart(
    session: Session, train: Int[np.ndarray, "train"], maps: RateMaps, smoothing: float
) -> PlaceByDirection:
    """Part what each cell tells of place from what it tells of direction; a silent one tells nothing."""
    rates, everywhere = session.rates[train], np.broadcast_to(maps.visited, maps.rates.shape)
    apart = place_by_direction(
        rates,
        session.positions[train],
        np.asarray(session.headings)[train],
        maps,
        everywhere,
        bins=DIRECTIONS,
        smoothing=smoothing,
    )
    silent = ~rates.any(axis=0)[:, None]
    return apart._replace(gains=np.where(silent, 1.0, apart.gains))


def _windows(session: Session, size: int) -> Int[np.ndarray, "windows size"]:
    """Give the samples of each window: so many, one after the other."""
    gaps = np.diff(session.times) > 2.5 * session.seconds
    run = np.concatenate([[0], np.cumsum(gaps)])
    first = np.searchsorted(run, run)
    place = np.arange(len(run)) - first
    length = np.bincount(run)[run]
    starts = np.flatnonzero((place % size == 0) & (place + size <= length))
    return np.asarray(starts[:, None] + np.arange(size))


def _shuffled(decoded: Float[np.ndarray, "windows *axes"]) -> Float[np.ndarray, "windows *axes"]:
    return np.roll(decoded, len(decoded) // 2, axis=0)
