"""Other x86-64 processors, simulated by what the libraries are told of this one."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import llvmlite.binding as llvm
import numpy as np

PROCESSORS: dict[str, dict[str, str]] = {
    "avx512": {
        "MKL_ENABLE_INSTRUCTIONS": "AVX512",
        "ATEN_CPU_CAPABILITY": "avx512",
        "OPENBLAS_CORETYPE": "SkylakeX",
    },
    "avx2": {
        "MKL_ENABLE_INSTRUCTIONS": "AVX2",
        "ATEN_CPU_CAPABILITY": "avx2",
        "OPENBLAS_CORETYPE": "Haswell",
        "NUMBA_CPU_NAME": "haswell",
        "NUMBA_CPU_FEATURES": "+sse4.2,+avx,+avx2,+fma,+bmi,+bmi2,+f16c,+popcnt",
    },
    "sse4": {
        "MKL_ENABLE_INSTRUCTIONS": "SSE4_2",
        "ATEN_CPU_CAPABILITY": "default",
        "OPENBLAS_CORETYPE": "Nehalem",
        "NUMBA_CPU_NAME": "generic",
    },
}
"""Named by the widest instructions that they have."""
_WITHOUT = {"avx2": ("AVX512", "X86_V4"), "sse4": ("AVX", "FMA", "F16C", "X86_V3", "X86_V4")}
"""Of numpy's instruction sets, by how their names begin."""
_NEEDS = {"avx512": "avx512bw", "avx2": "avx2", "sse4": "sse4.2"}
_INTEL = "int mkl_serv_intel_cpu_true(void) { return 1; }\n"
"""MKL heeds `MKL_ENABLE_INSTRUCTIONS` on what it takes for an Intel processor only."""


def processor(name: str, folder: Path) -> dict[str, str] | None:
    """Give the environment of a simulated processor, None where this one lacks its instructions.

    On a processor of another maker, and with a C compiler at hand, MKL is made to take it for Intel's.
    """
    if not llvm.get_host_cpu_features().get(_NEEDS[name]):
        return None
    told = dict(PROCESSORS[name])
    if name in _WITHOUT:
        found = np.show_config(mode="dicts")["SIMD Extensions"].get("found", [])
        told["NPY_DISABLE_CPU_FEATURES"] = " ".join(one for one in found if one.startswith(_WITHOUT[name]))
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler and "GenuineIntel" not in Path("/proc/cpuinfo").read_text("utf-8"):
        folder.mkdir(parents=True, exist_ok=True)
        source, library = folder / "intel.c", folder / "intel.so"
        source.write_text(_INTEL, encoding="utf-8")
        subprocess.run([compiler, "-shared", "-fPIC", "-o", library, source], check=True)
        told["LD_PRELOAD"] = str(library)
    return os.environ | told
