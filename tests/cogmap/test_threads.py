import pytest
import torch
from threadpoolctl import threadpool_info

from cogmap.threads import one_thread


def test_one_thread_inside_and_what_was_before_outside() -> None:
    torch.set_num_threads(2)
    with pytest.raises(RuntimeError, match="stop"), one_thread():
        assert torch.get_num_threads() == 1
        assert all(pool["num_threads"] == 1 for pool in threadpool_info())
        assert not torch.is_grad_enabled()
        raise RuntimeError("stop")
    assert torch.get_num_threads() == 2
    assert torch.is_grad_enabled()
