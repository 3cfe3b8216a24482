"""Where a recording comes from: the versions and the instructions that its walk and smells may hang on."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from importlib.metadata import version

import llvmlite.binding as llvm

PACKAGES = ("numpy", "numba", "pymunk", "scipy")


def origin() -> dict[str, str]:
    """Tell what calculates here: versions of the libraries a walk stands on, and the processor's level.

    The level is that of the x86-64 psABI: v2 with SSE4.2, v3 with AVX2 and FMA, v4 with AVX-512.
    """
    found = llvm.get_host_cpu_features()
    levels = {"v2": True, "v3": found.get("avx2") and found.get("fma"), "v4": found.get("avx512bw")}
    level = next(name for name, is_there in reversed(levels.items()) if is_there)
    x86 = platform.machine() in {"x86_64", "AMD64"}
    return {
        **{package: version(package) for package in PACKAGES},
        "libc": " ".join(platform.libc_ver()).strip() or platform.system(),
        "processor": f"x86-64-{level}" if x86 else platform.machine(),
    }


def unlike(begun: Mapping[str, str]) -> str:
    """Say in what a recording's origin differs from what calculates here; empty when in nothing."""
    here = origin()
    return ", ".join(
        f"{name} {begun.get(name, 'unknown')} (here {value})"
        for name, value in here.items()
        if begun.get(name) != value
    )
