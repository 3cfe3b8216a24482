"""What `import cogmap` costs, and that everything is still found behind it."""

import subprocess
import sys
from pathlib import Path

import pytest

import cogmap

ROOT = Path(__file__).parents[2]
HEAVY = "cogmap.experiments matplotlib gudhi ripser gymnasium sklearn pandas zarr numba pynndescent"


def loaded_by(code: str) -> set[str]:
    """Tell which heavy modules a fresh interpreter holds after some code."""
    script = f"{code}; import sys; print(*sys.modules.keys() & {set(HEAVY.split())})"
    done = subprocess.run(
        [sys.executable, "-c", script], check=True, cwd=ROOT, capture_output=True, text=True
    )
    return set(done.stdout.split())


@pytest.mark.parametrize("code", ["import cogmap", "import cogmap; cogmap.CognitiveMap(seed=1)"])
def test_nothing_heavy_is_imported_until_it_is_used(code: str) -> None:
    assert not loaded_by(code)


@pytest.mark.parametrize(("used", "module"), [("plots.plot_room", "matplotlib"), ("betti", "gudhi")])
def test_what_is_used_is_imported(used: str, module: str) -> None:
    assert module in loaded_by(f"import cogmap; cogmap.{used}")


def test_every_name_is_found_and_listed() -> None:
    for name in cogmap.__all__:
        found = getattr(cogmap, name)
        assert found.__name__ in {name, f"cogmap.{name}"}
        assert name in dir(cogmap)


def test_what_is_not_there_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match=r"module 'cogmap' has no attribute 'manifold'"):
        cogmap.manifold  # noqa: B018
