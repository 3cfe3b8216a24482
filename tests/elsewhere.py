"""A device that is not there: what is said to lie on it lies on the processor, and mixing the two is refused.

It finds what a real one would refuse, on machines that have none.
"""

from collections.abc import Iterator
from functools import cache, partial
from typing import Any

import torch
from torch import Tensor
from torch.overrides import TorchFunctionMode, resolve_name
from torch.utils._pytree import tree_map_only

ELSEWHERE = torch.device("cuda", 0)
_MOVES = {"torch.Tensor.to", "torch.Tensor.cpu", "torch.Tensor.copy_", "torch.Tensor.new_tensor"}


def is_elsewhere(tensor: Tensor) -> bool:
    """Whether a tensor is said to lie on the device."""
    return getattr(tensor, "elsewhere", False)


class Elsewhere(TorchFunctionMode):
    """Lets `ELSEWHERE` be named as a device; counts what ran there."""

    ran = 0

    def __torch_function__(self, func: Any, types: Any, args: Any = (), kwargs: Any = None) -> Any:
        """Run a function, and mark what comes of it."""
        kwargs, name = dict(kwargs or {}), _name_of(func)
        tensors = list(_tensors((args, kwargs)))
        if name == "torch.Tensor.device.__get__":
            return ELSEWHERE if is_elsewhere(tensors[0]) else func(*args)
        _check_together(name, tensors)
        there = any(map(is_elsewhere, tensors[:1] if name in _MOVES else tensors))
        self.ran += there
        if name == "torch.Tensor.cpu":
            there = False
        elif name == "torch.Tensor.to":
            for goal in args[1:]:
                if isinstance(goal, torch.device | str | Tensor):
                    there = is_elsewhere(goal) if isinstance(goal, Tensor) else _names(goal)
            args = [_here(leaf) for leaf in args]
        elif kwargs.get("device") is not None:
            there, kwargs["device"] = _names(kwargs["device"]), "cpu"
        found = func(*args, **kwargs)
        if isinstance(found, Tensor):
            return _marked(there, tensors, found)
        if isinstance(found, torch.Size | bool | int | float):
            return found
        return tree_map_only(Tensor, partial(_marked, there, tensors), found)


@cache
def _name_of(func: Any) -> str:
    return resolve_name(func) or func.__name__


def _tensors(given: Any) -> Iterator[Tensor]:
    """Find all tensors in nested arguments."""
    if isinstance(given, Tensor):
        yield given
    elif isinstance(given, tuple | list | dict):
        for part in given.values() if isinstance(given, dict) else given:
            yield from _tensors(part)


def _names(device: torch.device | str) -> bool:
    return torch.device(device).type == ELSEWHERE.type


def _here(goal: Any) -> Any:
    """Give the processor for the device that is not there."""
    return torch.device("cpu") if isinstance(goal, torch.device | str) else goal


def _check_together(name: str, tensors: list[Tensor]) -> None:
    """Refuse what a device would; a single number of the processor may meet any tensor."""
    if name in _MOVES:
        return
    if len({is_elsewhere(tensor) for tensor in tensors if tensor.dim() or is_elsewhere(tensor)}) > 1:
        raise RuntimeError(f"{name} is given tensors of two devices")
    if name in {"torch.Tensor.numpy", "torch.Tensor.__array__"} and is_elsewhere(tensors[0]):
        raise TypeError("a tensor of another device is no array")


def _marked(there: bool, given: list[Tensor], tensor: Tensor) -> Tensor:  # noqa: FBT001
    """Say where a tensor lies; what was given stays where it is, though the memory be the same."""
    if is_elsewhere(tensor) == there:
        return tensor
    found = tensor.view_as(tensor) if any(tensor is other for other in given) else tensor
    found.elsewhere = there  # type: ignore[attr-defined]
    return found
