import numpy as np
import pytest
import scipy.sparse as sp

from arena import Arena, Brownian, Disc
from arena.angles import wrap_angle
from cogmap.graph.affine_weights import affine_weights
from cogmap.graph.knn import nearest_points
from cogmap.map import pose_graph
from cogmap.map.pose_graph import PoseGraph, relax_walk

VIEWS, NEIGHBOURS = 800, 60


@pytest.fixture(scope="module")
def poses() -> np.ndarray:
    walk = Brownian().walk(Arena.load("open_field"), Disc(), VIEWS, np.random.default_rng(0))
    return walk.poses


def affine(poses: np.ndarray) -> sp.csr_array:
    """What makes up each place from those near it."""
    near = nearest_points(poses[:, :2], NEIGHBOURS).indices
    weights = affine_weights(poses[:, :2], near, poses[:, :2], 1e-3)
    rows = np.repeat(np.arange(len(near)), NEIGHBOURS)
    return sp.csr_array((weights.ravel(), (rows, near.ravel())), shape=(len(near),) * 2)


def bent(poses: np.ndarray) -> PoseGraph:
    """As a conformal map bends them: steps still lead where the body looks."""
    places = poses[:, 0] + 1j * poses[:, 1]
    return PoseGraph(places + 0.05 * places**2, wrap_angle(poses[:, 2] + np.angle(1 + 0.1 * places)))


def errors(found: PoseGraph, poses: np.ndarray) -> tuple[float, float]:
    """Medians of place (m) and heading (rad), after the best similarity."""
    places = poses[:, 0] + 1j * poses[:, 1]
    basis = np.column_stack([found.places, np.ones(len(places))])
    (scale, shift), *_ = np.linalg.lstsq(basis, places, rcond=None)
    wrong = np.angle(np.exp(1j * (found.headings - poses[:, 2])) * scale)
    return float(np.median(np.abs(basis @ [scale, shift] - places))), float(np.median(np.abs(wrong)))


def test_a_bent_map_is_straightened(poses: np.ndarray) -> None:
    start, weights = bent(poses), affine(poses)
    before, after = errors(start, poses), errors(relax_walk(start, weights), poses)
    assert before[0] > 0.03
    assert before[1] > 0.03
    assert after[0] < 0.1 * before[0]
    assert after[1] < 0.1 * before[1]


def test_shuffled_views_are_left_alone(poses: np.ndarray) -> None:
    shuffled = poses[np.random.default_rng(1).permutation(VIEWS)]
    start = bent(shuffled)
    assert relax_walk(start, affine(shuffled)) is start


def test_jumps_count_less(poses: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    rng, rows = np.random.default_rng(2), [np.arange(60)]
    for _ in range(12):  # each piece begins elsewhere and looks as the last one ended
        apart = np.linalg.norm(poses[:-60, :2] - poses[rows[-1][-1], :2], axis=1)
        alike = np.abs(wrap_angle(poses[:-60, 2] - poses[rows[-1][-1], 2])) < 0.1
        rows.append(rng.choice(np.flatnonzero(alike & (apart > 1))) + np.arange(60))
    pieces = poses[np.concatenate(rows)] + 0.01 * rng.standard_normal((780, 3))
    start, weights = bent(pieces), affine(pieces)
    robust = errors(relax_walk(start, weights), pieces)
    monkeypatch.setattr(pose_graph, "_cauchy", np.ones_like)
    plain = errors(relax_walk(start, weights), pieces)
    assert robust[0] < 0.3 * errors(start, pieces)[0]
    assert robust[0] < 0.5 * plain[0]
