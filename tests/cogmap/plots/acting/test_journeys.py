import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from arena import Arena, Camera
from arena.acting import Journeys
from cogmap.plots import plot_journeys

ROOM, CAMERA = Arena.load("furnished"), Camera.panoramic(90, 15)
POSES = np.array(
    [[[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [[-0.5, 0.0, 0.0], [0.0, 0.2, 1.0]], [[0.0, 0, 0], [0.0, 0.2, 1.0]]]
)
GONE = Journeys(
    0.2 * np.arange(3),
    POSES,
    np.zeros((2, 2, 2)),
    np.array([[False, False], [True, False]]),
    np.array([2, 1]),
)
GOALS = POSES[-1] + 0.1
IMAGES = CAMERA.render(ROOM, GOALS)


def line(axes: Axes, label: str) -> np.ndarray:
    return next(line.get_xydata() for line in axes.lines if line.get_label() == label)


def test_ways_contacts_and_what_is_seen_are_drawn() -> None:
    figure = plot_journeys(ROOM, GONE, GOALS, IMAGES, CAMERA)
    room, *panels = figure.get_axes()
    # the longest is bold
    np.testing.assert_array_equal(line(room, "the way at the right"), POSES[:, 0, :2])
    thin = next(
        each for each in room.collections if isinstance(each, LineCollection) and each.get_label() == "way"
    )
    np.testing.assert_array_equal(thin.get_segments()[0], POSES[:, 1, :2])
    np.testing.assert_array_equal(line(room, "contact"), [[0.0, 0.0]])
    assert [panel.get_title() for panel in panels] == [
        "seen after 0.0 s", "seen after 0.2 s", "seen after 0.4 s", "the image of the goal",
    ]  # fmt: skip
    np.testing.assert_array_equal(panels[-1].images[0].get_array(), IMAGES[0])
    np.testing.assert_array_equal(panels[0].images[0].get_array(), CAMERA.render(ROOM, POSES[0, :1])[0])


@pytest.mark.parametrize("goals", [None, GOALS[:1]])
def test_a_journey_alone_is_drawn_whether_its_goal_is_known_or_not(goals) -> None:
    alone = Journeys(GONE.times, POSES[:, :1], GONE.commands[:, :1], GONE.touched[:, :1], GONE.steps[:1])
    axes = plot_journeys(ROOM, alone, goals, IMAGES[:1], CAMERA).get_axes()[0]
    np.testing.assert_array_equal(line(axes, "the way at the right"), POSES[:, 0, :2])
    assert axes.get_title() == "the journey to the pose of an image"
