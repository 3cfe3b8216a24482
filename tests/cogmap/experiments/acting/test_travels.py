import numpy as np
import pytest

from arena import Arena, Camera, Disc
from arena.acting import Journeys
from cogmap.experiments.acting.travels import CLEAR, draw_poses, noisy, scored, summary

ROOM, BODY = Arena.load("obstacles"), Disc()


def test_poses_are_clear_of_contact() -> None:
    poses = draw_poses(ROOM, BODY.radius, 200, np.random.default_rng(0))
    assert ROOM.is_free(poses[:, :2], BODY.radius + CLEAR - 1e-9).all()
    assert np.ptp(poses[:, 2]) > 6
    assert np.abs(poses[:, 2]).max() <= np.pi


def test_journeys_are_measured() -> None:
    goals = np.array([[-1.5, -1.0, 0.0], [1.6, -1.2, 3.1], [1.5, 1.2, 0.0]])
    poses = np.zeros((4, 3, 3))
    poses[:, 0] = [[-1.5, -1.3, 0], [-1.5, -1.1, 0], [-1.5, -1.03, 0.02], [-1.5, -1.03, 0.02]]
    poses[:, 1] = [[1.2, -1.2, 3.1], [1.2, -1.25, 3.1], [1.61, -1.2, 3.1], [1.61, -1.2, -3.19]]
    poses[:, 2] = [[1.2, 1.2, 0]] * 4
    touched = np.zeros((3, 3), bool)
    touched[1, 2] = True
    gone = Journeys(0.2 * np.arange(4), poses, np.zeros((3, 3, 2)), touched, np.array([2, 3, 0]))
    table = scored(ROOM, gone, goals, BODY)
    np.testing.assert_allclose(table["position_error_m"], [0.03, 0.01, 0.3])
    np.testing.assert_allclose(table["heading_error_deg"], np.rad2deg([0.02, 6.29 - 2 * np.pi, 0]), atol=1e-6)
    np.testing.assert_allclose(table["way_m"], [0.27, 0.05 + np.hypot(0.41, 0.05), 0], atol=1e-9)
    np.testing.assert_allclose(table["shortest_m"], [0.3, 0.4, 0.3], atol=1e-6)
    assert table["seconds"].tolist() == pytest.approx([0.4, 0.6, 0.0])
    assert table["touched"].tolist() == [False, False, True]
    found = summary(table)
    assert found["within_5cm_2deg"] == pytest.approx(2 / 3)
    assert found["within_2cm_1deg"] == found["touching"] == pytest.approx(1 / 3)
    assert found["path_ratio_median"] == pytest.approx(0.9)


def test_a_noisy_eye_differs_in_nothing_else() -> None:
    camera = Camera.panoramic(90, 15)
    assert noisy(camera, 0.01).noise == 0.01
    assert noisy(camera, 0.01).model_dump() == camera.model_dump() | {"noise": 0.01}
