import numpy as np

from cogmap.imagination.alignment import aligned, coarse


def test_a_changed_part_does_not_move_the_pose() -> None:
    rng = np.random.default_rng(0)
    base, slopes = rng.normal(100, 20, 600), rng.normal(size=(600, 3))

    def paint(poses: np.ndarray) -> np.ndarray:
        return (base + poses @ slopes.T).astype(np.float32)

    true = rng.normal(size=(4, 3))
    seen = paint(true) + rng.normal(0, 0.01, (4, 600)).astype(np.float32)
    seen[:, :60] += 80
    found = aligned(seen, np.zeros((4, 3)), paint, paint, np.ones(3))
    np.testing.assert_allclose(found, true, atol=0.02)


def test_a_step_that_makes_it_worse_is_taken_back() -> None:
    seen = np.full((1, 30), 5.0, np.float32)

    def fine(poses: np.ndarray) -> np.ndarray:
        return np.abs(np.tile(poses[:, :1], (1, 30))).astype(np.float32)

    def misleading(poses: np.ndarray) -> np.ndarray:
        return -np.tile(poses[:, :1], (1, 30)).astype(np.float32)

    start = np.array([[1.0, 0.0, 0.0]])
    reach = np.full(3, 0.3)
    np.testing.assert_array_equal(aligned(seen, start, fine, misleading, reach), start)


def test_coarse_views_have_ninety_columns_at_most() -> None:
    assert coarse(np.zeros((60, 360, 3), np.uint8)).shape == (15 * 90 * 3,)
    assert coarse(np.zeros((15, 60, 3), np.uint8)).shape == (15 * 60 * 3,)
