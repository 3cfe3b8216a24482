import numpy as np

from cogmap.graph.top_k import offer


def test_rankings_keep_the_best_whatever_the_axis() -> None:
    scores = np.random.default_rng(4).integers(1, 9, size=(6, 30)).astype(np.float32)
    best, names = np.zeros((6, 4), np.float32), np.full((6, 4), -1)
    offer(scores[:, :10], best, names, 100, axis=1)
    offer(scores[:, 10:], best, names, 110, axis=1)
    order = np.argsort(-scores, axis=1, kind="stable")[:, :4]
    np.testing.assert_array_equal(names, 100 + order)
    np.testing.assert_array_equal(best, np.take_along_axis(scores, order, 1))
    again, others = np.zeros((6, 4), np.float32), np.full((6, 4), -1)
    offer(scores.T, again, others, 100, axis=0)
    np.testing.assert_array_equal(others, names)
