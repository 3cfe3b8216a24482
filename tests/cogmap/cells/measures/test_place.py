from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest

from cogmap.cells.measures.coherence import coherence
from cogmap.cells.measures.information import spatial_information
from cogmap.cells.measures.place import place_statistics
from cogmap.cells.rates.bins import bin_edges
from cogmap.cells.rates.maps import rate_maps
from cogmap.errors import CogmapError

Samples = tuple[np.ndarray, np.ndarray]


@pytest.fixture
def table(wander: Callable, bump: Callable, von_mises: Callable) -> pd.DataFrame:
    positions, headings = wander()
    place = bump(positions)
    rates = {
        "place": place,
        "two fields": bump(positions, (-1.0, 0.5)) + bump(positions, (1.0, -0.5)),
        "directional": place * von_mises(headings),
        "uniform": np.full(len(positions), 5.0),
        "noise": np.random.default_rng(0).poisson(5, len(positions)).astype(float),
        "heading": von_mises(headings),
        "broad": 6 + place,
        "silent": np.zeros(len(positions)),
    }
    table = place_statistics(np.stack(list(rates.values()), axis=1), positions, headings)
    return table.set_axis(list(rates))


def test_only_the_place_cell_passes(table: pd.DataFrame) -> None:
    assert table.index[table["passing"]].tolist() == ["place"]


@pytest.mark.parametrize("criterion", [{"least_information": 20.0}, {"most_direction": 0.0}])
def test_what_makes_a_place_cell_can_be_told(
    wander: Callable, bump: Callable, criterion: dict[str, float]
) -> None:
    positions, headings = wander()
    cells = bump(positions)[:, None]
    assert place_statistics(cells, positions, headings)["passing"].all()
    assert not place_statistics(cells, positions, headings, **criterion)["passing"].any()


def test_fields(table: pd.DataFrame) -> None:
    assert table["fields"].to_dict() == {
        "place": 1, "two fields": 2, "directional": 1, "uniform": 0, "noise": 0, "heading": 0, "broad": 0,
        "silent": 0,
    }  # fmt: skip
    np.testing.assert_allclose(
        table.loc["place", ["centre_x_m", "centre_y_m"]].tolist(), [0.3, -0.2], atol=0.03
    )
    assert table.loc["uniform", "field_area_m2"] == 0
    assert np.isnan(table.loc["uniform", "centre_x_m"])


def test_information(table: pd.DataFrame) -> None:
    assert table.loc["place", "spatial_information"] > 1.5
    assert table.loc[["uniform", "noise"], "spatial_information"].max() < 0.02
    assert table.loc["heading", "spatial_information"] < 0.1
    assert table.loc["broad", "sparsity"] > 0.8
    assert table.loc["place", "selectivity"] > 5


def test_coherence_and_stability(table: pd.DataFrame) -> None:
    assert table.loc["place", ["coherence", "stability"]].min() > 0.95
    assert table.loc[["uniform", "silent"], ["coherence", "stability"]].isna().all(axis=None)
    assert table.loc["noise", ["coherence", "stability"]].abs().max() < 0.2


def test_coherence_is_that_of_the_map_without_smoothing(wander: Callable) -> None:
    positions, headings = wander(1500)
    rates = np.random.default_rng(0).gamma(0.5, 4, (1500, 3))
    raw = rate_maps(rates, positions, smoothing=0.0)
    measured = place_statistics(rates, positions, headings)["coherence"]
    np.testing.assert_allclose(measured, coherence(raw))
    wide = place_statistics(rates, positions, headings, maps=rate_maps(rates, positions, 0.2, 0.3))
    np.testing.assert_allclose(wide["coherence"], coherence(rate_maps(rates, positions, 0.2, 0.0)))


def test_a_population_is_measured_like_its_cells(wander: Callable, bump: Callable) -> None:
    positions, headings = wander(800)
    centres = np.random.default_rng(0).uniform([-1.8, -1.3], [1.8, 1.3], (6, 2))
    rates = np.stack([bump(positions, tuple(centre)) for centre in centres], axis=1)
    table = place_statistics(rates, positions, headings)
    for cell in range(6):
        alone = place_statistics(rates[:, [cell]], positions, headings)
        pd.testing.assert_frame_equal(alone.set_axis([cell]), table.iloc[[cell]], check_names=False)


def test_direction_in_the_field(table: pd.DataFrame) -> None:
    vector = table["in_field_direction_vector"]
    assert vector["place"] < 0.1
    assert vector["directional"] > 0.7
    assert np.isnan(vector["uniform"])


def test_rates(table: pd.DataFrame) -> None:
    assert table.loc["uniform", ["peak_rate_hz", "mean_rate_hz"]].tolist() == pytest.approx([5, 5])
    assert table.loc["silent", ["peak_rate_hz", "mean_rate_hz"]].tolist() == [0, 0]
    assert table.loc["silent", ["spatial_information", "sparsity", "selectivity"]].isna().all()
    assert 7 < table.loc["place", "peak_rate_hz"] < 10


def test_ideal_cells_pass_in_a_hall_seen_by_few_views_and_directional_ones_do_not(hall: Samples) -> None:
    positions, headings = hall
    centres = np.random.default_rng(0).uniform([-4.5, -3], [4.5, 3], (100, 2))
    ideal = 10 * np.exp(-np.sum((positions[:, None] - centres) ** 2, axis=2) / (2 * 0.5**2))
    directional = ideal * np.exp(np.cos(headings[:, None] - np.arange(100)))
    edges = bin_edges(np.array([[-4.5, -3], [4.5, 3]]))
    everywhere = np.ones(edges.shape, dtype=bool)
    passing = [
        place_statistics(rates, *hall, maps=rate_maps(rates, positions, edges=edges, visited=everywhere))[
            "passing"
        ].mean()
        for rates in (ideal, directional)
    ]
    assert passing[0] > 0.97
    assert passing[1] < 0.03


def test_direction_vector_is_that_of_the_cell(wander: Callable, bump: Callable) -> None:
    positions, headings = wander(20_000)
    centres = [(-0.9, 0.4), (0.2, 0.1), (1.2, -0.8)]
    rates = np.stack([bump(positions, centre) * (1 + np.cos(headings - 1) / 2) for centre in centres], axis=1)
    measured = place_statistics(rates, positions, headings)["in_field_direction_vector"]
    np.testing.assert_allclose(measured, 0.25, atol=0.01)


def test_uses_the_maps_it_is_given(wander: Callable, bump: Callable) -> None:
    positions, headings = wander(2000)
    rates = bump(positions)[:, None]
    maps = rate_maps(rates, positions, 0.2, 0.3)
    table = place_statistics(rates, positions, headings, maps=maps)
    assert table["spatial_information"].tolist() == spatial_information(maps).tolist()
    assert table.index.name == "cell"


def test_bad_input_is_refused(wander: Callable, bump: Callable) -> None:
    positions, headings = wander(200)
    rates = bump(positions)[:, None]
    with pytest.raises(CogmapError, match="headings is not finite"):
        place_statistics(rates, positions, headings * np.nan)
    with pytest.raises(CogmapError, match="rates is not finite"):
        place_statistics(rates * np.nan, positions, headings)
    with pytest.raises(CogmapError, match="1 maps for 2 cells"):
        place_statistics(np.repeat(rates, 2, axis=1), positions, headings, maps=rate_maps(rates, positions))
