import numpy as np
import pytest

from arena import Arena, Arm, Rail
from arena.rooms.parts import Box
from cogmap.errors import CogmapError
from cogmap.evaluation.joint_ways import joint_length, shortest_joint_ways, ways_are_free

OPEN = Arena.load("furnished")
BOXED = OPEN.model_copy(update={"boxes": (Box(center=(1.4, 0.0), size=(0.3, 0.3), material="oak"),)})
THROUGH = np.array([[-0.6, 0.0], [0.6, 0.0]])


def test_what_is_in_the_way_is_found() -> None:
    around = np.array([[-0.6, 0.0], [-0.6, -2.5], [0.6, -2.5], [0.6, 2.5], [0.6, 0.0]])
    assert ways_are_free(BOXED, Arm(), [THROUGH, around]).tolist() == [False, True]
    assert ways_are_free(OPEN, Arm(), [THROUGH]).all()


def test_lengths_are_the_short_way_round() -> None:
    way = np.array([[3.0, 0.0], [-3.0, 0.0], [-3.0, 1.0]])
    assert joint_length(way) == pytest.approx(2 * np.pi - 6 + 1)


def test_shortest_ways_are_straight_or_lead_around() -> None:
    pairs = np.stack([THROUGH, [[3.0, 1.0], [-3.0, 1.5]]])
    bent, straight = shortest_joint_ways(BOXED, Arm(), pairs)
    assert straight == pytest.approx(np.hypot(2 * np.pi - 6, 0.5))
    # as far as the second link must be drawn in beside the box, and out again
    assert 2.0 < bent < 5.0
    np.testing.assert_allclose(shortest_joint_ways(OPEN, Arm(), pairs[:1]), [1.2])


def test_what_has_no_ways_is_told() -> None:
    with pytest.raises(CogmapError, match="two turning joints"):
        shortest_joint_ways(OPEN, Rail(), np.zeros((1, 2, 2)))
    with pytest.raises(CogmapError, match="not all postures are free"):
        shortest_joint_ways(BOXED, Arm(), np.zeros((1, 2, 2)))
    limited = Arm(limits=((-1.0, 1.0), None))
    walled = BOXED.model_copy(update={"boxes": (Box(center=(0.8, 0.0), size=(0.3, 0.3), material="oak"),)})
    with pytest.raises(CogmapError, match="no way leads"):
        shortest_joint_ways(walled, limited, THROUGH[None] * 1.5)
