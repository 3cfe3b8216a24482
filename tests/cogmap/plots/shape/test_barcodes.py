import dataclasses

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex

from cogmap.errors import CogmapError
from cogmap.plots.shape.barcodes import plot_barcodes
from cogmap.plots.style import BAD, GOOD, SOFT
from cogmap.shape.homology import Betti

LOOPS = np.array([4.5, 3.8, *np.linspace(1.6, 1.05, 20)])
VOIDS = np.array([1.8, 1.15, 1.1])


@pytest.fixture
def annulus() -> Betti:
    """Two loops and a void, as around a pillar."""

    def bars(ratio: np.ndarray) -> np.ndarray:
        birth = np.linspace(0.5, 2, len(ratio))
        return np.stack([birth, birth * ratio], axis=1)

    return Betti(
        numbers=(1, 2, 1),
        bars=(np.array([[0, np.inf], [0, 1], [0, 0.5]]), bars(LOOPS), bars(VOIDS)),
        thresholds=(np.inf, 1.9, 1.3),
        votes=(3, 3, 2),
        draws=3,
        landmarks=(400, 400, 150),
        points=17_000,
        metric="geodesic",
        reasons=("", "", "with 25 neighbours it is 2"),
    )


def lengths(axes: Axes) -> list[float]:
    return [bar.get_x() + bar.get_width() for bar in axes.patches]


def colours(axes: Axes) -> list[str]:
    return [to_hex(bar.get_facecolor()) for bar in axes.patches]


def test_bars_are_the_largest_ratios_in_falling_order(annulus: Betti) -> None:
    loops, voids = plot_barcodes({"views": annulus}).axes
    np.testing.assert_allclose(lengths(loops), LOOPS[:12])
    np.testing.assert_allclose(lengths(voids), VOIDS)
    fewer = plot_barcodes({"views": annulus}, bars=2).axes
    assert [lengths(axes) for axes in fewer] == [lengths(loops)[:2], lengths(voids)[:2]]
    assert all(bar.get_x() == 1 for bar in loops.patches)
    rows = [bar.get_y() for bar in loops.patches]
    assert rows == sorted(rows)
    assert loops.yaxis_inverted()


def test_bars_that_count_are_coloured_and_the_threshold_is_a_line(annulus: Betti) -> None:
    loops, voids = plot_barcodes({"views": annulus}).axes
    assert colours(loops) == [GOOD] * 2 + [SOFT] * 10
    assert colours(voids) == [GOOD] + [SOFT] * 2
    for axes, threshold in ((loops, 1.9), (voids, 1.3)):
        (line,) = axes.lines
        assert set(line.get_xdata()) == {threshold}
        assert to_hex(line.get_color()) == BAD
        assert axes.texts[0].get_text() == f"threshold {threshold:.2f}"


def test_axes_are_logarithmic_labelled_and_shared_by_all_results(annulus: Betti) -> None:
    circle = dataclasses.replace(
        annulus,
        numbers=(1, 1, 0),
        bars=(annulus.bars[0], np.array([[1.0, 20.0], [1.0, 1.2]]), np.zeros((0, 2))),
    )
    figure = plot_barcodes({"views": annulus, "heading": circle})
    assert len(figure.axes) == 4
    loops, voids, loops_too, voids_too = figure.axes
    assert loops.get_xscale() == voids.get_xscale() == "log"
    assert loops.get_xlim() == loops_too.get_xlim()
    assert loops.get_xlim()[1] > 20
    assert voids.get_xlim() == voids_too.get_xlim()
    assert loops.get_xlabel() == "π of H1 (loops), death / birth, no unit"
    assert voids.get_xlabel() == "π of H2 (voids), death / birth, no unit"
    assert "no bars" in [text.get_text() for text in voids_too.texts]


def test_title_tells_numbers_and_votes(annulus: Betti) -> None:
    (part,) = plot_barcodes({"view manifold": annulus}).subfigs
    title = "view manifold: b0 = 1 (3 of 3 draws), b1 = 2 (3 of 3 draws), b2 = 1 (2 of 3 draws, unresolved)"
    assert part.get_suptitle() == title


def test_a_result_without_voids_leaves_its_panel_empty(annulus: Betti) -> None:
    names = ("numbers", "bars", "thresholds", "votes", "reasons")
    fields = {name: getattr(annulus, name)[:2] for name in names}
    shallow = dataclasses.replace(annulus, landmarks=(400, 400), **fields)
    axes = plot_barcodes({"deep": annulus, "shallow": shallow}).axes
    assert [panel.axison for panel in axes] == [True, True, True, False]
    assert len(plot_barcodes({"shallow": shallow}).axes) == 1


def test_an_endless_bar_reaches_the_edge(annulus: Betti) -> None:
    endless = dataclasses.replace(
        annulus, bars=(annulus.bars[0], np.array([[1.0, np.inf], [1.0, 1.5]]), annulus.bars[2])
    )
    axes = plot_barcodes({"views": endless}).axes[0]
    np.testing.assert_allclose(lengths(axes), [axes.get_xlim()[1], 1.5])


def test_nothing_to_draw_is_refused(annulus: Betti) -> None:
    with pytest.raises(CogmapError, match="0 results"):
        plot_barcodes({})
    fields = {name: getattr(annulus, name)[:1] for name in ("numbers", "bars", "thresholds", "votes")}
    with pytest.raises(CogmapError, match="1 results and none has loops"):
        plot_barcodes({"pieces": dataclasses.replace(annulus, **fields)})
