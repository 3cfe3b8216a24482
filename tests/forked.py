"""Commands in processes of their own, forked from one that has imported all they need.

A process that imports torch, pandas and Matplotlib anew works for four seconds before it does anything.
"""

import multiprocessing
import os
import resource
import sys
from collections.abc import Sequence
from importlib import import_module
from multiprocessing import forkserver
from pathlib import Path

import pytest

_context = multiprocessing.get_context("forkserver")


def prepare(modules: Sequence[str], **environment: str) -> None:
    """Start the process that is forked from, unless it works: with these modules and this environment."""
    _context.set_forkserver_preload(list(modules))
    with pytest.MonkeyPatch.context() as patch:
        for name, value in environment.items():
            patch.setenv(name, value)
        forkserver.ensure_running()


class Forked:
    """A process that calls a program, `module:function`, with words, as `subprocess.Popen` runs a command."""

    def __init__(
        self,
        program: str,
        words: Sequence[object],
        environment: dict[str, str],
        said: Path,
        longest_file: int = resource.RLIM_INFINITY,
    ) -> None:
        """Begin it: what it says is written to two files whose names begin with `said`."""
        self._files = said.with_suffix(".out"), said.with_suffix(".err")
        arguments = (program, [str(word) for word in words], environment, self._files, longest_file)
        self._process = _context.Process(target=_begin, args=arguments)
        self._process.start()

    @property
    def pid(self) -> int:
        assert self._process.pid is not None
        return self._process.pid

    def poll(self) -> int | None:
        return self._process.exitcode

    def kill(self) -> None:
        self._process.kill()

    def communicate(self, timeout: float | None = None) -> tuple[str, str]:
        """Wait for its end, and read what it has said."""
        self._process.join(timeout)
        assert self._process.exitcode is not None, "it goes on"
        out, err = (file.read_text(encoding="utf-8") if file.exists() else "" for file in self._files)
        return out, err


def _begin(
    program: str,
    words: list[str],
    environment: dict[str, str],
    files: tuple[Path, Path],
    longest_file: int,
) -> None:
    os.setsid()
    os.environ |= environment
    for stream, file in zip((sys.stdout, sys.stderr), files, strict=True):
        with file.open("wb") as opened:
            os.dup2(opened.fileno(), stream.fileno())
    resource.setrlimit(resource.RLIMIT_FSIZE, (longest_file, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))
    sys.argv = [program, *words]
    module, _, function = program.partition(":")
    getattr(import_module(module), function)()
