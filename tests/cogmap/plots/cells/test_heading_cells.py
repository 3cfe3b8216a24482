from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgba

from cogmap.cells import heading_statistics, tuning_curves
from cogmap.errors import CogmapError
from cogmap.plots.cells.heading_cells import plot_tuning_curves
from cogmap.plots.style import BAD, HUES, direction_colours

Cells = tuple[np.ndarray, pd.DataFrame]


@pytest.fixture(scope="module")
def cells() -> Cells:
    """30 von Mises cells; 5 is silent, 6 fires in all directions."""
    rng = np.random.default_rng(0)
    headings = rng.uniform(-np.pi, np.pi, 4000)
    preferred = np.linspace(-np.pi, np.pi, 30, endpoint=False)
    rates = 12 * np.exp(4 * (np.cos(headings[:, None] - preferred) - 1))
    rates[:, 5], rates[:, 6] = 0, 2
    positions = rng.uniform(-1, 1, (4000, 2))
    return tuning_curves(rates, headings), heading_statistics(rates, positions, headings)


def by_cell(axes: Axes) -> dict[int, object]:
    lines = [line for line in axes.lines if line.get_label().startswith("cell ")]
    return {int(line.get_label().removeprefix("cell ")): line for line in lines}


def centre(line: object) -> np.ndarray:
    """The circles lie on a grid of 2.75 radii."""
    return 2.75 * np.round(np.nanmean(line.get_xydata(), axis=0) / 2.75)


def test_curves_are_the_rates_by_direction_over_the_highest(cells: Cells) -> None:
    curves, statistics = cells
    lines = by_cell(plot_tuning_curves(curves, statistics, 30).axes[0])
    assert sorted(lines) == list(range(30))
    angle = -np.pi + (np.arange(36) + 0.5) * 2 * np.pi / 36
    for cell, line in lines.items():
        drawn = (line.get_xydata() - centre(line)) @ [1, 1j]
        expected = curves[cell] / (curves[cell].max() or 1) * np.exp(1j * angle)
        np.testing.assert_allclose(drawn, np.append(expected, expected[0]), atol=1e-9)


def test_colours_are_cyclic_in_the_preferred_direction(cells: Cells) -> None:
    curves, statistics = cells
    axes, bar = plot_tuning_curves(curves, statistics, 30).axes
    expected = direction_colours(statistics["preferred_direction_rad"].to_numpy())
    for cell, line in by_cell(axes).items():
        np.testing.assert_allclose(to_rgba(line.get_color()), expected[cell])
    assert bar.get_ylabel() == "preferred direction (°)"
    np.testing.assert_array_equal(bar.get_yticks(), [-180, -90, 0, 90, 180])
    np.testing.assert_allclose(HUES(0.0), HUES(1.0), atol=0.02)


def test_cells_are_spread_over_all_directions(cells: Cells) -> None:
    curves, statistics = cells
    chosen = list(by_cell(plot_tuning_curves(curves, statistics, 12).axes[0]))
    assert len(chosen) == 12
    directions = statistics["preferred_direction_rad"].iloc[chosen].dropna().to_numpy()
    assert (np.diff(directions) > 0).all()
    assert np.diff(np.append(directions, directions[0] + 2 * np.pi)).max() < np.deg2rad(60)


def test_titles_mean_vectors_and_rates(cells: Cells, texts: Callable) -> None:
    curves, statistics = cells
    figure = plot_tuning_curves(curves, statistics, 30)
    axes, _ = figure.axes
    vectors = [line for line in axes.lines if len(line.get_xdata()) == 2]
    for line, vector in zip(by_cell(axes).items(), vectors, strict=True):
        row = statistics.iloc[line[0]]
        length, direction = row["mean_vector_length"], row["preferred_direction_rad"]
        if length > 0.1:
            arrow = np.diff(vector.get_xydata(), axis=0)[0] @ [1, 1j]
            np.testing.assert_allclose(arrow, length * np.exp(1j * direction))
    written = texts(axes)
    row = statistics.iloc[2]
    title = f"vector {row['mean_vector_length']:.2f}, {np.rad2deg(row['preferred_direction_rad']):.0f}°"
    assert title.replace("-", "−") in written
    assert f"{curves[2].max():.1f} Hz" in written
    assert written.count("silent") == 1
    assert {"0°", "90°", "±180°", "−90°"} <= set(written)
    assert sum(to_hex(text.get_color()) == BAD for text in axes.texts) == 2
    assert figure.get_suptitle().endswith("28 of 30 pass (red: does not)")


def test_a_bin_without_views_is_a_gap(cells: Cells) -> None:
    curves, statistics = cells
    holed = curves.copy()
    holed[:, 10] = np.nan
    line = by_cell(plot_tuning_curves(holed, statistics, 30).axes[0])[0]
    assert np.flatnonzero(np.isnan(line.get_xdata())).tolist() == [10]


def test_pixels_fill_the_preferred_side_only(cells: Cells, pixel: Callable) -> None:
    curves, statistics = cells
    figure = plot_tuning_curves(curves[15:16], statistics[15:16])
    axes = figure.axes[0]
    np.testing.assert_array_equal(pixel(figure, axes, (-0.5, 0.1)), 1)
    assert pixel(figure, axes, (0.7, 0.1)).min() < 0.85


def test_bad_input_is_refused(cells: Cells) -> None:
    curves, statistics = cells
    with pytest.raises(CogmapError, match="count is 0"):
        plot_tuning_curves(curves, statistics, 0)
    with pytest.raises(CogmapError, match="29 curves and statistics of 30"):
        plot_tuning_curves(curves[:29], statistics)
