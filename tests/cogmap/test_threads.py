import time
from concurrent.futures import ThreadPoolExecutor
from threading import get_ident

import pytest
import torch
from joblib import cpu_count
from threadpoolctl import threadpool_info

from cogmap.threads import in_order, one_thread


def test_one_thread_inside_and_what_was_before_outside() -> None:
    torch.set_num_threads(2)
    with pytest.raises(RuntimeError, match="stop"), one_thread():
        assert torch.get_num_threads() == 1
        assert all(pool["num_threads"] == 1 for pool in threadpool_info())
        assert not torch.is_grad_enabled()
        raise RuntimeError("stop")
    assert torch.get_num_threads() == 2
    assert torch.is_grad_enabled()


def test_one_thread_within_one_thread_leaves_the_outer_one_as_it_is() -> None:
    torch.set_num_threads(2)
    with one_thread():
        with one_thread():
            assert torch.get_num_threads() == 1
        assert torch.get_num_threads() == 1
        with one_thread(torch.device("cuda")):
            assert torch.are_deterministic_algorithms_enabled()
            with one_thread():
                assert torch.are_deterministic_algorithms_enabled()
        assert not torch.are_deterministic_algorithms_enabled()
        assert torch.get_num_threads() == 1
    assert torch.get_num_threads() == 2


def test_another_thread_is_told_for_itself() -> None:
    torch.set_num_threads(2)

    def elsewhere(_: int) -> int:
        torch.set_num_threads(2)
        with one_thread():
            return torch.get_num_threads()

    with one_thread(), ThreadPoolExecutor(1) as pool:
        assert list(pool.map(elsewhere, [0])) == [1]


def test_a_single_item_is_worked_on_here() -> None:
    assert list(in_order(lambda _: get_ident(), [0])) == [get_ident()]
    assert list(in_order(lambda item: item, iter([]))) == []


@pytest.mark.parametrize("device", ["cpu", "cuda"])
def test_on_another_device_nothing_is_left_to_chance(device: str) -> None:
    with one_thread(torch.device(device)):
        assert torch.are_deterministic_algorithms_enabled() == (device != "cpu")
    assert not torch.are_deterministic_algorithms_enabled()


def test_what_comes_of_items_is_in_their_order_and_never_far_ahead() -> None:
    begun: list[int] = []

    def work(item: int) -> int:
        begun.append(item)
        time.sleep(0.01 * (item % 3))
        assert torch.get_num_threads() == 1
        return item**2

    for item, square in enumerate(in_order(work, range(40))):
        assert square == item**2
        assert len(begun) <= item + 2 + cpu_count()


def test_what_fails_in_a_thread_fails_where_it_is_taken() -> None:
    found = in_order(lambda item: 1 / item, [2, 1, 0, 4])
    assert [next(found), next(found)] == [0.5, 1]
    with pytest.raises(ZeroDivisionError):
        next(found)


def test_a_thread_that_is_one_of_many_starts_no_others() -> None:
    def work(_: int) -> tuple[int, list[int]]:
        return get_ident(), list(in_order(lambda _: get_ident(), range(4)))

    for here, inner in in_order(work, range(6)):
        assert inner == [here] * 4
        assert here != get_ident()


def test_one_thread_alone_is_this_one() -> None:
    assert list(in_order(lambda _: get_ident(), range(4), 1)) == [get_ident()] * 4
