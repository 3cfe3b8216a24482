"""Decoders of place and heading from activity, which were shown the truth of other views."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Complex, Float
from sklearn.neighbors import KNeighborsRegressor

from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, as_array, as_floats, check_array, checked_array, checked_headings


def decode_positions(
    train_odours: AnyArray,
    train_positions: AnyArray,
    odours: AnyArray,
    *,
    neighbours: int = 4,
) -> Float[np.ndarray, "views 2"]:
    """Position in m by nearest-neighbour regression on log odour, weights 1/distance.

    Parameters
    ----------
    train_odours
        Log concentrations of the training views, (train, odorants).
    train_positions
        Where those views were taken in m, (train, 2).
    odours
        Log concentrations to decode, (views, odorants).
    neighbours
        How many training views a position is averaged over.

    Raises
    ------
    CogmapError
        For values that are not finite, shapes that do not fit, fewer training views than neighbours.
    """
    train_odours = checked_array("train_odours", train_odours, (None, None))
    train_positions = checked_array("train_positions", train_positions, (len(train_odours), 2))
    odours = checked_array("odours", odours, (None, train_odours.shape[1]))
    if len(train_odours) < neighbours:
        raise CogmapError(f"{len(train_odours)} training views; give at least {neighbours}")
    decoder = KNeighborsRegressor(n_neighbors=neighbours, weights="distance", algorithm="kd_tree")
    decoder.fit(train_odours.astype(float), train_positions.astype(float))
    return np.asarray(decoder.predict(odours.astype(float)))


def position_errors(
    train_odours: AnyArray,
    train_positions: AnyArray,
    odours: AnyArray,
    positions: AnyArray,
) -> Float[np.ndarray, "views"]:
    """Distance in m from each position to what `decode_positions` makes of its log odour.

    The same measure serves the odour recalled from sight and the log of what the nose smelt.

    Raises
    ------
    CogmapError
        For values that are not finite, shapes that do not fit, fewer than four training views.
    """
    odours = checked_array("odours", odours, (None, None))
    positions = checked_array("positions", positions, (len(odours), 2))
    missed = decode_positions(train_odours, train_positions, odours) - positions
    return np.asarray(np.linalg.norm(missed, axis=1))


def likeliest(scores: AnyArray, centres: AnyArray) -> Float[np.ndarray, "views *axes"]:
    """Centre of the bin with the highest score in each view, NaN in a view without any score.

    Parameters
    ----------
    scores
        From `poisson_posterior` or `pattern_correlations`, (views, bins).
    centres
        Of the bins: `maps.places` in m, or `heading_centres(bins)` in rad.

    Raises
    ------
    CogmapError
        For centres of other bins.
    """
    scores, centres = as_floats(as_array("scores", scores)), as_floats(as_array("centres", centres))
    if scores.ndim != 2:
        raise CogmapError(f"scores have shape {scores.shape}; give one row per view, (views, bins)")
    check_array("centres", centres, (scores.shape[1], *(None,) * (centres.ndim - 1)))
    known = ~np.isnan(scores)
    decoded: np.ndarray = centres[np.where(known, scores, -np.inf).argmax(axis=1)]
    decoded[~known.any(axis=1)] = np.nan
    return decoded


class HeadingFrame(NamedTuple):
    """How a learnt phase φ lies on the true heading: θ = φ + `rotation`, or `rotation` − φ in a mirror."""

    rotation: float
    """In rad, in (−π, π]."""
    mirror: bool


def fit_heading_frame(phase: AnyArray, headings: AnyArray) -> HeadingFrame:
    """Find the rotation, and whether a mirror, that brings phases closest to headings, both in rad.

    It maximises the resultant R = |mean exp i(θ ∓ φ)|; a tie is no mirror.

    Raises
    ------
    CogmapError
        For values that are not finite or hardly rad, or shapes that do not fit.
    """
    phase = checked_array("phase", phase, (None,))
    headings = checked_headings(headings, len(phase))
    plain, mirrored = (np.mean(np.exp(1j * (headings.astype(float) - sign * phase))) for sign in (1, -1))
    mirror = bool(abs(mirrored) > abs(plain))
    return HeadingFrame(float(np.angle(mirrored if mirror else plain)), mirror)


def heading_errors(phase: AnyArray, headings: AnyArray, frame: HeadingFrame) -> Float[np.ndarray, "views"]:
    """Signed error θ̂ − θ in rad, in (−π, π], of phases read in a frame.

    Raises
    ------
    CogmapError
        For values that are not finite or hardly rad, or shapes that do not fit.
    """
    phase = checked_array("phase", phase, (None,))
    headings = checked_headings(headings, len(phase))
    sign = -1 if frame.mirror else 1
    return wrap_angle(sign * phase.astype(float) + frame.rotation - headings)


class MapFrame(NamedTuple):
    """How a map z = x + iy lies in the room: at `scale` · z + `shift`, with z conjugate in a mirror."""

    scale: complex
    """Metres per unit of the map, turned by its angle."""
    shift: complex
    """In m."""
    mirror: bool


def fit_map_frame(mapped: AnyArray, positions: AnyArray) -> MapFrame:
    """Find the similarity, and whether a mirror, that brings a map closest to positions in m.

    It minimises the squared distance; a tie is no mirror.

    Raises
    ------
    CogmapError
        For values that are not finite or shapes that do not fit.
    """
    mapped = checked_array("mapped", mapped, (None, 2))
    positions = checked_array("positions", positions, (len(mapped), 2))
    found, true = _complex(mapped), _complex(positions)
    plain, mirrored = (np.mean((true - true.mean()) * z.conj()) for z in (found, found.conj()))
    mirror = bool(abs(mirrored) > abs(plain))
    spread = np.mean(np.abs(found - found.mean()) ** 2)
    scale = (mirrored if mirror else plain) / max(spread, np.finfo(float).tiny)
    centre = found.mean().conj() if mirror else found.mean()
    return MapFrame(complex(scale), complex(true.mean() - scale * centre), mirror)


def place_map(mapped: AnyArray, frame: MapFrame) -> Float[np.ndarray, "views 2"]:
    """Lay a map in the room, m.

    Raises
    ------
    CogmapError
        For values that are not finite or shapes that do not fit.
    """
    mapped = checked_array("mapped", mapped, (None, 2))
    found = _complex(mapped)
    laid = frame.scale * (found.conj() if frame.mirror else found) + frame.shift
    return np.stack([laid.real, laid.imag], axis=1)


def _complex(points: Float[np.ndarray, "points 2"]) -> Complex[np.ndarray, "points"]:
    return np.asarray(points.astype(float) @ np.array([1, 1j]))
