import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.plots.bodies.look_alikes import plot_look_alikes


def test_both_postures_and_both_views_are_drawn() -> None:
    up = np.array([[[0.0, 0.0], [1.0, 1.0]], [[1.0, 1.0], [2.0, 0.0]]])
    postures = np.stack([up, up * [1, -1]])[None]
    views = np.stack([np.full((4, 8, 3), grey, np.uint8) for grey in (3, 9)])[None]
    above, first, second = plot_look_alikes(postures, views).axes
    np.testing.assert_array_equal(above.lines[0].get_xydata(), [[0, 0], [1, 1], [2, 0]])
    np.testing.assert_array_equal(above.lines[1].get_xydata(), [[0, 0], [1, -1], [2, 0]])
    np.testing.assert_array_equal(first.images[0].get_array(), views[0, 0])
    np.testing.assert_array_equal(second.images[0].get_array(), views[0, 1])


def test_no_pair() -> None:
    with pytest.raises(CogmapError, match="no pair"):
        plot_look_alikes(np.zeros((0, 2, 1, 2, 2)), np.zeros((0, 2, 4, 4, 3), np.uint8))
