import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.evaluation.pose_agreement import pose_agreement


def test_agreement_of_the_truth_is_perfect() -> None:
    rng = np.random.default_rng(3)
    poses = np.column_stack([rng.uniform(-2, 2, size=(200, 2)), rng.uniform(-np.pi, np.pi, 200)])
    queries = poses[:50] + np.array([0.01, 0, 0.02])
    offset = queries[:, None] - poses
    offset[..., 2] = (offset[..., 2] + np.pi) % (2 * np.pi) - np.pi
    truth = np.sqrt(offset[..., 0] ** 2 + offset[..., 1] ** 2 + (0.5 * offset[..., 2]) ** 2)
    found = pose_agreement(truth, queries, poses, neighbours=1)
    assert found.recall == 1
    assert found.position_median_m == pytest.approx(0.01)
    assert found.heading_median_deg == pytest.approx(np.rad2deg(0.02))
    chance = pose_agreement(rng.uniform(size=truth.shape), queries, poses)
    assert chance.recall == pytest.approx(10 / 200, abs=0.03)
    assert chance.position_median_m > 1
    assert 60 < chance.heading_median_deg < 120


def test_bad_truth_gets_one_sentence() -> None:
    distances, poses = np.ones((3, 8)), np.zeros((8, 3))
    with pytest.raises(CogmapError, match="8 views are too few for 9"):
        pose_agreement(distances, poses[:3], poses, neighbours=9)
    with pytest.raises(CogmapError, match="query_poses is not finite"):
        pose_agreement(distances, np.full((3, 3), np.nan), poses)
    with pytest.raises(CogmapError, match="distances is not finite"):
        pose_agreement(distances * np.inf, poses[:3], poses)
