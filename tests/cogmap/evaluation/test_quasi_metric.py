import numpy as np
import scipy.sparse as sp

from cogmap.evaluation.quasi_metric import quasi_metric
from cogmap.graph import neighbour_graph


def grid(stretch: float) -> tuple[sp.csr_array, np.ndarray]:
    """Poses on a floor without turns, and the graph of what they see: twice as much per metre right of 0."""
    rng = np.random.default_rng(0)
    xy = rng.uniform(-1, 1, (1500, 2))
    seen = xy * np.where(xy[:, :1] > 0, stretch, 1.0)
    return neighbour_graph(seen, 8), np.column_stack([xy, np.zeros(1500)])


def test_where_images_are_metres_nothing_is_distorted() -> None:
    found = quasi_metric(*grid(1.0))
    assert found.metrics["geodesic_rank_correlation"] > 0.98
    assert found.metrics["joined_pairs"] > 0.999
    assert 0.85 < found.metrics["distortion_p5"] <= found.metrics["distortion_p95"] < 1.2
    assert set(found.pairs) == {"source", "target", "motion_m", "geodesic"}


def test_distortion_tells_the_place_where_views_change_faster() -> None:
    graph, poses = grid(3.0)
    places = quasi_metric(graph, poses).places
    right, left = (places.loc[side, "distortion"].median() for side in (places.x_m > 0.3, places.x_m < -0.3))
    assert right > 1.3 * left


def test_distances_between_pieces_do_not_count() -> None:
    graph, poses = grid(1.0)
    pieces = sp.csr_array(sp.block_diag([graph, graph]))
    found = quasi_metric(pieces, np.concatenate([poses, poses]))
    assert 0.4 < found.metrics["joined_pairs"] < 0.6
    assert np.isfinite(found.pairs.to_numpy()).all()


def test_so_many_pairs_are_drawn() -> None:
    found = quasi_metric(*grid(1.0), sources=20, targets=30)
    assert len(found.places) == found.pairs["source"].nunique() == 20
    assert found.pairs["target"].nunique() == 30


def test_the_same_seed_draws_the_same_pairs() -> None:
    one, same, other = (quasi_metric(*grid(1.0), seed=seed).pairs for seed in (1, 1, 2))
    assert one.equals(same)
    assert not one.equals(other)
