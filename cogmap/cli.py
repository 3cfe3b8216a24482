"""The command line: `cogmap --help`."""

import sys
import warnings

import cyclopts

from cogmap.commands import app
from cogmap.errors import (
    CogmapError,
    SeparatePiecesWarning,
    UnlikeArithmeticWarning,
    UntrustedMapWarning,
)
from cogmap.terminal import CLOSED_PIPE, flush, give_up_printing, spell_out, what_failed


def main() -> None:
    """Run a command; bad input, and a full disk, get one sentence on stderr and exit status 2."""
    spell_out()
    try:
        try:
            with warnings.catch_warnings():
                warnings.showwarning = _say
                for ours in (UntrustedMapWarning, SeparatePiecesWarning, UnlikeArithmeticWarning):
                    warnings.simplefilter("default", ours)  # whatever Python is told of warnings
                if not set(sys.argv[1:2]) - set(app.help_flags):
                    list(app.subapps)  # the help of all is read out of each
                app(sys.argv[1:], exit_on_error=False, print_error=False)
        finally:
            flush()
    except SystemExit:  # all is said: what bad input raises need not be asked, which loads torch
        raise
    except BrokenPipeError:
        give_up_printing(sys.stdout)
        raise SystemExit(CLOSED_PIPE) from None
    except OSError as error:
        _say(what_failed(error))
        give_up_printing(sys.stdout)
        raise SystemExit(2) from None
    except _refusals() as error:
        _say(" ".join(str(error).split()))
        raise SystemExit(2) from None
    except KeyboardInterrupt:
        raise SystemExit(130) from None


def _refusals() -> tuple[type[Exception], ...]:
    """Give what bad input raises; asked for when something is raised, so that no command waits for torch."""
    from arena.errors import ArenaError  # noqa: PLC0415
    from neurons.errors import NeuronsError  # noqa: PLC0415

    return ArenaError, NeuronsError, CogmapError, cyclopts.CycloptsError


def _say(message: Warning | str, *_: object, **__: object) -> None:
    """Show what is wrong, or a warning with what Python tells of it, as one sentence."""
    sys.stderr.write(f"cogmap: {message}\n")
