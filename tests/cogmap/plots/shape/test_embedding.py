import numpy as np
import pytest

from cogmap import CogmapError
from cogmap.plots import plot_embedding
from cogmap.plots.style import direction_colours

HEADINGS = np.linspace(-3, 3, 400)
RING = np.column_stack([np.cos(HEADINGS), np.sin(HEADINGS)])


def test_a_ring_is_drawn_in_the_colours_of_its_headings() -> None:
    figure = plot_embedding(RING, HEADINGS, coordinates=(0, 1))
    points = figure.axes[0].collections[0]
    np.testing.assert_allclose(points.get_offsets(), RING)
    np.testing.assert_allclose(points.get_facecolor(), direction_colours(HEADINGS))
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == ["coordinate 2 (no unit)", "heading (°)"]


def test_three_coordinates_are_drawn_in_space_and_coloured_by_the_others(tmp_path) -> None:
    height = np.linspace(0, 1, 400)
    figure = plot_embedding(np.column_stack([RING, height]), HEADINGS, {"translation (m)": height})
    assert [axes.name for axes in figure.axes] == ["3d", "3d", "rectilinear", "rectilinear"]
    np.testing.assert_allclose(figure.axes[1].collections[0].get_array(), height)
    assert figure.axes[3].get_ylabel() == "translation (m)"
    figure.savefig(tmp_path / "cylinder.png")


def test_of_many_views_some_are_drawn() -> None:
    many = np.tile(RING, (40, 1))
    for count, few in ((6000, {}), (70, {"most": 70})):
        figure = plot_embedding(many, np.tile(HEADINGS, 40), coordinates=(0, 1), **few)
        assert len(figure.axes[0].collections[0].get_offsets()) == count


@pytest.mark.parametrize("coordinates", [(0,), (0, 1, 2), (0, 1, 0, 1)])
def test_coordinates_that_cannot_be_drawn_are_refused(coordinates: tuple[int, ...]) -> None:
    with pytest.raises(CogmapError, match="choose two or three"):
        plot_embedding(RING, HEADINGS, coordinates=coordinates)


def test_what_is_not_finite_is_refused() -> None:
    with pytest.raises(CogmapError, match="embedding is not finite"):
        plot_embedding(RING * np.nan, HEADINGS, coordinates=(0, 1))
