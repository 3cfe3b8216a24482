from typing import Any

import numpy as np
import pandas as pd
import pytest

from arena.errors import ArenaError
from arena.recordings.beside import Beside

NONE: dict[str, Any] = dict.fromkeys(("times", "rate", "poses", "signals", "columns")) | {"log": False}


def matched(count: int, video: float | None = None, **fields: Any) -> dict[str, np.ndarray]:
    return Beside.read(**NONE | fields).matched(count, video)[0]


def test_nothing_beside() -> None:
    columns, notes = Beside.read(**NONE).matched(3, None)
    assert list(columns) == ["times"]
    np.testing.assert_array_equal(columns["times"], [0, 1, 2])
    assert notes["times"] == "one a second, as nothing tells"


def test_rates_and_times() -> None:
    np.testing.assert_array_equal(matched(3, rate=2)["times"], [0, 0.5, 1])
    np.testing.assert_array_equal(matched(3, 4.0)["times"], [0, 0.25, 0.5])
    np.testing.assert_array_equal(matched(3, 4.0, rate=np.int64(2))["times"], [0, 0.5, 1])
    np.testing.assert_array_equal(matched(3, 4.0, times=[1, 5, 6])["times"], [1, 5, 6])


def test_signals_are_odours_and_stay_as_they_are() -> None:
    columns = matched(3, signals={"gas": [1.5, 2, 3], "light (lx)": [10, 20, 30]})
    np.testing.assert_array_equal(columns["odours"], np.float32([[1.5, 10], [2, 20], [3, 30]]))
    assert columns["odours"].dtype == np.float32
    np.testing.assert_array_equal(columns["signals/gas"], [1.5, 2, 3])
    np.testing.assert_array_equal(columns["signals/light_lx"], [10, 20, 30])


def test_decibels() -> None:
    columns = matched(3, signals={"00:1f:aa": [-40, -50, -93]}, log=True)
    np.testing.assert_allclose(columns["odours"][:, 0], [1e-4, 1e-5, 10**-9.3], rtol=1e-6)
    np.testing.assert_array_equal(columns["signals/_00_1f_aa"], [-40, -50, -93])


def test_signals_of_another_rate_lie_on_the_line_between_two_rows() -> None:
    columns = matched(5, rate=2, signals={"t": [0, 1, 2], "a": [1, 3, 9]})
    np.testing.assert_array_equal(columns["odours"][:, 0], [1, 2, 3, 6, 9])
    np.testing.assert_array_equal(columns["times"], [0, 0.5, 1, 1.5, 2])


def test_past_its_ends_a_signal_lasts_as_long_as_others_do() -> None:
    signals = {"t": [1, 2, 3], "a": [1, 2, 3]}
    np.testing.assert_array_equal(
        matched(5, times=[0, 1, 2, 3, 4], signals=signals)["odours"][:, 0], [1, 1, 2, 3, 3]
    )
    with pytest.raises(
        ArenaError, match=r"a is known from 1 to 3 s, and 2 of 4 pictures, which go from -0\.5 to 5 s"
    ):
        matched(4, times=[-0.5, 1, 2, 5], signals=signals)


def test_rows_one_to_one_bring_their_times() -> None:
    columns, notes = Beside.read(**NONE | {"signals": {"time": [3, 4, 6], "a": [1, 2, 3]}}).matched(3, None)
    np.testing.assert_array_equal(columns["times"], [3, 4, 6])
    np.testing.assert_array_equal(columns["odours"][:, 0], [1, 2, 3])
    assert notes["times"] == "signals"


def test_missing_values_are_interpolated_over_time_or_refused() -> None:
    lost = [1.0, np.nan, 4.0]
    np.testing.assert_array_equal(matched(3, times=[0, 1, 3], signals={"a": lost})["odours"][:, 0], [1, 2, 4])
    np.testing.assert_array_equal(matched(3, signals={"t": [0, 1, 3], "a": lost})["odours"][:, 0], [1, 2, 4])
    both = {"t": [0, 1, 3], "a": lost, "b": [np.nan, 2, 2]}
    np.testing.assert_array_equal(matched(2, times=[0, 1], signals=both)["odours"], [[1, 2], [2, 2]])
    with pytest.raises(
        ArenaError, match="a is missing in 1 of 3 rows; fill them, or give times to interpolate"
    ):
        matched(3, signals={"a": lost})
    with pytest.raises(ArenaError, match="a is missing in 3 of 3 rows"):
        matched(3, rate=1, signals={"a": [np.nan] * 3})
    with pytest.raises(ArenaError, match="a is infinite in 1 rows"):
        matched(3, rate=1, signals={"a": [1, np.inf, 2]})


