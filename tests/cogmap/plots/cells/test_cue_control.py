import numpy as np
import pandas as pd
import pytest

from cogmap.errors import CogmapError
from cogmap.plots import plot_cue_control
from cogmap.plots.style import BAD, GOOD


def test_a_panel_by_sense_and_one_of_headings() -> None:
    place = pd.DataFrame(
        {
            "arena": "cue_square",
            "sensed": ["light", "light", "dark", "dark"],
            "sight": [0.9, 0.8, 0.1, 0.0],
            "smells": [0.1, 0.9, 0.9, 0.95],
        }
    )
    heading = pd.DataFrame({"arena": "cue_square", "sensed": "light", "shift_deg": [88.0, 92.0, np.nan]})
    figure = plot_cue_control(place, heading)
    light, dark, turns = figure.axes
    assert light.get_title() == "light: 50% turn"
    assert dark.get_title() == "dark: 0% turn"
    assert turns.get_title() == "heading cells: 90°"
    colours = light.collections[0].get_facecolor()[:, :3]
    np.testing.assert_allclose(colours, [_rgb(GOOD), _rgb(BAD)], atol=1e-3)
    assert sum(bar.get_height() for bar in turns.patches[1:]) == 2


def test_without_cells_there_is_nothing_to_draw() -> None:
    with pytest.raises(CogmapError, match="no place cells"):
        plot_cue_control(pd.DataFrame({"arena": []}), pd.DataFrame())


def _rgb(colour: str) -> list[float]:
    return [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
