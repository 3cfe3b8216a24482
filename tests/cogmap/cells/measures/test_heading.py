from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import special

from cogmap.cells.measures.heading import heading_statistics
from cogmap.cells.measures.rayleigh import rayleigh_test
from cogmap.cells.rates.maps import rate_maps
from cogmap.errors import CogmapError

Samples = tuple[np.ndarray, np.ndarray]


@pytest.fixture
def table(wander: Callable, bump: Callable, von_mises: Callable) -> pd.DataFrame:
    positions, headings = wander()
    rates = {
        "heading": von_mises(headings, 2.5),
        "broad": von_mises(headings, 2.5, 0.8),
        "drifting": von_mises(headings, 0.6 * positions[:, 0]),
        "placed": von_mises(headings) * bump(positions, (0.0, 0.0), 0.5),
        "uniform": np.full(len(positions), 5.0),
        "silent": np.zeros(len(positions)),
    }
    table = heading_statistics(np.stack(list(rates.values()), axis=1), positions, headings)
    return table.set_axis(list(rates))


def test_only_the_heading_cell_passes(table: pd.DataFrame) -> None:
    assert table.index[table["passing"]].tolist() == ["heading"]


def test_ideal_cells_pass_in_a_hall_seen_by_few_views_and_placed_ones_do_not(
    hall: Samples, von_mises: Callable
) -> None:
    ideal = von_mises(hall[1][:, None], np.linspace(-np.pi, np.pi, 20), 5.0)
    table = heading_statistics(ideal, *hall)
    assert table["passing"].all()
    assert table["spatial_information"].max() < 0.01
    placed = ideal * np.exp(1.5 * np.sin(2 * hall[0][:, :1]))
    assert not heading_statistics(placed, *hall)["passing"].any()


@pytest.mark.parametrize(
    "criterion", [{"least_vector": 1.0}, {"most_drift_deg": 0.0}, {"most_information": 0.0}]
)
def test_what_makes_a_head_direction_cell_can_be_told(
    wander: Callable, von_mises: Callable, criterion: dict[str, float]
) -> None:
    positions, headings = wander()
    cells = von_mises(headings)[:, None]
    assert heading_statistics(cells, positions, headings)["passing"].all()
    assert not heading_statistics(cells, positions, headings, **criterion)["passing"].any()


def test_vector_and_preferred_direction(table: pd.DataFrame) -> None:
    for cell, kappa in (("heading", 4.0), ("broad", 0.8)):
        expected = special.iv(1, kappa) / special.iv(0, kappa)
        assert table.loc[cell, "mean_vector_length"] == pytest.approx(expected, rel=0.01)
        assert table.loc[cell, "preferred_direction_rad"] == pytest.approx(2.5, abs=0.02)
    assert table.loc["uniform", "mean_vector_length"] < 1e-12


def test_drift_is_the_median_turn_over_blocks(table: pd.DataFrame) -> None:
    # Columns of blocks are 1.2 m apart: their preferred directions are −0.72, 0 and 0.72 rad.
    assert table.loc["drifting", "drift_deg"] == pytest.approx(np.rad2deg(0.72), abs=2)
    assert table.loc["drifting", "mean_vector_length"] > 0.5
    assert table.loc["heading", "drift_deg"] < 2


def test_information(table: pd.DataFrame) -> None:
    assert table.loc["heading", "spatial_information"] < 0.1
    assert table.loc["placed", "spatial_information"] > 0.5
    assert table.loc["placed", "drift_deg"] < 15


def test_width_test_and_stability_of_a_von_mises_cell(table: pd.DataFrame) -> None:
    width = np.rad2deg(2 * np.arccos(1 - np.log(2) / 4))
    assert table.loc["heading", "tuning_width_deg"] == pytest.approx(width, abs=1.5)
    assert np.isnan(table.loc["uniform", "tuning_width_deg"])
    assert table.loc["heading", "rayleigh_p"] < 1e-9
    assert table.loc["uniform", "rayleigh_p"] == pytest.approx(1, abs=0.01)
    assert table.loc["heading", "stability"] > 0.99
    assert np.isnan(table.loc["uniform", "stability"])


def test_rayleigh_counts_the_spikes_that_the_rates_make(wander: Callable) -> None:
    positions, headings = wander(3000)
    rates = np.random.default_rng(0).poisson(0.02, (3000, 4)) / 0.1
    table = heading_statistics(rates, positions, headings, seconds=0.1)
    expected = rayleigh_test(np.rint(rates * 0.1), headings).p_value
    np.testing.assert_allclose(table["rayleigh_p"], expected)
    with pytest.raises(CogmapError, match="a view lasts 0"):
        heading_statistics(rates, positions, headings, seconds=0.0)


def test_a_population_is_measured_like_its_cells(wander: Callable) -> None:
    positions, headings = wander(500)
    rates = np.random.default_rng(0).gamma(0.5, 4, (500, 6))
    table = heading_statistics(rates, positions, headings)
    for cell in range(6):
        alone = heading_statistics(rates[:, [cell]], positions, headings)
        pd.testing.assert_frame_equal(alone.set_axis([cell]), table.iloc[[cell]], check_names=False)


def test_silent_cell_is_unknown(table: pd.DataFrame) -> None:
    assert table.loc["silent"].drop("passing").isna().all()


def test_thin_blocks_are_left_out(wander: Callable, von_mises: Callable) -> None:
    positions, headings = wander(6000)
    # Few views on the right, where the cell would be 90° off.
    keep = (positions[:, 0] < 0.6) | (np.arange(6000) < 250)
    positions, headings = positions[keep], headings[keep]
    rates = von_mises(headings, np.pi / 2 * (positions[:, 0] > -0.6))[:, None]
    drift = heading_statistics(rates, positions, headings)["drift_deg"][0]
    left, middle = 2000, 2000 + 250 / 3
    overall = np.rad2deg(np.angle(left + 1j * middle))
    assert drift == pytest.approx(45, abs=abs(overall - 45) + 2)
    few = slice(0, 90)
    assert np.isnan(heading_statistics(rates[few], positions[few], headings[few])["drift_deg"][0])


@settings(max_examples=10, deadline=None)
@given(st.integers(1, 35))
def test_a_turned_world_turns_the_preferred_direction_only(steps: int) -> None:
    rng = np.random.default_rng(0)
    positions = rng.uniform(-1, 1, (2000, 2))
    headings = (rng.integers(0, 36, 2000) + rng.uniform(0.1, 0.9, 2000)) * np.pi / 18 - np.pi
    rates = np.exp(2 * np.cos(headings[:, None] - [0.3, 2.0]) + positions[:, :1])
    turn = steps * np.pi / 18 * 3
    turned = np.angle(np.exp(1j * (headings + turn)))
    before = heading_statistics(rates, positions, headings)
    after = heading_statistics(rates, positions, turned)
    difference = after["preferred_direction_rad"] - before["preferred_direction_rad"] - turn
    np.testing.assert_allclose(np.exp(1j * difference), 1, atol=1e-9)
    column = "preferred_direction_rad"
    pd.testing.assert_frame_equal(after.drop(columns=column), before.drop(columns=column))


def test_bad_input_is_refused(wander: Callable, von_mises: Callable) -> None:
    positions, headings = wander(200)
    rates = von_mises(headings)[:, None]
    with pytest.raises(CogmapError, match="positions is not finite"):
        heading_statistics(rates, positions * np.nan, headings)
    with pytest.raises(CogmapError, match="1 maps for 2 cells"):
        heading_statistics(np.repeat(rates, 2, axis=1), positions, headings, maps=rate_maps(rates, positions))
