from collections.abc import Callable

import numpy as np
import pytest
import shapely
from matplotlib.collections import PathCollection
from matplotlib.colors import to_rgb
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure

from arena.errors import ArenaError
from arena.rooms.arena import Arena
from arena.rooms.materials import texture
from cogmap.errors import CogmapError
from cogmap.plots.rooms.room import plot_room


def colour(material: str) -> np.ndarray:
    return texture(material).mean(axis=(0, 1)) / 255


def contours(figure: Figure) -> list[QuadContourSet]:
    return [found for found in figure.axes[0].collections if isinstance(found, QuadContourSet)]


@pytest.fixture
def pillar() -> Arena:
    return Arena.load("pillar")


def test_solids_have_their_outline_and_mean_colour(pillar: Arena) -> None:
    (axes,) = plot_room(pillar).axes
    assert len(axes.patches) == len(pillar.solids)
    for patch, solid in zip(axes.patches, pillar.solids, strict=True):
        np.testing.assert_allclose(patch.get_path().vertices[:-1], solid.outline)
        np.testing.assert_allclose(patch.get_facecolor()[:3], colour(solid.material), atol=1e-6)


def test_pixels_show_walls_solids_and_floor(pillar: Arena, pixel: Callable) -> None:
    figure = plot_room(pillar)
    (axes,) = figure.axes
    for solid, inside in ((pillar.pillars[0], (0.05, 0.35)), (pillar.boxes[2], (2.65, 0.1))):
        np.testing.assert_allclose(pixel(figure, axes, inside), colour(solid.material), atol=0.01)
    for wall, middle in zip(pillar.walls, [(0, -2.5), (3, 0), (0, 2.5), (-3, 0)], strict=True):
        np.testing.assert_allclose(pixel(figure, axes, middle), colour(wall.material), atol=0.01)
    np.testing.assert_array_equal(pixel(figure, axes, (-2.7, -2.2)), 1)


def test_axes_are_in_metres_and_hold_the_room(pillar: Arena) -> None:
    (axes,) = plot_room(pillar).axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (m)", "y (m)")
    assert axes.get_aspect() == 1
    assert axes.get_xlim()[0] < -3 < 3 < axes.get_xlim()[1]
    assert axes.get_ylim()[0] < -2.5 < 2.5 < axes.get_ylim()[1]


def test_materials_and_heights_are_written_on_things(pillar: Arena) -> None:
    (axes,) = plot_room(pillar).axes
    said = {text.get_text(): text for text in axes.texts}
    for wall in pillar.walls:
        text = said[f"{wall.material}, 1 m"]
        # Beside the wall, away from the platform.
        np.testing.assert_allclose(text.xy, np.mean([wall.start, wall.end], axis=0))
        outward = np.array(text.get_position())
        assert outward @ text.xy > 0
        assert np.linalg.norm(outward) == pytest.approx(10)
        assert -90 <= text.get_rotation() - 360 * (text.get_rotation() > 180) <= 90.5
    for solid in pillar.solids:
        text = said[f"{solid.material}\n{solid.height:g} m"]
        np.testing.assert_allclose(text.get_position(), solid.center, atol=1e-2)
    assert len(said) == 4 + 5 + 1


def test_a_side_of_its_own_material_has_its_colour_and_name(pixel: Callable) -> None:
    arena = Arena.load("two_rooms")
    figure = plot_room(arena)
    (axes,) = figure.axes
    lower = arena.boxes[0]
    names = lower.sides
    said = {text.get_text() for text in axes.texts}
    assert {names[1], names[3], "1 m"} <= said
    # The jambs are too narrow to be named.
    assert names[0] not in said
    for side, x in ((1, 0.1), (3, -0.1)):
        np.testing.assert_allclose(pixel(figure, axes, (x, -1.7)), colour(names[side]), atol=0.02)


def test_blocks_are_drawn() -> None:
    corners = ((0, 0), (1, 0), (1, 1), (0.8, 1), (0.8, 0.2), (0, 0.2))
    block = {"corners": corners, "height": 0.4, "material": "oak"}
    wall = {"start": (-2, 2), "end": (2, 2), "material": "white"}
    arena = Arena.create(name="hook", platform=[corners], walls=[wall], blocks=[block])
    (axes,) = plot_room(arena).axes
    (patch,) = axes.patches
    np.testing.assert_allclose(patch.get_path().vertices[:-1], corners)
    (label,) = [text for text in axes.texts if text.get_text() == "oak\n0.4 m"]
    assert patch.get_path().contains_point(label.get_position())


def test_the_light_is_an_arrow_from_the_lamp() -> None:
    arena = Arena.load("l_shape")
    (axes,) = plot_room(arena).axes
    (arrow,) = [text for text in axes.texts if text.arrow_patch is not None]
    tail = np.array(arrow.get_position())
    assert np.rad2deg(np.arctan2(tail[1], tail[0])) == pytest.approx(arena.light.azimuth_deg)
    assert any("light from 65°,\n40° up,\nstrength 0.35" in text.get_text() for text in axes.texts)


