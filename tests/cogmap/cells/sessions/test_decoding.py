from dataclasses import replace

import numpy as np
import pytest

from cogmap.cells import Session, decode_session, session
from cogmap.errors import CogmapError


@pytest.fixture(scope="module")
def found(rat) -> Session:
    return session(rat.trains, track=rat.track)


def test_cells_tell_place_and_heading(found: Session) -> None:
    figures = decode_session(found, bin=0.05, smoothing=0.05).figures
    assert figures["position_median_m"] < 0.1
    assert figures["chance_position_median_m"] > 0.3
    assert figures["heading_median_deg"] < 12
    assert figures["chance_heading_median_deg"] > 60
    assert figures["heading_resultant"] > 0.9
    assert figures["position_p95_m"] > figures["position_median_m"]


def test_windows_are_means_of_their_samples(rat, found: Session) -> None:
    decoded = decode_session(found, window=0.2)
    np.testing.assert_allclose(decoded.times, rat.times[::4])
    np.testing.assert_allclose(decoded.positions, rat.positions.reshape(-1, 4, 2).mean(axis=1))
    faced = np.angle(np.exp(1j * rat.headings).reshape(-1, 4).mean(axis=1))
    np.testing.assert_allclose(decoded.headings, faced)


def test_no_window_spans_a_gap(rat) -> None:
    kept = np.r_[0:3001, 4000:12_000]
    part = session(rat.trains, track=(rat.times[kept], rat.positions[kept], rat.headings[kept]))
    decoded = decode_session(part)
    assert len(decoded.times) == 300 + 800
    np.testing.assert_allclose(decoded.times, np.r_[rat.times[0:3000:10], rat.times[4000::10]])


def test_nothing_is_told_of_the_part_that_is_decoded(rat, found: Session) -> None:
    """A cell that fires in one block of half a minute alone teaches nothing about it."""
    rates = np.zeros((len(found), 1))
    rates[1200:1800] = 10.0 * (rat.positions[1200:1800, :1] > 0.5)  # the third block
    told = replace(found, rates=rates, counts=None, names=("a",), populations=("cells",))
    decoded = decode_session(told)
    inside = (decoded.times >= 33 + 30) & (decoded.times < 33 + 60)
    assert len(np.unique(decoded.decoded_positions[inside], axis=0)) == 1


def test_rates_stand_for_the_spikes_that_are_expected(found: Session) -> None:
    plain, rates = decode_session(found), decode_session(replace(found, counts=None))
    np.testing.assert_array_equal(plain.decoded_positions, rates.decoded_positions)


def test_without_headings_only_places_are_decoded(found: Session) -> None:
    decoded = decode_session(replace(found, headings=None))
    assert decoded.headings is None
    assert set(decoded.figures) == {"position_median_m", "position_p95_m", "chance_position_median_m"}


def test_what_is_too_short_is_not_decoded(rat) -> None:
    assert decode_session(session(rat.trains, track=rat.track, between=(3.0, 6.0))) is None
    short = decode_session(session(rat.trains, track=rat.track, between=(3.0, 43.0)))
    assert len(short.times) == 80
    with pytest.raises(CogmapError, match="window is 0"):
        decode_session(session(rat.trains, track=rat.track), window=0.0)
