"""Portable arithmetic: the same arrays on every x86-64 processor with AVX2.

MKL, OpenBLAS, ATen, numpy, OpenCV and numba each choose instructions by the processor they find, and so sum
in another order on another one. `cogmap portable COMMAND` runs a command with all of them held to what every
such processor has. They choose when they are loaded, so it cannot be done later than that.
"""

import hashlib
import platform
from functools import cache

import llvmlite.binding as llvm
import numpy as np
from numpy.typing import ArrayLike

from cogmap.errors import CogmapError

PINNED = {
    # On processors of other makers than Intel, MKL knows no other branch that is the same everywhere.
    "MKL_CBWR": "COMPATIBLE",
    "ATEN_CPU_CAPABILITY": "avx2",
    "ONEDNN_MAX_CPU_ISA": "AVX2",
    "OPENBLAS_CORETYPE": "Haswell",
    "NUMBA_CPU_NAME": "x86-64-v3",
    "NUMBA_CPU_FEATURES": "",
}
"""What every library is told, whatever the processor."""


def portable_environment() -> dict[str, str]:
    """Give the environment variables that hold all libraries to the instructions of x86-64 with AVX2.

    Raises
    ------
    CogmapError
        On a processor that lacks these.
    """
    found = llvm.get_host_cpu_features()
    if platform.machine() not in {"x86_64", "AMD64"} or not (found.get("avx2") and found.get("fma")):
        raise CogmapError(
            "portable arithmetic needs an x86-64 processor with AVX2 and FMA, and this is "
            f"{platform.machine()}, {llvm.get_host_cpu_name()}; run the command without `cogmap portable`"
        )
    known = np.show_config(mode="dicts")["SIMD Extensions"]  # of this processor and of others
    names = [*known.get("found", []), *known.get("not found", [])]
    wider = [name for name in names if name.startswith(("AVX512", "X86_V4"))]
    held = {"NPY_DISABLE_CPU_FEATURES": " ".join(wider)}
    if found.get("avx512bw"):  # OpenCV complains of being told so elsewhere
        held["OPENCV_CPU_DISABLE"] = "AVX512-SKX"
    return PINNED | held


@cache
def arithmetic() -> str:
    """Fingerprint how this process calculates: eight digits of what comes of what learning rests on.

    Where it differs, maps and what is measured on them differ by rounding; where it is the same, they are
    equal to the bit.
    """
    # Here, so that `cogmap portable` does not load what the command that it runs loads anew.
    import scipy.linalg  # noqa: PLC0415
    import torch  # noqa: PLC0415

    from cogmap.threads import one_thread  # noqa: PLC0415

    rng = np.random.default_rng(0)
    a, b = rng.standard_normal((64, 1350)), rng.standard_normal((1350, 60))
    x, y = torch.from_numpy(a).float(), torch.from_numpy(b).float()
    with one_thread():
        product = x @ y
        covariance = (product.T @ product).double()
        results: list[ArrayLike] = [
            product,
            torch.addmm(y[0], product, y[:60].T, alpha=-2.0),
            torch.einsum("dnc,nc->nd", y[:960].view(3, 320, 60), y[:320]),
            torch.linalg.qr(y[:360].view(120, 3, 60).mT).Q,
            torch.linalg.eigh(covariance).eigenvectors,
            torch.linalg.solve(covariance, y[:60].double()),
            torch.atan2(x.sin(), x.cos()),
            x.exp() + x.square().mean(dim=1, keepdim=True).sqrt(),
            a @ b,
            np.exp(a),
            np.arctan2(a, a[::-1]),
            scipy.linalg.eigh(covariance.numpy(), eigvals_only=True),
        ]
    return hashlib.sha256(b"".join(np.asarray(result).tobytes() for result in results)).hexdigest()[:8]
