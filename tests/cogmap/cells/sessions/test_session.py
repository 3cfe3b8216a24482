import numpy as np
import pandas as pd
import pynapple
import pytest

from cogmap.cells import MeasuredSession, session
from cogmap.errors import CogmapError

pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning:(pynapple|xarray).*")


def test_counts_and_rates_are_those_of_pynapple(rat) -> None:
    found = session(rat.trains, track=rat.track)
    group = pynapple.TsGroup({index: pynapple.Ts(train) for index, train in enumerate(rat.trains)})
    whole = pynapple.IntervalSet(rat.times[0], rat.times[-1] + 0.05)
    np.testing.assert_array_equal(found.counts, rat.counts)
    np.testing.assert_array_equal(found.counts, group.count(bin_size=0.05, ep=whole).values)
    np.testing.assert_allclose(found.rates, rat.counts / 0.05, rtol=1e-9)
    np.testing.assert_array_equal(found.positions, rat.positions)
    np.testing.assert_allclose(found.headings, rat.headings, atol=1e-12)
    assert found.seconds == pytest.approx(0.05)
    assert found.notes["spikes"] == rat.counts.sum()
    assert (found.notes["spikes_outside"], found.notes["spikes_left_out"]) == (0, 0)


def test_tuning_is_that_of_pynapple(rat) -> None:
    found = MeasuredSession(session(rat.trains, track=rat.track))
    group = pynapple.TsGroup({index: pynapple.Ts(train) for index, train in enumerate(rat.trains)})
    # It gives a spike the heading of the nearest sample: that in the middle of ours.
    turn = pynapple.Tsd(rat.times + 0.025, rat.headings, time_support=pynapple.IntervalSet(3, 603))
    curves = pynapple.compute_tuning_curves(group, turn, bins=36, range=(-np.pi, np.pi)).to_numpy()
    np.testing.assert_allclose(found.curves, curves, rtol=1e-6)


@pytest.mark.parametrize(
    ("per_metre", "told"),
    [(100.0, {"unit": "cm"}), (400.0, {"metres_per_unit": 0.0025}), (1000.0, {"unit": "mm"})],
)
def test_units_give_the_table_of_metres(rat, per_metre: float, told: dict[str, object]) -> None:
    """Whole millimetres, ten of which lie on the edges of bins."""
    places = np.round(rat.positions, 3)
    track = (rat.times, np.round(places * per_metre, 6), rat.headings)
    plain = MeasuredSession(session(rat.trains, track=(rat.times, places, rat.headings)), shuffles=5)
    with pytest.raises(
        CogmapError, match=r"positions span [39]\d+.* × [39]\d+.* metres_per_unit=.* unit='m'"
    ):
        session(rat.trains, track=track)
    found = MeasuredSession(session(rat.trains, track=track, **told), shuffles=5)
    pd.testing.assert_frame_equal(found.table, plain.table, rtol=0, atol=1e-6)
    assert found.session.notes["metres_per_unit"] == pytest.approx(1 / per_metre)


def test_what_is_said_to_be_metres_is_taken_so(rat) -> None:
    wide = (rat.times, 100 * rat.positions)
    assert np.ptp(session(rat.trains, track=wide, unit="m").positions) > 90


def test_slow_samples_are_left_out(rat) -> None:
    """The animal stands still from 100 to 200 s, while a cell replays."""
    places = rat.positions.copy()
    still = (rat.times >= 100) & (rat.times < 200)
    places[still] = places[still][0]
    found = session(rat.trains, track=(rat.times, places), slowest=0.02)
    quiet = (rat.times >= 101) & (rat.times < 199)
    assert not np.isin(rat.times[quiet], found.times).any()
    assert np.isin(rat.times[(rat.times < 99) | (rat.times >= 201)], found.times).mean() > 0.99
    assert found.notes["slow"] == len(rat.times) - len(found)
    assert found.notes["spikes"] + found.notes["spikes_left_out"] == rat.counts.sum()
    assert found.notes["spikes_left_out"] >= rat.counts[quiet].sum()
    assert len(session(rat.trains, track=(rat.times, places))) == len(rat.times)


def test_lost_samples_and_gaps_are_left_out_and_their_spikes_counted(rat) -> None:
    places, headings = rat.positions.copy(), rat.headings.copy()
    places[100:150], headings[150:160] = np.nan, np.nan
    kept = np.r_[0:1000, 3000:12_000]  # the rows of 100 s are missing
    found = session(rat.trains, track=(rat.times[kept], places[kept], headings[kept]))
    there = kept[(kept < 100) | (kept >= 160)]
    np.testing.assert_array_equal(found.times, rat.times[there])
    # The sample before the gap lasts twice as long as usual, and no longer.
    expected = rat.counts[there].astype(float)
    expected[np.flatnonzero(there == 999)] += rat.counts[1000]
    np.testing.assert_array_equal(found.counts, expected)
    lasting = np.where(there == 999, 0.1, 0.05)
    np.testing.assert_allclose(found.rates, expected / lasting[:, None], rtol=1e-9)
    assert (found.notes["lost"], found.notes["without_heading"]) == (50, 10)
    assert found.notes["spikes_outside"] == rat.counts[1001:3000].sum()
    assert found.notes["spikes_left_out"] == rat.counts[100:160].sum()


