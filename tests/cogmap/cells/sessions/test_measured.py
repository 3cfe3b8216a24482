from dataclasses import replace

import numpy as np
import pytest

from cogmap.cells import (
    MeasuredSession,
    heading_statistics,
    place_fields,
    place_statistics,
    rate_maps,
    session,
)


@pytest.fixture(scope="module")
def found(rat) -> MeasuredSession:
    return MeasuredSession(session(rat.trains, track=rat.track), shuffles=199)


def test_the_table_has_the_statistics_of_the_rates(rat, found: MeasuredSession) -> None:
    rates = rat.counts / 0.05
    place = place_statistics(rates, rat.positions, rat.headings)
    heading = heading_statistics(rates, rat.positions, rat.headings, seconds=0.05)
    table = found.table
    for name in place.columns.drop("passing"):
        np.testing.assert_allclose(table[name].astype(float), place[name].astype(float), atol=1e-6)
    for name in ("preferred_direction_rad", "mean_vector_length", "drift_deg", "rayleigh_p"):
        np.testing.assert_allclose(table[name], heading[name], atol=1e-6)
    np.testing.assert_allclose(
        table["spatial_information_beyond_heading"], heading["spatial_information"], atol=1e-6
    )
    np.testing.assert_array_equal(table["place_passing"], place["passing"])
    np.testing.assert_array_equal(table["heading_passing"], heading["passing"])


def test_cells_are_what_they_were_made(found: MeasuredSession) -> None:
    table, place = found.table, np.arange(22) < 16
    assert list(table["cell"]) == [str(index) for index in range(22)]
    assert set(table["population"]) == {"cells"}
    np.testing.assert_array_equal(table["place_passing"], place)
    np.testing.assert_array_equal(table["heading_passing"], ~place)
    assert (table["spatial_information_p"][place] == 1 / 200).all()
    assert (table["mean_vector_length_p"][~place] == 1 / 200).all()
    assert (table["spatial_information_p"][~place] > 0.05).mean() > 0.6
    assert (table["mean_vector_length_p"][place] > 0.05).mean() > 0.7
    centres = np.stack(np.meshgrid([0.2, 0.4, 0.6, 0.8], [0.2, 0.4, 0.6, 0.8]), axis=-1).reshape(-1, 2)
    np.testing.assert_allclose(table[["centre_x_m", "centre_y_m"]][:16], centres, atol=0.06)
    turned = np.angle(np.exp(1j * (table["preferred_direction_rad"][16:] - np.arange(6))))
    assert np.abs(turned).max() < 0.1


def test_without_headings_the_table_has_the_same_columns(found: MeasuredSession) -> None:
    blind = MeasuredSession(replace(found.session, headings=None), shuffles=5)
    assert list(blind.table) == list(found.table)
    unknown = ["mean_vector_length", "mean_vector_length_p", "rayleigh_p", "drift_deg"]
    assert blind.table[unknown].isna().to_numpy().all()
    assert not blind.table["heading_passing"].any()
    assert blind.table["in_field_direction_vector"].isna().all()
    np.testing.assert_array_equal(blind.table["place_passing"], np.arange(22) < 16)
    assert blind.curves is None
    assert blind.heading is None


def test_finer_bins_have_fields_of_as_many_bins(rat, found: MeasuredSession) -> None:
    fine = replace(found, bin=0.04, smoothing=0.05, shuffles=1)
    maps = rate_maps(fine.session.rates, rat.positions, 0.04, 0.05)
    np.testing.assert_array_equal(fine.maps.rates, maps.rates)
    np.testing.assert_array_equal(fine.fields.area, place_fields(maps, least_area=5 * 0.04**2).area)
    halves = np.array_split(np.arange(len(rat.times)), 2)
    first, second = (
        rate_maps(fine.session.rates[half], rat.positions[half], 0.04, 0.05, edges=maps.edges)[0]
        for half in halves
    )
    both = ~np.isnan(first + second)
    expected = np.corrcoef(first[both], second[both])[0, 1]
    assert fine.place["stability"][0] == pytest.approx(expected)


def test_the_seed_draws_the_shuffles(found: MeasuredSession) -> None:
    few = [replace(found, shuffles=20, seed=seed).table["spatial_information_p"] for seed in (1, 1, 2)]
    np.testing.assert_array_equal(few[0], few[1])
    assert not np.array_equal(few[0], few[2])


def test_a_short_session_has_its_shuffles_too(rat) -> None:
    short = session(rat.trains, track=rat.track, between=(3.0, 23.0))
    chances = MeasuredSession(short, shuffles=9).table["spatial_information_p"]
    silent = ~short.counts.any(axis=0)
    assert silent.any()
    np.testing.assert_array_equal(chances.isna(), silent)
    assert chances[~silent].between(0.1, 1).all()
