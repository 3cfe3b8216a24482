from collections.abc import Callable

import numpy as np
import pytest
from neurospatial import Environment
from neurospatial.encoding.spatial import detect_place_fields
from scipy import ndimage

from cogmap.cells.measures.fields import place_coverage, place_fields
from cogmap.cells.rates.bins import BinEdges
from cogmap.cells.rates.maps import RateMaps, rate_maps
from cogmap.errors import CogmapError


def drawn(*pictures: str) -> RateMaps:
    """Maps of 0.1 m bins from pictures: digits are Hz, a space was never visited, the first line is row 0."""
    rates = np.array(
        [[[np.nan if c == " " else float(c) for c in line] for line in p.split("|")] for p in pictures]
    )
    edges = BinEdges(np.arange(rates.shape[2] + 1) * 0.1, np.arange(rates.shape[1] + 1) * 0.1)
    return RateMaps(rates, (~np.isnan(rates[0])).astype(float), edges)


def test_area_and_centre_of_a_gaussian_cell(wander: Callable, bump: Callable) -> None:
    positions, _ = wander(20_000)
    fields = place_fields(rate_maps(bump(positions, (0.3, -0.2), 0.3)[:, None], positions))
    assert fields.number.tolist() == [1]
    variance = 0.3**2 + 0.15**2 + 0.1**2 / 12
    np.testing.assert_allclose(fields.area, -2 * np.pi * variance * np.log(0.3), rtol=0.05)
    np.testing.assert_allclose(fields.centre, [[0.3, -0.2]], atol=0.02)


def test_single_fields_agree_with_neurospatial(wander: Callable, bump: Callable) -> None:
    positions, _ = wander(8000)
    rng = np.random.default_rng(0)
    centres, widths = rng.uniform([-1.8, -1.3], [1.8, 1.3], (20, 2)), rng.uniform(0.1, 0.4, 20)
    cells = zip(centres, widths, strict=True)
    maps = rate_maps(np.stack([bump(positions, tuple(c), w) for c, w in cells], axis=1), positions)
    fields = place_fields(maps)
    # neurospatial's first axis is x.
    room = Environment.from_grid_mask(maps.visited.T, tuple(maps.edges))
    for rates, mask in zip(maps.rates, fields.masks, strict=True):
        (trusted,) = detect_place_fields(
            room, rates.T[maps.visited.T], threshold=0.3, min_size=5, detect_subfields=False
        ).fields
        np.testing.assert_array_equal(np.flatnonzero(mask.T[maps.visited.T]), np.sort(trusted))


def test_what_makes_a_field_can_be_told() -> None:
    maps = drawn("000000000|099944000|099944000|000000000")
    assert place_fields(maps).area == pytest.approx(0.1)
    assert place_fields(maps, threshold=0.5).area == pytest.approx(0.06)
    assert place_fields(maps, least_area=0.11).number == 0
    assert place_fields(maps, most_share=0.25).number == 0


def test_two_fields_are_labelled_from_the_largest(wander: Callable, bump: Callable) -> None:
    positions, _ = wander(20_000)
    rates = bump(positions, (-1.0, 0.5), 0.2) + bump(positions, (1.0, -0.5), 0.3)
    maps = rate_maps(rates[:, None], positions)
    fields = place_fields(maps)
    assert fields.number.tolist() == [2]
    np.testing.assert_allclose(fields.centre, [[1.0, -0.5]], atol=0.03)
    x, y = maps.edges.centres
    assert fields.labels[0, np.searchsorted(y, -0.5), np.searchsorted(x, 1.0)] == 1
    assert fields.labels[0, np.searchsorted(y, 0.5), np.searchsorted(x, -1.0)] == 2


def test_threshold_is_thirty_percent_and_least_area_five_bins() -> None:
    maps = drawn(
        "9933200000|0000000000|0000000000",
        "9933000000|0000000000|0000000000",
        "9933100000|0000000000|0000055555",
        "0000000000|0000000000|0000055555",
        "0000000000|0000000000|0000000000",
    )
    fields = place_fields(maps)
    assert fields.number.tolist() == [0, 0, 1, 1, 0]
    np.testing.assert_allclose(fields.area, [0, 0, 0.05, 0.05, 0])
    np.testing.assert_allclose(fields.centre[3], [0.75, 0.25])
    assert np.isnan(fields.centre[[0, 1, 4]]).all()


def test_three_of_ten_is_inside() -> None:
    maps = drawn("9930000000|0093000000|0000000000")
    maps.rates[maps.rates == 9] = 10
    assert place_fields(maps).number.tolist() == [1]


def test_corners_do_not_connect_and_gaps_separate() -> None:
    assert place_fields(drawn("9999900000|0000099999|0000000000")).number.tolist() == [2]
    assert place_fields(drawn("99999 99999|00000 00000|00000 00000")).number.tolist() == [2]


def test_cells_do_not_connect_and_labels_agree_with_scipy_cell_by_cell() -> None:
    rng = np.random.default_rng(0)
    rates = ndimage.gaussian_filter(rng.random((30, 25, 30)), (0, 2, 2))
    rates -= rates.min(axis=(1, 2), keepdims=True)
    maps = RateMaps(rates**2, np.ones((25, 30)), BinEdges(np.arange(31) * 0.1, np.arange(26) * 0.1))
    fields = place_fields(maps)
    assert fields.number.max() > 2
    for cell in range(30):
        regions, found = ndimage.label(maps[cell] >= 0.3 * maps[cell].max())
        areas = [np.sum(regions == region) for region in range(1, found + 1)]
        areas = sorted((area for area in areas if 5 <= area <= 375), reverse=True)
        assert [np.sum(fields.labels[cell] == 1 + rank) for rank in range(len(areas))] == areas
        assert fields.labels[cell].max() == fields.number[cell] == len(areas)


def test_uniform_cell_has_no_field(wander: Callable) -> None:
    positions, _ = wander(5000)
    noise = np.random.default_rng(0).poisson(5, (5000, 20)).astype(float)
    maps = rate_maps(np.concatenate([noise, np.ones((5000, 1))], axis=1), positions)
    fields = place_fields(maps)
    assert not fields.number.any()
    assert not fields.masks.any()


def test_coverage_is_the_area_inside_some_passing_field() -> None:
    maps = drawn("99999     |0000000000", "00000     |9999900000", "00000     |0000099999")
    fields = place_fields(maps)
    reachable = maps.visited
    assert place_coverage(fields, np.array([True, False, True]), reachable) == pytest.approx(10 / 15)
    assert place_coverage(fields, np.array([True, True, True]), reachable) == 1
    assert place_coverage(fields, np.zeros(3, bool), reachable) == 0
    assert place_coverage(fields, np.array([True, False, False]), np.ones((2, 10), bool)) == 0.25


def test_bad_input_is_refused() -> None:
    fields = place_fields(drawn("99999     |0000000000"))
    with pytest.raises(CogmapError, match="2 cells and"):
        place_coverage(fields, np.ones(2, bool), np.ones((2, 10), bool))
    with pytest.raises(CogmapError, match="no bin is reachable"):
        place_coverage(fields, np.ones(1, bool), np.zeros((2, 10), bool))
