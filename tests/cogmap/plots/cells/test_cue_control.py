import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_rgb

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
    heading = pd.DataFrame(
        {
            "arena": "cue_square",
            "sensed": ["light", "light", "light", "both", "dark"],
            "shift_deg": [88.0, 92.0, np.nan, 40.0, np.nan],
        }
    )
    figure = plot_cue_control(place, heading)
    light, dark, turns = figure.axes
    assert light.get_title() == "light: 50% turn"
    assert dark.get_title() == "dark: 0% turn"
    assert turns.get_title() == "heading cells: light 90°, both 40°"
    colours = light.collections[0].get_facecolor()[:, :3]
    np.testing.assert_allclose(colours, [to_rgb(GOOD), to_rgb(BAD)], atol=1e-3)
    by_colour = {
        name: [b for b in turns.patches if b.get_facecolor()[:3] == colour]
        for name, colour in {"light": to_rgb(GOOD), "both": to_rgb(BAD)}.items()
    }
    assert {name: sum(bar.get_height() for bar in bars) for name, bars in by_colour.items()} == {
        "light": 2,
        "both": 1,
    }


def test_without_cells_there_is_nothing_to_draw() -> None:
    with pytest.raises(CogmapError, match="no place cells"):
        plot_cue_control(pd.DataFrame({"arena": []}), pd.DataFrame())
