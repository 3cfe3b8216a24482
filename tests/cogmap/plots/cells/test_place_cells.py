from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_hex

from cogmap.cells import RateMaps, place_statistics, rate_maps
from cogmap.errors import CogmapError
from cogmap.plots.cells.place_cells import COLOURS, plot_rate_maps
from cogmap.plots.style import ABSENT, BAD

Cells = tuple[RateMaps, pd.DataFrame]


@pytest.fixture(scope="module")
def cells() -> Cells:
    """60 Gaussian cells around a hole in a 4×3 m room; 7 is silent and 8 fires everywhere."""
    rng = np.random.default_rng(0)
    positions = rng.uniform([-2, -1.5], [2, 1.5], (6000, 2))
    positions = positions[np.linalg.norm(positions, axis=1) > 0.5]
    centres = rng.uniform([-1.9, -1.4], [1.9, 1.4], (60, 2))
    rates = 10 * np.exp(-np.sum((positions[:, None] - centres) ** 2, axis=2) / (2 * 0.3**2))
    rates[:, 7], rates[:, 8] = 0, 3
    headings = rng.uniform(-np.pi, np.pi, len(positions))
    maps = rate_maps(rates, positions)
    return maps, place_statistics(rates, positions, headings, maps=maps)


def drawn(figure: object) -> dict[int, object]:
    images = figure.axes[0].images
    return {int(image.get_label().removeprefix("cell ")): image for image in images}


def test_each_map_is_that_of_its_cell_over_its_peak(cells: Cells) -> None:
    maps, statistics = cells
    images = drawn(plot_rate_maps(maps, statistics, 60))
    assert sorted(images) == list(range(60))
    for cell, image in images.items():
        peak = np.nanmax(maps[cell]) or 1.0
        np.testing.assert_allclose(image.get_array().filled(np.nan), maps[cell] / peak)
        assert image.get_clim() == (0, 1)
        assert image.origin == "lower"


def test_count_caps_the_sheet_at_distinct_cells(cells: Cells) -> None:
    assert len(drawn(plot_rate_maps(*cells))) == 40
    assert len(drawn(plot_rate_maps(*cells, count=1))) == 1
    assert len(drawn(plot_rate_maps(*cells, count=1000))) == 60


def test_the_sheet_is_ordered_like_the_room(cells: Cells) -> None:
    maps, statistics = cells
    lines: dict[float, list[tuple[float, int]]] = {}
    for cell, image in drawn(plot_rate_maps(maps, statistics, 24)).items():
        left, _, bottom, _ = image.get_extent()
        lines.setdefault(round(bottom, 6), []).append((left, cell))
    assert [len(line) for line in lines.values()] == [8, 8, 8]
    upwards = [[cell for _, cell in sorted(line)] for _, line in sorted(lines.items())]
    for line in upwards:
        x = statistics["centre_x_m"].iloc[line].dropna()
        assert x.is_monotonic_increasing
        assert x.iloc[0] < -0.8
        assert x.iloc[-1] > 0.8
    heights = [statistics["centre_y_m"].iloc[line] for line in upwards]
    assert heights[0].max() <= heights[1].min()
    assert heights[1].max() <= heights[2].min()


def test_titles_tell_rate_and_information_and_red_fails(cells: Cells) -> None:
    maps, statistics = cells
    figure = plot_rate_maps(maps, statistics, 60)
    axes, _ = figure.axes
    order = [int(image.get_label().removeprefix("cell ")) for image in axes.images]
    for cell, text in zip(order, axes.texts, strict=True):
        row = statistics.iloc[cell]
        expected = f"{row['peak_rate_hz']:.1f} Hz, {row['spatial_information']:.2f} bit/spike"
        assert text.get_text() == ("silent" if cell == 7 else expected)
        assert (to_hex(text.get_color()) == BAD) == (not row["passing"])
    assert figure.get_suptitle().startswith("60 of 60 place cells")
    assert figure.get_suptitle().endswith(f"{statistics['passing'].sum()} of 60 pass (red: does not)")


def test_axes_are_metres_repeated_for_every_map(cells: Cells) -> None:
    maps, statistics = cells
    (axes, bar) = plot_rate_maps(maps, statistics, 16).axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (m)", "y (m)")
    assert axes.get_aspect() == 1
    assert bar.get_ylabel() == "rate (fraction of peak)"
    lefts = sorted({image.get_extent()[0] for image in axes.images})
    ticks = np.reshape(axes.get_xticks(), (8, -1)) - np.array(lefts)[:, None] + maps.edges.x[0]
    for names in np.reshape([text.get_text() for text in axes.get_xticklabels()], (8, -1)):
        np.testing.assert_allclose([float(name.replace("−", "-")) for name in names], ticks[0])
    np.testing.assert_allclose(ticks, np.tile(ticks[0], (8, 1)), atol=1e-9)
    left, right, bottom, top = axes.images[3].get_extent()
    np.testing.assert_allclose(right - left, np.ptp(maps.edges.x))
    np.testing.assert_allclose(top - bottom, np.ptp(maps.edges.y))


def test_pixels_are_bright_in_the_field_and_grey_in_the_hole(cells: Cells, pixel: Callable) -> None:
    maps, statistics = cells
    figure = plot_rate_maps(maps, statistics, 8)
    (axes, _) = figure.axes
    image = axes.images[0]
    rates = image.get_array()
    row, column = np.unravel_index(rates.argmax(), rates.shape)
    left, right, bottom, top = image.get_extent()
    peak = left + (column + 0.5) * (right - left) / 40, bottom + (row + 0.5) * (top - bottom) / 30
    np.testing.assert_allclose(pixel(figure, axes, peak), COLOURS(1.0)[:3], atol=0.01)
    hole = (left + right) / 2, (bottom + top) / 2
    grey = [int(ABSENT[start : start + 2], 16) / 255 for start in (1, 3, 5)]
    np.testing.assert_allclose(pixel(figure, axes, hole), grey, atol=0.01)


def test_bad_input_is_refused(cells: Cells) -> None:
    maps, statistics = cells
    with pytest.raises(CogmapError, match="count is 0"):
        plot_rate_maps(maps, statistics, 0)
    with pytest.raises(CogmapError, match="60 maps for 59 cells"):
        plot_rate_maps(maps, statistics.iloc[:59])
