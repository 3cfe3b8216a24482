"""What `import cogmap` costs, and that everything is still found behind it."""

import subprocess
import sys
from pathlib import Path

import pytest

import cogmap

ROOT = Path(__file__).parents[2]
HEAVY = (
    "arena torch cogmap.experiments matplotlib gudhi ripser gymnasium sklearn pandas zarr numba pynndescent"
)


@pytest.fixture(scope="module")
def loaded() -> dict[str, set[str]]:
    """Which heavy modules a fresh interpreter holds after each of these lines, one after the other."""
    lines = (
        "from cogmap.cli import app; app['portable']",
        "import cogmap",
        "cogmap.CognitiveMap(seed=1)",
        "cogmap.betti",
        "cogmap.plots.plot_room",
    )
    heavy = set(HEAVY.split())
    script = "".join(f"{line}\nprint(*sys.modules.keys() & {heavy})\n" for line in lines)
    done = subprocess.run(
        [sys.executable, "-c", f"import sys\n{script}"], check=True, cwd=ROOT, capture_output=True, text=True
    )
    return {line: set(held.split()) for line, held in zip(lines, done.stdout.split("\n"), strict=False)}


def test_nothing_heavy_is_imported_until_it_is_used(loaded: dict[str, set[str]]) -> None:
    assert not loaded["from cogmap.cli import app; app['portable']"]
    assert not loaded["import cogmap"]
    assert loaded["cogmap.CognitiveMap(seed=1)"] == {"torch"}


def test_help_of_what_runs_commands_waits_for_nothing_heavy() -> None:
    script = f"""
import atexit, sys
atexit.register(lambda: sys.stderr.write(" ".join(sys.modules.keys() & {set(HEAVY.split())})))
sys.argv = ["cogmap", "portable", "--help"]
from cogmap.cli import main
main()
"""
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert "cogmap portable" in done.stdout
    assert not done.stderr


def test_what_is_used_is_imported(loaded: dict[str, set[str]]) -> None:
    assert "gudhi" in loaded["cogmap.betti"]
    assert "matplotlib" not in loaded["cogmap.betti"]
    assert "matplotlib" in loaded["cogmap.plots.plot_room"]


def test_every_name_is_found_and_listed() -> None:
    for name in cogmap.__all__:
        found = getattr(cogmap, name)
        assert found.__name__ in {name, f"cogmap.{name}"}
        assert name in dir(cogmap)


def test_what_is_not_there_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match=r"module 'cogmap' has no attribute 'manifold'"):
        cogmap.manifold  # noqa: B018
