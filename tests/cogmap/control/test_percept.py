from copy import copy

import numpy as np
import pytest

from arena import Camera
from cogmap import CogmapError
from cogmap.control.percept import MapPercept
from tests.cogmap.conftest import Refined


def test_a_refined_map_tells_places_and_turns(refined: Refined, camera: Camera) -> None:
    poses = np.array([[0.5, 0.3, 0.0], [-1.0, 0.6, 2.0]])
    views, others = (camera.render(refined.room, poses + np.array([0, 0, turn])) for turn in (0.0, 0.5))
    percept = MapPercept(refined.cmap)
    seen = percept.perceive(views)
    assert seen.plain is not None
    there = percept.perceive(others)
    turned = np.angle(np.exp(1j * (there.phase - seen.phase)))
    np.testing.assert_allclose(np.abs(turned), 0.5, atol=0.05)
    # read off the views themselves: finer than from both phases, and with the same sign
    np.testing.assert_allclose(percept.turns(views, others), 0.5 * np.sign(turned), atol=0.005)


def test_a_map_that_is_not_refined_is_too_coarse(refined: Refined) -> None:
    coarse = copy(refined.cmap)
    coarse.relaxed_places_, coarse.refine_reason_ = None, "call refine"
    with pytest.raises(CogmapError, match="too coarse to act on: call refine"):
        MapPercept(coarse).relaxed  # noqa: B018
