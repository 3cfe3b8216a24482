import numpy as np
import pytest

from cogmap.cells import Tuning, rate_maps, tuning_curves
from cogmap.errors import CogmapError
from cogmap.plots.cells.examples import plot_examples


@pytest.fixture(scope="module")
def tuning() -> Tuning:
    rng = np.random.default_rng(0)
    positions, headings = rng.uniform([-2, -1.5], [2, 1.5], (4000, 2)), rng.uniform(-np.pi, np.pi, 4000)
    centres = rng.uniform([-1.5, -1], [1.5, 1], (9, 2))
    rates = 10 * np.exp(-((positions[:, None] - centres) ** 2).sum(axis=2) / 0.18)
    rates[:, 4] = 0
    return Tuning(rate_maps(rates, positions), tuning_curves(rates, headings))


def test_firing_cells_are_drawn_map_above_curve(tuning: Tuning) -> None:
    figure = plot_examples({"some": tuning, "more": tuning})
    maps, curves = (np.array(figure.axes).reshape(2, 2, 6)[0, row] for row in (0, 1))
    shown = [int(axes.get_title().split()[1].rstrip(":")) for axes in maps]
    assert len(set(shown)) == 6
    assert len(plot_examples({"some": tuning}, count=3).axes) == 2 * 3
    assert 4 not in shown
    for axes, below, cell in zip(maps, curves, shown, strict=True):
        (mesh,) = axes.collections
        drawn = np.ma.filled(mesh.get_array().astype(float), np.nan).reshape(tuning.maps[cell].shape)
        np.testing.assert_allclose(drawn, tuning.maps[cell] / np.nanmax(tuning.maps[cell]))
        (bars,) = below.collections
        heights = [np.sort(bar.vertices[:4, 1])[2] for bar in bars.get_paths()]
        np.testing.assert_allclose(heights, tuning.curves[cell] / tuning.curves[cell].max())
    assert maps[0].get_xlabel() == "x (m)"
    assert curves[0].get_xlabel() == "heading (°)"


def test_few_or_no_firing_cells_leave_gaps() -> None:
    silent = Tuning(
        rate_maps(np.zeros((4000, 2)), np.random.default_rng(0).uniform(-1, 1, (4000, 2))), np.zeros((2, 36))
    )
    figure = plot_examples({"silent": silent})
    assert not any(axes.axison for axes in figure.axes)


def test_no_populations_are_refused() -> None:
    with pytest.raises(CogmapError, match="no populations"):
        plot_examples({})
