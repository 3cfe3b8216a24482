import numpy as np
from numba import njit

from arena.eye.simd import add_three


@njit
def added(items: np.ndarray, first: int, weights: tuple, out: np.ndarray, item: int) -> None:
    add_three(items, first, weights[0], weights[1], weights[2], out, item)


def test_three_items_are_added_to_one_and_no_other() -> None:
    rng = np.random.default_rng(0)
    items, out = (rng.standard_normal((9, 4)).astype(np.float32) for _ in range(2))
    weights = np.float32(0.3), np.float32(-1.5), np.float32(2.0)
    for first, item in ((0, 8), (6, 0), (3, 5)):
        wanted = out.copy()
        wanted[item] += np.array(weights) @ items[first : first + 3]
        added(items.ravel(), first, weights, out.reshape(-1), item)
        np.testing.assert_allclose(out, wanted, rtol=1e-5, atol=1e-6)
