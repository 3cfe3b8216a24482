"""The command line: `cogmap --help`."""

from __future__ import annotations

import sys
import warnings
from typing import TextIO

import cyclopts

from arena import ArenaError
from cogmap.commands import app
from cogmap.errors import CogmapError
from neurons.errors import NeuronsError


def main() -> None:
    """Run a command; bad input gets one sentence on stderr and exit status 2."""
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _say
            app(sys.argv[1:], exit_on_error=False, print_error=False)
    except (ArenaError, NeuronsError, CogmapError, cyclopts.CycloptsError) as error:
        sentence = " ".join(str(error).split())
        sys.stderr.write(f"cogmap: {sentence}\n")
        raise SystemExit(2) from None
    except KeyboardInterrupt:
        raise SystemExit(130) from None


def _say(  # noqa: PLR0917  the arguments that Python's own has
    message: Warning | str,
    category: type[Warning],  # noqa: ARG001
    filename: str,  # noqa: ARG001
    lineno: int,  # noqa: ARG001
    file: TextIO | None = None,  # noqa: ARG001
    line: str | None = None,  # noqa: ARG001
) -> None:
    """Show a warning as the commands show what is wrong: one sentence."""
    sys.stderr.write(f"cogmap: {message}\n")
