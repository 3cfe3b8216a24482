import numpy as np
import pytest

from cogmap import Activity


def activity(views: int, *, refined: bool) -> Activity:
    rows = np.arange(views, dtype=np.float32)
    columns = np.stack([rows, rows], axis=1)
    plain = Activity(columns, columns, rows, columns, columns)
    return plain if not refined else Activity(columns, columns, -rows, columns, -columns, plain, rows)


@pytest.mark.parametrize("views", [slice(2, 4), np.array([2, 3]), np.arange(6) // 2 == 1])
def test_some_of_the_views_are_taken_with_all_that_is_said_of_them(views) -> None:
    some = activity(6, refined=True)[views]
    assert len(some) == 2
    np.testing.assert_array_equal(some.phase, [-2, -3])
    np.testing.assert_array_equal(some.novelty, [2, 3])
    np.testing.assert_array_equal(some.plain.phase, [2, 3])
    np.testing.assert_array_equal(some.plain.position, [[2, 2], [3, 3]])


def test_what_charts_alone_tell_has_nothing_finer() -> None:
    some = activity(6, refined=False)[:2]
    assert some.plain is None
    assert some.novelty is None
