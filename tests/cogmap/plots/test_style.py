from pathlib import Path

import cv2
import matplotlib as mpl
import numpy as np
import pytest
from IPython.core.formatters import DisplayFormatter
from matplotlib.colors import to_hex

import cogmap.plots
from cogmap.plots import style


def test_cyclic_colours_close_up_and_are_equally_light() -> None:
    colours = style.HUES(np.arange(360))[:, :3]
    steps = np.linalg.norm(colours - np.roll(colours, 1, axis=0), axis=1)
    assert steps.max() < 0.02
    assert colours.min() > 0
    assert colours.max() < 1
    linear = np.where(colours > 0.04045, ((colours + 0.055) / 1.055) ** 2.4, colours / 12.92)
    lightness = 116 * np.cbrt(linear @ [0.2126, 0.7152, 0.0722]) - 16
    assert np.ptp(lightness) < 12


def test_directions_wrap_and_nan_is_grey() -> None:
    quarter = np.pi / 2
    ends, around, nowhere = (
        style.direction_colours(np.array(angles))
        for angles in ([-np.pi, np.pi, 3 * np.pi], [-np.pi, -quarter, 0.0, quarter], [np.nan])
    )
    assert (ends == ends[0]).all()
    apart = np.linalg.norm(around[:, None] - around, axis=2)
    assert apart[~np.eye(4, dtype=bool)].min() > 0.25
    assert nowhere[0, 0] == nowhere[0, 1] == nowhere[0, 2]


def test_direction_scale_agrees_with_direction_colours() -> None:
    degrees = np.array([-180.0, -100.0, 0.0, 77.0, 179.0])
    np.testing.assert_allclose(
        style.direction_scale().to_rgba(degrees), style.direction_colours(np.deg2rad(degrees)), atol=0.02
    )


def test_the_users_settings_are_neither_used_nor_changed() -> None:
    with mpl.rc_context({"text.color": "red", "axes.facecolor": "black", "axes.labelcolor": "red"}):
        before = dict(mpl.rcParams)
        figure = style.new_figure(3.0, 2.0)
        axes = figure.add_subplot()
        style.tidy_room(axes, title="a room")
        axes.plot([0, 1], [0, 1], label="a line")
        style.tidy_legend(axes, title="legend")
        bar = style.colour_bar(axes, style.direction_scale(), "direction (°)")
        assert dict(mpl.rcParams) == before
    legend = axes.get_legend()
    assert legend is not None
    written = [axes.title, axes.xaxis.label, axes.yaxis.label, bar.ax.yaxis.label, legend.get_title()]
    assert {to_hex(text.get_color()) for text in [*written, *legend.get_texts()]} == {style.INK}
    assert to_hex(axes.get_facecolor()) == to_hex(figure.get_facecolor()) == "#ffffff"
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (m)", "y (m)")
    assert axes.get_aspect() == 1
    assert bar.ax.get_ylabel() == "direction (°)"


@pytest.mark.parametrize(
    "module", sorted(Path(cogmap.plots.__file__).parent.rglob("*.py")), ids=lambda p: p.stem
)
def test_no_module_reaches_for_global_figures(module: Path) -> None:
    text = module.read_text(encoding="utf-8")
    assert "pyplot" not in text
    assert "rcParams" not in text


def test_a_legend_beside_covers_nothing() -> None:
    figure = style.new_figure(4.0, 3.0)
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], label="line")
    style.tidy_legend(axes, title="of", loc="beside")
    figure.draw_without_rendering()
    legend = axes.get_legend()
    assert legend is not None
    assert legend.get_window_extent().x0 >= axes.get_window_extent().x1
    assert legend.get_window_extent().x1 <= figure.bbox.x1


def test_a_figure_shows_itself_in_a_notebook() -> None:
    figure, _ = style.new_panels(3.0, 2.0, 1, 2)
    shown, _ = DisplayFormatter().format(figure)
    image = cv2.imdecode(np.frombuffer(shown["image/png"], np.uint8), cv2.IMREAD_COLOR)
    assert image.shape == (220, 330, 3)
