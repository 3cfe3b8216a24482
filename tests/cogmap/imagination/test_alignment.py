import numpy as np

from cogmap.imagination.alignment import Seen, aligned, coarse


def as_seen(coarse: np.ndarray) -> Seen:
    return Seen(coarse, coarse[:, None])


def test_a_changed_part_does_not_move_the_pose() -> None:
    rng = np.random.default_rng(0)
    base, slopes = rng.normal(100, 20, 600), rng.normal(size=(600, 3))

    def paint(poses: np.ndarray) -> np.ndarray:
        return (base + poses @ slopes.T).astype(np.float32)

    true = rng.normal(size=(4, 3))
    seen = paint(true) + rng.normal(0, 0.01, (4, 600)).astype(np.float32)
    seen[:, :60] += 80
    start = np.zeros((4, 3))
    found, there = aligned(
        seen,
        start,
        as_seen(paint(start)),
        fine=lambda poses: as_seen(paint(poses)),
        quick=paint,
        reach=np.ones(3),
    )
    np.testing.assert_allclose(found, true, atol=0.02)
    np.testing.assert_array_equal(there.coarse, paint(found))
    np.testing.assert_array_equal(there.unusual[:, 0], there.coarse)


def test_a_step_that_makes_it_worse_is_taken_back() -> None:
    seen = np.full((1, 30), 5.0, np.float32)

    def fine(poses: np.ndarray) -> Seen:
        return as_seen(np.abs(np.tile(poses[:, :1], (1, 30))).astype(np.float32))

    def misleading(poses: np.ndarray) -> np.ndarray:
        return -np.tile(poses[:, :1], (1, 30)).astype(np.float32)

    start = np.array([[1.0, 0.0, 0.0]])
    reach = np.full(3, 0.3)
    found, there = aligned(seen, start, fine(start), fine=fine, quick=misleading, reach=reach)
    np.testing.assert_array_equal(found, start)
    np.testing.assert_array_equal(there.unusual, fine(start).unusual)


def test_coarse_views_have_ninety_columns_at_most() -> None:
    assert coarse(np.zeros((60, 360, 3), np.uint8)).shape == (15 * 90 * 3,)
    assert coarse(np.zeros((15, 60, 3), np.uint8)).shape == (15 * 60 * 3,)