def test_a_textured_floor_is_in_the_legend() -> None:
    (legend,) = plot_room(Arena.load("linear_track")).legends
    assert [text.get_text() for text in legend.get_texts()][:2] == ["platform", "floor of marble"]


def test_a_name_is_no_formula(pixel: Callable) -> None:
    arena = Arena.create(**{**Arena.load("open_field").model_dump(), "name": "a$b_{c$"})
    figure = plot_room(arena)
    pixel(figure, figure.axes[0], (0, 0))
    assert figure.axes[0].get_title().startswith("a$b_{c$")


def test_a_huge_room_is_drawn_or_refused() -> None:
    wall = {"start": (-1000, 1000), "end": (1000, -1000), "material": "white"}
    fields = {"name": "huge", "platform": [((0, 0), (1, 0), (0, 1))], "walls": [wall]}
    assert plot_room(Arena.create(**fields)).axes
    with pytest.raises(ArenaError, match="make the room smaller"):
        plot_room(Arena.create(**fields, sources=[{"position": (0.5, 0.5)}]))


def test_odours_are_drawn_on_their_side_of_a_closed_wall() -> None:
    arena = Arena.load("l_shape")
    for lines in contours(plot_room(arena)):
        for path in lines.get_paths():
            assert arena.walkable.buffer(0.52, join_style="mitre").covers(shapely.points(path.vertices)).all()


def test_platform_is_the_dashed_border_of_the_union() -> None:
    side = ([-1, -1], [0.2, -1], [0.2, 1], [-1, 1])
    halves = [side, [(-x, y) for x, y in side]]
    arena = Arena.create(
        name="two", platform=halves, walls=[{"start": (-2, 2), "end": (2, 2), "material": "white"}]
    )
    (axes,) = plot_room(arena).axes
    (border,) = [line for line in axes.lines if line.get_linestyle() == "--"]
    x, y = border.get_data()
    assert ((np.abs(np.abs(x) - 1) < 1e-9) | (np.abs(np.abs(y) - 1) < 1e-9)).all()
    assert not contours(plot_room(arena))


def test_contours_halve_and_lie_where_the_odour_has_their_level(pillar: Arena) -> None:
    figure = plot_room(pillar)
    drawn = contours(figure)
    assert len(drawn) == len(pillar.sources)
    hues = {to_rgb(lines.get_edgecolor()[0]) for lines in drawn}
    assert len(hues) == len(drawn)
    for odour, lines in enumerate(drawn):
        levels = np.asarray(lines.levels)
        assert len(levels) >= 4
        np.testing.assert_allclose(levels[1:] / levels[:-1], 2)
        for level, path in zip(levels, lines.get_paths(), strict=True):
            vertices = path.vertices
            near = np.linalg.norm(vertices - pillar.sources[odour].position, axis=1) < 0.2
            free = pillar.is_free(vertices, 0.1) & ~near
            found = pillar.odours.concentration(vertices[free])[:, odour]
            np.testing.assert_allclose(found, level, rtol=0.02)


def test_sources_are_stars_of_the_hue_of_their_contours(pillar: Arena) -> None:
    figure = plot_room(pillar)
    stars = [line for line in figure.axes[0].lines if line.get_marker() == "*"]
    np.testing.assert_allclose([star.get_xydata()[0] for star in stars], pillar.odours.sources)
    for star, lines in zip(stars, contours(figure), strict=True):
        assert to_rgb(star.get_color()) == to_rgb(lines.get_edgecolor()[0])
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()][1:] == [f"odour source {i}" for i in range(3)]


def test_an_odour_without_contours_is_no_error() -> None:
    arena = Arena.create(**{**Arena.load("open_field").model_dump(), "decay_length": 1000.0})
    assert not contours(plot_room(arena))


def test_every_view_is_a_dot_and_the_first_are_joined(pillar: Arena) -> None:
    rng = np.random.default_rng(0)
    poses = rng.uniform([-2, -1.5, -3], [2, 1.5, 3], (1234, 3))
    figure = plot_room(pillar, poses)
    (axes,) = figure.axes
    (dots,) = [found for found in axes.collections if isinstance(found, PathCollection)]
    np.testing.assert_array_equal(dots.get_offsets(), poses[:, :2])
    (way,) = [line for line in axes.lines if len(line.get_xdata()) == 300]
    np.testing.assert_array_equal(way.get_xydata(), poses[:300, :2])
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()][-2:] == ["1,234 views", "way of the first 300"]


def test_poses_that_are_not_poses_are_refused(pillar: Arena) -> None:
    with pytest.raises(CogmapError, match="poses is not finite"):
        plot_room(pillar, np.full((3, 3), np.nan))
    with pytest.raises(CogmapError, match="poses has shape"):
        plot_room(pillar, np.zeros((0, 3)))