def test_a_part_of_a_session(rat) -> None:
    found = session(rat.trains, track=rat.track, between=(103, 203))
    there = (rat.times >= 103) & (rat.times <= 203)
    np.testing.assert_array_equal(found.counts, rat.counts[there])
    assert found.notes["not_between"] == (~there).sum()


def test_spikes_before_and_after_the_track_are_outside(rat) -> None:
    train = np.array([2.9, 3.0, 602.99, 603.1])
    found = session([train], track=rat.track)
    assert found.notes["spikes_outside"] == 2
    assert found.counts.sum() == 2


def test_headings_in_degrees_are_refused_until_they_are_told(rat) -> None:
    track = (rat.times, rat.positions, np.rad2deg(rat.headings))
    with pytest.raises(CogmapError, match=r"headings reach 1[78].* heading_unit='deg'"):
        session(rat.trains, track=track)
    found = session(rat.trains, track=track, heading_unit="deg")
    np.testing.assert_allclose(found.headings, rat.headings, atol=1e-9)


def test_one_population_of_several(rat) -> None:
    group = pynapple.TsGroup(
        {index: pynapple.Ts(train) for index, train in enumerate(rat.trains)},
        metadata={"cell_type": ["place"] * 16 + ["heading"] * 6},
    )
    found = session(group, track=rat.track)
    assert found.populations == ("place",) * 16 + ("heading",) * 6
    part = found.population("heading")
    assert part.names == tuple(map(str, range(16, 22)))
    np.testing.assert_array_equal(part.rates, found.rates[:, 16:])
    with pytest.raises(CogmapError, match="no population 'grid'; choose one of place, heading"):
        found.population("grid")


@pytest.mark.parametrize(
    ("told", "said"),
    [
        ({"unit": "cm", "metres_per_unit": 0.01}, "both unit and metres_per_unit"),
        ({"unit": "pixels"}, "'pixels', which is no length"),
        ({"metres_per_unit": 0}, "metres_per_unit is 0"),
        ({"metres_per_unit": 400}, "positions span 3"),
        ({"unit": "mm"}, "the unit may be taken twice"),
        ({"slowest": -1}, "slowest is -1"),
        ({"slowest": "fast"}, "slowest is 'fast'"),
        ({"slowest": 9.0}, "0 of 12000 samples are left .* slow"),
        ({"between": (9, 3)}, "between is"),
        ({"between": (900, 930)}, "0 of 12000 samples are left .12000 not_between"),
        ({"position": "led"}, "position chooses a series of an NWB file"),
        ({"slowset": 0.1}, "the option slowset is for a track's file"),
        ({"heading_unit": "turns"}, "unknown heading_unit 'turns'"),
        ({"activity": "calcium"}, "unknown activity 'calcium'"),
    ],
)
def test_what_cannot_be_is_told(rat, told: dict[str, object], said: str) -> None:
    with pytest.raises(CogmapError, match=said):
        session(rat.trains, track=rat.track, **told)


@pytest.mark.parametrize(
    ("source", "track", "said"),
    [
        ([], "rat", "no cells"),
        ([[0.1, np.nan]], "rat", "cell 0 have shape"),
        (3.0, "rat", "cannot be made of float"),
        ([[0.1]], None, "no track"),
        ([[0.1]], 7, "a track cannot be made of int"),
        ([[0.1]], ([0, 1, 2], np.zeros((2, 2))), r"positions of the track have shape \(2, 2\) for 3 times"),
        ([[0.1]], ([0, 1, 1], np.zeros((3, 2))), "do not increase at sample 2, where 1 s follows 1 s"),
        ([[0.1]], ([0, np.nan, 1], np.zeros((3, 2))), "do not increase"),
        ([[0.1]], ([0], np.zeros((1, 2))), "two samples or more"),
        ([[0.1]], ([0, 1], np.zeros((2, 2)), [0.0]), "headings of the track have shape"),
        ([[0.1]], pd.DataFrame({"t": [0, 1], "x": [0, 1]}), "no column y"),
        (pd.DataFrame({"unit": [0], "t": [1]}), "rat", "has columns unit, t; it must have cell and t"),
    ],
)
def test_what_is_no_session_is_told(rat, source: object, track: object, said: str) -> None:
    with pytest.raises(CogmapError, match=said):
        session(source, track=rat.track if isinstance(track, str) else track)
