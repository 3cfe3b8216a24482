"""The command line: `cogmap --help`."""

from __future__ import annotations

import sys

import cyclopts

from arena import ArenaError
from cogmap.commands import app
from cogmap.errors import CogmapError
from neurons.errors import NeuronsError


def main() -> None:
    """Run a command; bad input gets one sentence on stderr and exit status 2."""
    try:
        app(sys.argv[1:], exit_on_error=False, print_error=False)
    except (ArenaError, NeuronsError, CogmapError, cyclopts.CycloptsError) as error:
        sentence = " ".join(str(error).split())
        sys.stderr.write(f"cogmap: {sentence}\n")
        raise SystemExit(2) from None
    except KeyboardInterrupt:
        raise SystemExit(130) from None
