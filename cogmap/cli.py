"""The command line: `cogmap --help`."""

import sys
import warnings

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
        _say(" ".join(str(error).split()))
        raise SystemExit(2) from None
    except KeyboardInterrupt:
        raise SystemExit(130) from None


def _say(message: Warning | str, *_: object, **__: object) -> None:
    """Show what is wrong, or a warning with what Python tells of it, as one sentence."""
    sys.stderr.write(f"cogmap: {message}\n")
