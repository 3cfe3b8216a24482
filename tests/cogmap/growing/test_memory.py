import numpy as np

from cogmap.growing.expedition import Share
from cogmap.growing.memory import Memory, picked

SHARES = [Share(0, 1, slice(0, 3)), Share(1, 2, slice(3, 5))]


def test_shares_are_kept_where_they_belong_in_whatever_order_they_come() -> None:
    memory = Memory(SHARES)
    assert memory.lacks("codes") == [0, 1]
    memory.put("codes", 1, (np.array([[4.0], [5.0]]), np.array([40, 50], np.int32)))
    assert memory.lacks("codes") == [0]
    memory.put("codes", 0, (np.array([[1.0], [2.0], [3.0]]), np.array([10, 20, 30], np.int32)))
    assert memory.lacks("codes") == []
    numbers, tens = memory.take("codes", np.array([4, 0]))
    assert numbers.tolist() == [[5.0], [1.0]]
    assert tens.tolist() == [50, 10]
    assert tens.dtype == np.int32
    assert memory.take("codes", slice(2, 4))[1].tolist() == [30, 40]
    memory.forget("codes")
    assert memory.lacks("codes") == [0, 1]


def test_each_view_is_picked_once_before_any_comes_again() -> None:
    whole = picked(10, 0, 30, (3, 1))
    for again in range(3):
        assert sorted(whole[10 * again : 10 * again + 10]) == list(range(10))
    assert whole[:10].tolist() != whole[10:20].tolist() != list(range(10))
    parts = [picked(10, first, 7, (3, 1)) for first in (0, 7, 14)]
    assert np.concatenate(parts).tolist() == whole[:21].tolist()
    assert picked(10, 0, 10, (3, 2)).tolist() != whole[:10].tolist()
