import numpy as np
import pytest

from arena import Recording
from cogmap.cells import rate_maps
from cogmap.evaluation.cue_control import CueControl, turned

CENTRES = np.array([(1.0, 0.3), (-0.5, -1.0), (0.2, 1.1)])
DIRECTIONS = np.array([0.4, -2.0, 3.0])


def walk(seed: int) -> Recording:
    rng = np.random.default_rng(seed)
    poses = np.c_[rng.uniform(-1.5, 1.5, (4000, 2)), rng.uniform(-np.pi, np.pi, 4000)]
    return Recording(views=np.zeros((4000, 1, 1, 3), np.uint8), times=np.arange(4000.0), poses=poses)


def place(poses: np.ndarray, turn: float) -> np.ndarray:
    way = np.array([(np.cos(turn), np.sin(turn)), (-np.sin(turn), np.cos(turn))])
    return np.exp(-((poses[:, None, :2] - CENTRES @ way) ** 2).sum(axis=2) / 0.18)


def heading(poses: np.ndarray, turn: float) -> np.ndarray:
    return np.exp(2 * np.cos(poses[:, 2:] - DIRECTIONS - turn))


def test_maps_turn_counter_clockwise() -> None:
    xy = walk(0).require("poses")[:, :2]
    around = xy @ np.array([[0, 1], [-1, 0]])
    rates = np.exp(-(((xy - [1.0, 0.3]) / 0.3) ** 2).sum(axis=1, keepdims=True))
    expected = rate_maps(rates, around)
    np.testing.assert_allclose(turned(rate_maps(rates, xy), 1).rates, expected.rates, atol=1e-6)


@pytest.mark.parametrize(("turn", "follow"), [(np.pi / 2, 1.0), (0.0, 0.0), (-np.pi / 2, 0.0)])
def test_what_turns_follows_sight(turn: float, follow: float) -> None:
    walks = walk(1), walk(2)
    before, after = (item.require("poses") for item in walks)
    cells = CueControl.of((place(before, 0), place(after, turn)), walks, 1.5)
    compass = CueControl.of((heading(before, 0), heading(after, turn)), walks, 1.5)
    np.testing.assert_allclose(compass.shift_deg, np.rad2deg(turn), atol=3)
    assert compass.directions_follow_sight == follow
    sight, smells = cells.median_correlations
    if turn >= 0:
        assert cells.maps_follow_sight == follow
        assert (sight > 0.95) == (follow == 1)
        assert (smells > 0.95) == (follow == 0)


def test_silent_cells_follow_nothing() -> None:
    walks = walk(1), walk(2)
    silent = np.full((4000, 2), np.nan)
    found = CueControl.of((silent, silent), walks, 1.5)
    assert np.isnan(found.shift_deg).all()
    assert found.maps_follow_sight == found.directions_follow_sight == 0
