import numpy as np
import pytest

from arena import Box
from cogmap.errors import CogmapError
from cogmap.evaluation.shortest import shortest_lengths
from tests.cogmap.evaluation.rooms import ROOM


def test_the_shortest_way_around_a_box_is_known() -> None:
    radius = 0.2
    pairs = np.array([[[-1.5, 0], [1.5, 0]], [[-1.5, 1], [1.5, 1]]], dtype=float)
    straight = np.hypot(1, 0.5)
    tangent = np.sqrt(straight**2 - radius**2)
    arc = np.arcsin(radius / straight) + np.arctan2(0.5, 1)
    around = 2 * (tangent + radius * arc) + 1
    np.testing.assert_allclose(shortest_lengths(ROOM, pairs, radius), [around, 3], rtol=1e-3)


def test_the_shortest_way_does_not_depend_on_how_the_room_is_turned() -> None:
    corners = np.array([[-2.0, -2], [2, -2], [2, 2], [-2, 2]])
    pairs = np.random.default_rng(0).uniform([-1.7, -1.7], [-0.8, 1.7], (20, 2, 2)) * [[[1, 1], [-1, 1]]]
    straight = shortest_lengths(ROOM, pairs, 0.2)
    for angle in (0.3, 1.1):
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        turned = ROOM.model_copy(
            update={
                "platform": [[tuple(corner) for corner in (corners @ turn).tolist()]],
                "boxes": [Box(center=(0, 0), size=(1, 1), angle_deg=np.rad2deg(angle), material="oak")],
            }
        )
        np.testing.assert_allclose(shortest_lengths(turned, pairs @ turn, 0.2), straight, rtol=2e-3)


def test_places_that_are_not_free_or_not_joined_are_refused() -> None:
    with pytest.raises(CogmapError, match="not all places are free"):
        shortest_lengths(ROOM, np.array([[[0.0, 0], [1.5, 0]]]), 0.2)
    apart = ROOM.model_copy(
        update={"platform": [[(-2, -2), (-1, -2), (-1, 2), (-2, 2)], [(1, -2), (2, -2), (2, 2), (1, 2)]]}
    )
    with pytest.raises(CogmapError, match="no way leads"):
        shortest_lengths(apart, np.array([[[-1.5, 0.0], [1.5, 0]]]), 0.2)
