from pathlib import Path

import numpy as np
import pytest

from arena.errors import ArenaError
from arena.recordings.track_units import to_radians

RNG = np.random.default_rng(0)
TIMES = np.arange(3000) / 25
TURNING = np.cumsum(RNG.normal(0, 0.15, 3000))
"""Unwrapped, rad."""
WRAPPED = np.angle(np.exp(1j * TURNING))


def radians(headings: np.ndarray, *, degrees: bool = False, times: np.ndarray = TIMES) -> np.ndarray:
    return to_radians(Path("rat.csv"), "hd", headings, times, degrees=degrees)


@pytest.mark.parametrize("headings", [WRAPPED, WRAPPED % (2 * np.pi), TURNING, 0.5 * TIMES, 0 * TIMES])
def test_radians_are_left_and_degrees_turned(headings: np.ndarray) -> None:
    some = headings.copy()
    some[::7] = np.nan
    np.testing.assert_array_equal(radians(some), some)
    np.testing.assert_allclose(radians(np.rad2deg(some), degrees=True), some)


@pytest.mark.parametrize("headings", [WRAPPED, WRAPPED % (2 * np.pi), TURNING])
def test_degrees_called_radians_are_refused(headings: np.ndarray) -> None:
    with pytest.raises(
        ArenaError, match=r"rat\.csv: hd goes from .* which are no radians; pass heading_in='deg'"
    ):
        radians(np.rad2deg(headings))
    assert np.abs(np.diff(np.rad2deg(TURNING[:300]))).max() > np.pi


def test_degrees_that_turn_smoothly_are_refused_as_too_fast() -> None:
    swing = 60 * np.sin(TIMES)
    assert np.abs(np.diff(swing)).max() < np.pi
    with pytest.raises(ArenaError, match="no radians"):
        radians(swing)


@pytest.mark.parametrize("headings", [WRAPPED, WRAPPED % (2 * np.pi)])
def test_radians_called_degrees_are_refused(headings: np.ndarray) -> None:
    with pytest.raises(ArenaError, match="these are radians, not degrees; pass heading_in='rad'"):
        radians(headings, degrees=True)


def test_small_degrees_are_believed() -> None:
    head_fixed = RNG.normal(0, 0.5, 3000)
    np.testing.assert_allclose(radians(head_fixed, degrees=True), np.deg2rad(head_fixed))
    swaying = 3 * np.sin(TIMES)
    np.testing.assert_allclose(radians(swaying, degrees=True), np.deg2rad(swaying))
    few = np.array([3.0, -3.0, 1.0])
    np.testing.assert_allclose(radians(few, degrees=True, times=TIMES[:3]), np.deg2rad(few))


def test_a_number_for_lost_heads_is_asked_for() -> None:
    headings = WRAPPED.copy()
    headings[5] = 999
    with pytest.raises(ArenaError, match="and missing= if some number stands for lost ones"):
        radians(headings)
