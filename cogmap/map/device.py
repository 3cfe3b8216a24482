"""The device that a map learns and perceives on."""

import os

import torch

from cogmap.errors import CogmapError


def checked_device(name: str) -> torch.device:
    """Return a device that is there and knows double precision, or say which are."""
    if name != "cpu":
        # without it products are not the same every time on NVIDIA's devices; read when the first is taken
        os.environ.setdefault("CUBLAS_WORKSPACE_CONFIG", ":4096:8")
    if not _works(name):
        kind = torch.accelerator.current_accelerator()
        others = [f"{kind}:{number}" for number in range(torch.accelerator.device_count())]
        there = ", ".join(["cpu", *filter(_works, others)])
        raise CogmapError(f"device is {name!r}; give one that is there and knows double precision: {there}")
    return torch.device(name)


def _works(name: str) -> bool:
    try:
        torch.zeros(1, dtype=torch.double, device=name).cpu()
    except (RuntimeError, TypeError, AssertionError, ImportError):
        return False
    return True
