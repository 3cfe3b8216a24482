"""Printing to whatever there is: terminals that know few characters, closed pipes, full disks."""

import codecs
import errno
import os
import sys
import unicodedata
from contextlib import suppress
from typing import TextIO

CLOSED_PIPE = 128 + 13
"""Exit status of who wrote to a pipe that nobody reads any more, as shells tell it (SIGPIPE)."""
_SPELT_OUT = {
    "×": "x", "°": " deg", "→": "->", "←": "<-", "−": "-", "–": "-", "—": "-", "…": "...", "≤": "<=",
    "≥": ">=", "±": "+-", "·": "*", "π": "pi", "λ": "lambda", "θ": "theta", "σ": "sigma", "μ": "mu",
    "‘": "'", "’": "'", "“": '"', "”": '"',
}  # fmt: skip
"""What stands for characters that an encoding lacks; accents are left out, the rest is a question mark."""


def spell_out() -> None:
    """Let both streams spell out what their encoding lacks, as cp1252 lacks → and ASCII lacks ×."""
    codecs.register_error("cogmap.spelt_out", _spelt_out)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="cogmap.spelt_out")


def flush() -> None:
    """Write what is left, so that what goes wrong with it goes wrong now."""
    if sys.stdout is not None:
        sys.stdout.flush()


def give_up_printing(stream: TextIO) -> None:
    """Let go what a stream could not write; else Python tries again when it ends, and complains."""
    with suppress(OSError, ValueError):  # a stream that is no file
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)


def what_failed(error: OSError) -> str:
    """Say in one sentence what the system refused."""
    reason = error.strerror or str(error)
    if error.filename is not None:
        return f"cannot use {error.filename}: {reason}"
    if error.errno in {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO}:
        return f"cannot write what is printed: {reason}"
    return f"the system refuses: {reason}"


def _spelt_out(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_plain, error.object[error.start : error.end])), error.end


def _plain(character: str) -> str:
    bare = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    return _SPELT_OUT.get(character) or bare or "?"
