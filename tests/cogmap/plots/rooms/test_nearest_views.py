import numpy as np
import pandas as pd

from cogmap.plots import plot_likeness


def test_each_measure_has_its_curves_and_its_pictures() -> None:
    nearest = pd.DataFrame(
        {
            "measure": np.repeat(["pixels", "bag_of_words"], 50),
            "position_error_m": np.repeat([0.5, 0.1], 50),
            "heading_error_deg": np.repeat([9.0, 3.0], 50),
        }
    )
    black, white = np.zeros((3, 6, 8, 3), np.uint8), np.full((3, 6, 8, 3), 255, np.uint8)
    figure = plot_likeness(nearest, {"query": black, "bag_of_words": white})
    legends = [[text.get_text() for text in axes.get_legend().get_texts()] for axes in figure.axes[:2]]
    assert legends == [
        ["pixels: median 0.5", "bag of words: median 0.1"],
        ["pixels: median 9", "bag of words: median 3"],
    ]
    panels = figure.axes[2:]
    assert len(panels) == 6
    assert [axes.get_title() for axes in panels[:2]] == ["query", "bag of words"]
    assert [int(axes.images[0].get_array().mean()) for axes in panels] == 3 * [0, 255]
