import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arena.angles import signed_turn, wrap_angle

angles = st.floats(-100, 100)


@pytest.mark.parametrize(
    ("angle", "wrapped"),
    [(math.pi, math.pi), (-math.pi, math.pi), (3 * math.pi, math.pi), (0.0, 0.0), (-2 * math.pi, 0.0)],
)
def test_half_a_turn_is_pi_and_whole_turns_are_nothing(angle: float, wrapped: float) -> None:
    assert wrap_angle(angle) == wrapped
    np.testing.assert_array_equal(wrap_angle(np.full((2, 1), angle)), wrapped)


@pytest.mark.parametrize("beyond", [math.nextafter(math.pi, 4), math.nextafter(-math.pi, -4)])
def test_one_rounding_beyond_pi_stays_within_the_range(beyond: float) -> None:
    assert -math.pi < wrap_angle(beyond) <= math.pi
    assert abs(wrap_angle(beyond)) == pytest.approx(math.pi)


@given(angles)
def test_wrapped_angles_agree_with_the_argument_of_the_unit_vector(angle: float) -> None:
    wrapped = wrap_angle(angle)
    assert -math.pi < wrapped <= math.pi
    assert np.exp(1j * wrapped) == pytest.approx(np.exp(1j * angle), abs=1e-13)
    assert wrap_angle(np.array([angle])) == wrapped


def test_float32_stays_and_nan_stays() -> None:
    wrapped = wrap_angle(np.array([np.nan, 4.0], np.float32))
    assert wrapped.dtype == np.float32
    np.testing.assert_allclose(wrapped, [np.nan, 4 - 2 * np.pi], rtol=1e-6)


@given(angles, angles)
def test_a_turn_leads_to_the_goal_the_short_way(heading: float, goal: float) -> None:
    turn = signed_turn(heading, goal)
    assert abs(turn) <= math.pi
    assert math.cos(heading + turn - goal) == pytest.approx(1)


@pytest.mark.parametrize("half", [math.pi, -math.pi])
def test_half_a_turn_goes_the_way_it_is_asked_and_small_ones_are_exact(half: float) -> None:
    assert signed_turn(0.0, half) == half
    assert signed_turn(0.0, 1e-18 * half) == 1e-18 * half
