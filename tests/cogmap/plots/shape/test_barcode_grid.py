import dataclasses
import re

import numpy as np
import pytest
from matplotlib.colors import to_hex

from cogmap.errors import CogmapError
from cogmap.plots.shape.barcode_grid import LOOPS, VOIDS, plot_barcode_grid
from cogmap.plots.style import BAD, GOOD, INK, SOFT
from cogmap.shape.homology import Betti

LOOP_RATIOS = np.array([4.5, 3.8, *np.linspace(1.6, 1.05, 20)])
VOID_RATIOS = np.array([1.8, 1.15])


@pytest.fixture
def annulus() -> Betti:
    """Two loops and a void, as around a pillar."""

    def bars(ratio: np.ndarray) -> np.ndarray:
        return np.stack([np.full(len(ratio), 0.5), 0.5 * ratio], axis=1)

    return Betti(
        numbers=(1, 2, 1),
        bars=(np.array([[0, np.inf], [0, 1]]), bars(LOOP_RATIOS), bars(VOID_RATIOS)),
        thresholds=(np.inf, 1.9, 1.3),
        votes=(3, 3, 2),
        draws=3,
        landmarks=(400, 400, 150),
        points=17_000,
        metric="geodesic",
        reasons=("", "", "with 25 neighbours it is 2"),
    )


def test_loops_stand_above_voids_and_those_that_count_are_coloured(annulus: Betti) -> None:
    (axes,) = plot_barcode_grid({"pillar": {"fused": annulus}}, {"pillar": {"fused": (1, 2)}}).axes
    ends = [bar.get_x() + bar.get_width() for bar in axes.patches]
    np.testing.assert_allclose(ends, [*LOOP_RATIOS[:LOOPS], *VOID_RATIOS])
    colours = [to_hex(bar.get_facecolor()) for bar in axes.patches]
    assert colours == [GOOD] * 2 + [SOFT] * (LOOPS - 2) + ["#7b4fa3", SOFT]
    middles = [bar.get_y() + bar.get_height() / 2 for bar in axes.patches]
    np.testing.assert_allclose(middles, range(LOOPS + 2))
    assert axes.yaxis_inverted()
    assert axes.get_xscale() == "log"


def test_each_dimension_has_its_threshold(annulus: Betti) -> None:
    (axes,) = plot_barcode_grid({"pillar": {"fused": annulus}}, {"pillar": {"fused": (1, 2)}}).axes
    drawn = [(line.get_xdata()[0], *line.get_ydata()) for line in axes.lines]
    assert drawn == [(1.9, -0.5, LOOPS - 0.5), (1.3, LOOPS - 0.5, LOOPS + VOIDS - 0.5)]
    assert {to_hex(line.get_color()) for line in axes.lines} == {BAD}


@pytest.mark.parametrize(
    ("expected", "title", "colour"),
    [
        ((1, 2, 1), "fused\n[1, 2, 1?]", INK),
        ((1, 2), "fused\n[1, 2, 1?]", INK),
        ((1, 1), "fused\n[1, 2, 1?], not [1, 1]", BAD),
        ((1, 2, 0), "fused\n[1, 2, 1?], not [1, 2, 0]", BAD),
    ],
)
def test_title_tells_what_is_found_and_what_is_not_as_expected(
    annulus: Betti, expected: tuple[int, ...], title: str, colour: str
) -> None:
    (axes,) = plot_barcode_grid({"pillar": {"fused": annulus}}, {"pillar": {"fused": expected}}).axes
    assert axes.get_title() == title
    assert axes.title.get_color() == colour


def test_a_line_per_room_a_column_per_cloud(annulus: Betti) -> None:
    wide = dataclasses.replace(annulus, bars=(annulus.bars[0], np.array([[1.0, 40.0]]), annulus.bars[2]))
    results = {
        "two_rooms": {"place": annulus, "heading": wide},
        "pillar": {"place": annulus, "heading": None},
    }
    expected = {room: {"place": (1, 2), "heading": (1, 1)} for room in results}
    place, heading, place_too, nothing = plot_barcode_grid(results, expected).axes
    assert place.get_ylabel() == "two rooms"
    assert place_too.get_ylabel() == "pillar"
    assert place.get_xlim() == place_too.get_xlim() != heading.get_xlim()
    assert heading.get_xlim() == nothing.get_xlim()
    assert heading.get_xlim()[1] > 40
    assert nothing.get_title() == "nothing, not [1, 1]"
    assert nothing.title.get_color() == BAD
    assert not nothing.patches
    assert place_too.get_xlabel() == nothing.get_xlabel() == "π = death / birth, no unit"
    assert place.get_xlabel() == heading.get_xlabel() == ""


def test_an_endless_bar_reaches_the_edge(annulus: Betti) -> None:
    endless = dataclasses.replace(annulus, bars=(annulus.bars[0], np.array([[1.0, np.inf]]), annulus.bars[2]))
    (axes,) = plot_barcode_grid({"pillar": {"fused": endless}}, {"pillar": {"fused": (1, 2)}}).axes
    bar = axes.patches[0]
    assert bar.get_x() + bar.get_width() == pytest.approx(axes.get_xlim()[1])


@pytest.mark.parametrize(
    ("rooms", "expected", "says"),
    [
        ({}, {}, "at least one"),
        ({"pillar": ()}, {"pillar": ()}, "at least one"),
        ({"pillar": ("place",)}, {"pillar": ("heading",)}, "give each room the same"),
        ({"pillar": ("place",)}, {"furnished": ("place",)}, "give the same rooms"),
        ({"a": ("place",), "b": ("fused",)}, {"a": ("place",), "b": ("place",)}, "give each room the same"),
    ],
)
def test_what_does_not_fit_is_refused(
    rooms: dict[str, tuple[str, ...]], expected: dict[str, tuple[str, ...]], says: str, annulus: Betti
) -> None:
    with pytest.raises(CogmapError, match=re.escape(says)):
        plot_barcode_grid(
            {room: dict.fromkeys(clouds, annulus) for room, clouds in rooms.items()},
            {room: dict.fromkeys(clouds, (1, 2)) for room, clouds in expected.items()},
        )
