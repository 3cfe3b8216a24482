import numpy as np

from arena import Arena, Arm
from cogmap.plots import plot_joint_reach


def test_views_goal_arm_and_way_are_drawn() -> None:
    room, body = Arena.load("furnished"), Arm()
    way = np.column_stack([np.linspace(2.5, 3.5, 11), np.linspace(0.0, 1.0, 11)])
    frames, views = np.array([0, 5, 10]), np.zeros((3, 4, 4, 3), np.uint8)
    goal = np.full((4, 4, 3), 9, np.uint8)
    *strip, above, square = plot_joint_reach(room, body, way, frames=frames, views=views, goal=goal).axes
    np.testing.assert_array_equal(strip[3].images[0].get_array(), goal)
    hands = [line.get_xydata()[-1] for line in above.lines if line.get_linewidth() == 4]
    np.testing.assert_allclose(hands, body.segments(way[frames])[:, -1, 1])
    # across the border of the square the way goes on at the other side
    parts = [
        line.get_xydata()
        for line in square.lines
        if line.get_linestyle() == "-" and len(line.get_xydata()) > 1
    ]
    assert len(parts) == 2
    np.testing.assert_allclose(parts[0] - parts[1], np.broadcast_to([360.0, 0.0], (11, 2)))
