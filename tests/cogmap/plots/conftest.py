from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure


@pytest.fixture
def pixel() -> Callable[[Figure, Axes, tuple[float, float]], np.ndarray]:
    """The colour (red, green, blue in 0..1) that a figure shows at a point of some axes."""

    def look(figure: Figure, axes: Axes, point: tuple[float, float]) -> np.ndarray:
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        image = np.asarray(canvas.buffer_rgba())
        column, row = axes.transData.transform(point)
        return image[image.shape[0] - 1 - int(row), int(column), :3] / 255

    return look


@pytest.fixture
def texts() -> Callable[[Axes], list[str]]:
    """What is written in axes."""
    return lambda axes: [text.get_text() for text in axes.texts]
