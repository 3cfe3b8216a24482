import numpy as np

from cogmap.experiments.paper.brownian import _read_poses


def test_poses_are_the_means_of_the_ten_nearest_by_distance() -> None:
    rng = np.random.default_rng(0)
    known, held = rng.normal(size=(50, 4)), rng.normal(size=(3, 4))
    poses = np.column_stack([rng.normal(size=(50, 2)), rng.uniform(-np.pi, np.pi, 50)])
    found = _read_poses(known, poses, held)
    for row, (position, heading) in enumerate(zip(found[:, :2], found[:, 2], strict=True)):
        apart = np.linalg.norm(known - held[row], axis=1)
        nearest = np.argsort(apart)[:10]
        weights = 1 / apart[nearest]
        np.testing.assert_allclose(position, weights @ poses[nearest, :2] / weights.sum())
        np.testing.assert_allclose(heading, np.angle(weights @ np.exp(1j * poses[nearest, 2])))


def test_headings_are_read_across_the_cut() -> None:
    ring = np.linspace(-np.pi, np.pi, 200, endpoint=False)
    known = np.column_stack([np.cos(ring), np.sin(ring)])
    poses = np.column_stack([np.zeros((200, 2)), ring])
    asked = np.array([np.pi - 0.01, 0.01 - np.pi, 0.7])
    found = _read_poses(known, poses, np.column_stack([np.cos(asked), np.sin(asked)]))
    np.testing.assert_allclose(np.angle(np.exp(1j * (found[:, 2] - asked))), 0, atol=0.02)


def test_known_views_have_their_own_pose() -> None:
    rng = np.random.default_rng(1)
    known, poses = rng.normal(size=(30, 4)), rng.uniform(-1, 1, (30, 3))
    found = _read_poses(known, poses, known)
    np.testing.assert_allclose(found, poses)
