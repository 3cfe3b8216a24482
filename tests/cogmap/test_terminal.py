import errno
import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

from cogmap.terminal import CLOSED_PIPE, spell_out, what_failed

ROOT = Path(__file__).parents[2]
SCRIPT = """
from cogmap import cli
cli.app = lambda *_, **__: print("many lines\\n" * 10_000)
cli.app.help_flags = ()
cli.main()
"""
MANY = [sys.executable, "-c", SCRIPT, "a command"]


@pytest.mark.parametrize(
    ("encoding", "wanted"),
    [("ascii", "15x90, 3 deg, a -> b, -pi, Svestka, ?"), ("cp1252", "15×90, 3°, a -> b, -pi, Švestka, ?"),
     ("utf-8", "15×90, 3°, a → b, −π, Švestka, 象")],
)  # fmt: skip
def test_what_an_encoding_lacks_is_spelt_out(
    monkeypatch: pytest.MonkeyPatch, encoding: str, wanted: str
) -> None:
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding=encoding))
    spell_out()
    sys.stdout.write("15×90, 3°, a → b, −π, Švestka, 象")
    sys.stdout.flush()
    assert raw.getvalue().decode(encoding) == wanted


def test_streams_that_are_none_are_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdout", None)
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    spell_out()


def test_a_closed_pipe_ends_a_command_in_silence() -> None:
    reads, writes = os.pipe()
    os.close(reads)
    done = subprocess.run(MANY, cwd=ROOT, stdout=writes, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writes)
    assert (done.returncode, done.stderr) == (CLOSED_PIPE, "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device here")
def test_a_full_device_is_told_in_one_sentence() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(MANY, cwd=ROOT, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr == f"cogmap: cannot write what is printed: {os.strerror(errno.ENOSPC)}\n"


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (OSError(errno.EACCES, "Permission denied", "/srv/map"), "cannot use /srv/map: Permission denied"),
        (OSError(errno.ENOSPC, "No space left"), "cannot write what is printed: No space left"),
        (OSError("odd"), "the system refuses: odd"),
    ],
)
def test_what_the_system_refuses_is_told(error: OSError, said: str) -> None:
    assert what_failed(error) == said
