import numpy as np

from arena import Arena, Camera, Wall
from cogmap.evaluation.pose_agreement import motion_distances
from cogmap.experiments.paper.distinguishability import ROOMS, opposite, pose_distances, retina_codes

CAMERA = Camera.panoramic()
POSES = np.array([[1.2, 0.4, 0.3], [-0.5, 0.7, 2.0], [0.1, -0.9, -3.0]])


def test_opposite_poses_look_the_same_in_white_only() -> None:
    white, blue = (Arena.load(ROOMS[name]) for name in ("white", "blue_wall"))
    far = opposite(white, POSES)
    own, other = CAMERA.render(white, POSES).astype(float), CAMERA.render(white, far)
    assert np.abs(own - other).mean() < 0.01
    assert np.abs(CAMERA.render(blue, POSES).astype(float) - CAMERA.render(blue, far)).mean() > 1
    np.testing.assert_allclose(opposite(white, far) - POSES, np.tile([0, 0, 2 * np.pi], (3, 1)))


def test_half_a_turn_is_about_the_middle_of_the_room() -> None:
    corner = Arena.create(
        name="corner",
        platform=[[(0, 0), (2, 0), (2, 4), (0, 4)]],
        walls=[Wall(start=(0, 0), end=(2, 0), material="brick")],
    )
    found = opposite(corner, np.array([[0.5, 1, 0.2], [2, 4, -1]]))
    np.testing.assert_allclose(found, [[1.5, 3, np.pi + 0.2], [0, 0, np.pi - 1]])


def test_poses_of_the_same_row_are_compared() -> None:
    theirs = POSES[::-1] + np.array([0.1, 0.2, 3.0])
    np.testing.assert_allclose(pose_distances(POSES, theirs), np.diag(motion_distances(POSES, theirs)))


def test_codes_are_principal_components_of_known_strips() -> None:
    room, rng = Arena.load("blue_wall"), np.random.default_rng(0)
    poses = np.column_stack([room.sample_free(80, 0.18, rng), rng.uniform(-np.pi, np.pi, 80)])
    views = CAMERA.render(room, poses)
    known, asked = retina_codes(views, views[5:9], 0)
    assert known.shape == (80, 60)
    np.testing.assert_allclose(asked, known[5:9], atol=1e-4)
    np.testing.assert_allclose(known.mean(axis=0), 0, atol=1e-4)
    products = known.T @ known
    spread = np.diag(products)
    assert (np.diff(spread) <= 0).all()
    np.testing.assert_allclose(products, np.diag(spread), atol=1e-4 * spread[0])