def test_another_length_needs_times() -> None:
    for fields in (
        {"signals": {"a": [1, 2]}},
        {"signals": {"t": [0, 1], "a": [1, 2]}},
        {"rate": 1, "signals": {"a": [1, 2]}},
    ):
        with pytest.raises(
            ArenaError, match="signals has 2 rows for 3 pictures; give one a picture, or a column t"
        ):
            matched(3, **fields)
    with pytest.raises(ArenaError, match="there are 2 times for 3 pictures"):
        matched(3, times=[0, 1])


@pytest.mark.parametrize(
    ("values", "log", "words"),
    [
        ([1, -71, 2], False, r"a is -71 at picture 1; concentrations are more than 0: say log \(--log\)"),
        ([1, 0, 2], False, "a is 0 at picture 1; concentrations are more than 0"),
        ([-40, 400, 2], True, "a is 400 at picture 1, and 10.* is no concentration; are these decibels"),
        ([-40, -990, 2], True, "a is -990 at picture 1, and"),
        ([1, 1e300, 2], False, "a is 1e.300 at picture 1"),
    ],
)
def test_values_that_are_no_concentrations(values: list[float], log: bool, words: str) -> None:  # noqa: FBT001
    with pytest.raises(ArenaError, match=words):
        matched(3, signals={"a": values}, log=log)


def test_poses_in_radians_and_degrees() -> None:
    radians = matched(2, poses={"x": [0, 1], "y": [2, 3], "heading": [0.5, 6.0], "trial": ["a", "b"]})[
        "poses"
    ]
    np.testing.assert_allclose(radians, [[0, 2, 0.5], [1, 3, 6 - 2 * np.pi]])
    degrees = matched(2, poses=pd.DataFrame({"x": [0, 1], "y": [2, 3], "heading_deg": [90, 270]}))["poses"]
    np.testing.assert_allclose(degrees, [[0, 2, np.pi / 2], [1, 3, -np.pi / 2]])
    np.testing.assert_array_equal(matched(1, poses=np.array([[1, 2, 3.0]]))["poses"], [[1, 2, 3]])


def test_headings_are_interpolated_the_short_way_round() -> None:
    poses = {"t": [0, 1, 2], "x": [0, 1, 2], "y": [0, 0, 0], "heading_deg": [170, -170, -150]}
    found = matched(4, times=[0, 0.25, 0.75, 1.5], poses=poses)["poses"]
    np.testing.assert_allclose(np.rad2deg(found[:, 2]), [170, 175, -175, -160])
    np.testing.assert_allclose(found[:, 0], [0, 0.25, 0.75, 1.5])


@pytest.mark.parametrize(
    ("poses", "words"),
    [
        (
            {"x": [0], "y": [0], "heading": [359]},
            "heading goes to 359, which is more than a turn; call the column",
        ),
        ({"x": [0], "angle": [0]}, "has no column y and no heading; it must have x, y"),
        ({"x": [0], "y": [0], "heading": [1], "heading_deg": [1]}, "has both heading and heading_deg"),
        ({"x": [np.nan], "y": [0], "heading": [1]}, "x is missing in 1 of 1 rows"),
    ],
)
def test_poses_that_are_none(poses: dict[str, list[float]], words: str) -> None:
    with pytest.raises(ArenaError, match=words):
        matched(1, poses=poses)


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"times": [0], "rate": 1}, "both times and rate are given"),
        ({"rate": 0}, "the rate is 0; give pictures a second"),
        ({"rate": np.nan}, "the rate is nan"),
        ({"log": True}, "log and columns are of signals, and none are given"),
        ({"columns": ["a"]}, "log and columns are of signals"),
        ({"signals": {"t": [0]}}, "no column but times"),
        ({"signals": {"a b": [1], "a-b": [1]}}, "a b and a-b are both a_b as a word; rename one"),
        ({"signals": {"a": [1]}, "columns": ["b"]}, "has no column b; it has a"),
    ],
)
def test_what_does_not_go_together(fields: dict[str, Any], words: str) -> None:
    with pytest.raises(ArenaError, match=words):
        matched(1, **fields)
