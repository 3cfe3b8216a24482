import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import llvmlite.binding as llvm
import pytest

from arena import Arena, Brownian, Camera, explore
from cogmap import CogmapError, cli
from cogmap.portable import PINNED, arithmetic, portable_environment
from tests.processors import PROCESSORS, processor

ROOT = Path(__file__).parents[2]
COGMAP = (sys.executable, "-m", "cogmap")


def run(*words: str, environment: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    environment = {**(os.environ if environment is None else environment), "PYTHONPATH": str(ROOT)}
    return subprocess.run(words, env=environment, capture_output=True, text=True, check=False)


def calculate(*before: str, environment: dict[str, str] | None = None) -> str:
    script = (
        "import os; from cogmap.portable import PINNED, arithmetic; "
        "print(arithmetic(), PINNED.items() <= os.environ.items())"
    )
    found = run(*before, sys.executable, "-W", "error", "-c", script, environment=environment)
    assert not found.stderr
    return found.stdout.strip()


def test_arithmetic_is_a_name_of_how_this_process_calculates() -> None:
    assert arithmetic() == arithmetic.__wrapped__()
    assert calculate() == f"{arithmetic()} {PINNED.items() <= os.environ.items()}"


@pytest.fixture(scope="module")
def portable() -> str:
    return calculate(*COGMAP, "portable")


@pytest.mark.parametrize("name", [name for name in PROCESSORS if name != "avx2"])  # which is met below
def test_portable_arithmetic_is_the_same_on_every_processor(name: str, portable: str, tmp_path: Path) -> None:
    environment = processor(name, tmp_path)
    if environment is None:
        pytest.skip(f"this processor has no instructions of {name}")
    assert portable.endswith("True")
    assert calculate(*COGMAP, "portable", environment=environment) == portable
    plain = calculate(environment=environment)
    assert plain.split()[0] != portable.split(maxsplit=1)[0]
    assert plain.endswith("False")


@pytest.mark.full
def test_all_that_is_begun_on_one_processor_can_be_ended_on_another(tmp_path: Path) -> None:
    """A recording, a map and a table; the recording is begun without portable arithmetic."""
    environment = processor("avx2", tmp_path)
    if environment is None:
        pytest.skip("this processor has no AVX2")
    begun = tmp_path / "begun.zarr"
    explore(Arena.load("furnished"), Brownian(), Camera.panoramic(90, 15), views=600, seed=0, out=begun)
    shutil.rmtree(begun / "views" / "c" / "1")
    found = []
    for where, begin in (("here", False), ("there", True)):
        folder = tmp_path / where
        folder.mkdir()
        if begin:
            shutil.copytree(begun, folder / "begun.zarr")
        program = (sys.executable, "-m", "tests.portable_program", str(folder), "600", "60")
        ended = run(*COGMAP, "portable", *program, environment=environment if begin else None)
        assert ended.returncode == 0, ended.stderr
        found.append(json.loads(ended.stdout))
    assert found[0] == found[1]
    assert calculate(environment=environment).split()[0] != found[0]["arithmetic"]


def test_another_kind_of_processor_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    assert portable_environment().items() >= PINNED.items()
    monkeypatch.setattr(llvm, "get_host_cpu_features", lambda: {"sse4.2": True, "avx2": False})
    with pytest.raises(CogmapError, match=r"needs an x86-64 processor with AVX2 and FMA, and this is"):
        portable_environment()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [((), "there is no command to run"), (("no-such-program", "--help"), "cannot run no-such-program: No")],
)
def test_bad_commands_are_one_sentence(
    words: tuple[str, ...],
    sentence: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sys, "argv", ["cogmap", "portable", *words])
    with pytest.raises(SystemExit) as stop:
        cli.main()
    assert stop.value.code == 2
    err = capsys.readouterr().err
    assert err.startswith(f"cogmap: {sentence}")
    assert len(err.splitlines()) == 1


def test_the_command_is_given_its_words_and_ends_as_what_it_runs() -> None:
    script = "import sys; print(sys.argv[1:]); raise SystemExit(7)"
    ended = run(*COGMAP, "portable", sys.executable, "-c", script, "demo", "--help")
    assert (ended.returncode, ended.stdout) == (7, "['demo', '--help']\n")


def test_help_is_of_what_is_asked(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["cogmap", "portable", "--help"])
    with pytest.raises(SystemExit) as stop:
        cli.main()
    assert not stop.value.code
    assert "cogmap portable dask worker" in " ".join(capsys.readouterr().out.split())
