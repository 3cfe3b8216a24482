"""Commands about how commands are run."""

import os
from typing import Annotated, NoReturn

from cyclopts import Parameter

from cogmap.commands import app
from cogmap.errors import CogmapError
from cogmap.portable import portable_environment


def _portable(*command: Annotated[str, Parameter(allow_leading_hyphen=True)]) -> NoReturn:
    """Run a command so that it gives the same arrays on every x86-64 processor with AVX2.

    MKL, OpenBLAS, ATen, numpy, OpenCV and numba are held to the same instructions; learning takes 1.4 to 2
    times as long. Whatever shares in one result, as the workers of a cluster do, must be started in this way.

    Examples: `cogmap portable cogmap demo --seed 1`; `cogmap portable python analysis.py`;
    `cogmap portable dask worker tcp://10.0.0.1:8786`.

    Parameters
    ----------
    command
        What to run, with its options.
    """
    if command[:1] == ("--help",):
        app.help_print("portable")
        raise SystemExit(0)
    if not command:
        raise CogmapError("there is no command to run; for example `cogmap portable cogmap demo`")
    try:
        os.execvpe(command[0], command, os.environ | portable_environment())  # noqa: S606  no shell is wanted
    except OSError as error:
        raise CogmapError(f"cannot run {command[0]}: {error.strerror or error}") from None
