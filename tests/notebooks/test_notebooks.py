"""Every notebook is run from its first cell to its last, with sizes of its parameter cell made small."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import nbformat
import pytest
from jupyter_client import AsyncKernelManager
from jupyter_core.utils import run_sync
from nbclient import NotebookClient

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
OWN = ROOT / "notebooks" / "your_own"
SMALL: dict[str, dict[str, Any]] = {
    "1_a_spin_is_a_ring": {"VIEWS": 300},
    "2_a_corridor_is_a_cylinder": {"VIEWS": 500},
    "3_a_room_is_a_solid_torus": {"VIEWS": 400},
    "4_where_am_i": {"VIEWS": 1500},
    "5_cells_from_sight_and_smell": {"VIEWS": 5000, "CHARTS": 1000},
    "6_sweeping_cell_statistics": {"VIEWS": 1500, "NOISE": [0.1], "SEEDS": [0]},
    "7_the_homology_of_emergent_maps": {"VIEWS": 3000, "CHARTS": 600, "LANDMARKS": (100, 50)},
    "8_your_own_arena": {"MINUTES": 5, "CHARTS": 250},
    "9_imagine_expect_reach": {"VIEWS": 3000, "CHARTS": 600, "WIDTH": 90},
    "10_any_body": {"VIEWS": 600},
    "11_your_own_camera_your_own_animal": {"SHUFFLES": 20},
    "12_several_rooms": {"VIEWS": 2500, "CHARTS": 500, "WIDTH": 90},
}


BEGIN = """
%reset -f
%cd -q {}
from matplotlib.layout_engine import ConstrainedLayoutEngine
from cogmap.coordinates import view_code
from cogmap.features import vocabulary
ConstrainedLayoutEngine.execute = lambda *_: None
vocabulary.EXAMPLES = 2000
view_code.STEPS = 60
"""
"""Before the first cell: words are learnt from few descriptors, components from few batches; no layout."""
GUARDS = """
import gc
gc.collect()
from neurons.network import Network
from tests.guards import figures, too_near
for network in gc.get_objects():
    if type(network) is Network and too_near(network, ("signs", "phases")):
        print("a map stands too near a guard:", figures(network))
"""
"""After the last cell: maps grown in the kernel stand clear of the guards, as those of other tests."""


@pytest.fixture(scope="module")
def kernel() -> Iterator[AsyncKernelManager]:
    """One for all, which imports all they need once; it sweeps in its own process."""
    manager = AsyncKernelManager()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", str(ROOT))
        patch.setenv("LOKY_MAX_CPU_COUNT", "1")
        yield manager
    run_sync(manager.shutdown_kernel)(now=True)


def read(path: Path) -> Any:
    return nbformat.read(path, 4)


def test_each_has_small_sizes() -> None:
    assert [path.stem for path in NOTEBOOKS] == sorted(SMALL)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.filterwarnings("ignore::ResourceWarning")
@pytest.mark.parametrize("name", SMALL)
def test_it_runs(name: str, tmp_path: Path, kernel: AsyncKernelManager) -> None:
    notebook = read(ROOT / "notebooks" / f"{name}.ipynb")
    (parameters,) = [cell for cell in notebook.cells if "parameters" in cell.metadata.get("tags", [])]
    for key, value in SMALL[name].items():
        parameters.source, count = re.subn(
            rf"^{key} = .*$", f"{key} = {value}", parameters.source, flags=re.MULTILINE
        )
        assert count == 1
    (tmp_path / OWN.name).symlink_to(OWN)  # where a notebook is run there is what it reads
    drawn = [figures(cell) for cell in notebook.cells]
    begin = nbformat.v4.new_code_cell(BEGIN.format(tmp_path))
    notebook.cells = [begin, *notebook.cells, nbformat.v4.new_code_cell(GUARDS)]
    client = NotebookClient(notebook, timeout=300, km=kernel)
    client.execute()
    # It leaves the channels to a kernel that is not its own open, to be complained of in a later test.
    client.kc.stop_channels()
    assert not notebook.cells[-1].outputs
    notebook.cells = notebook.cells[1:-1]
    assert [figures(cell) for cell in notebook.cells] == drawn
    assert sum(drawn) >= 4


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_reads_well(path: Path) -> None:
    notebook = read(path)
    first, last = notebook.cells[0], notebook.cells[-1]
    assert re.fullmatch(r"# [^\n]+\n\n\*\*.*\?\*\*", first.source, re.DOTALL)
    assert last.source.split("\n\n- ")[0].endswith("## What to try next")
    codes = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert codes[0].metadata["tags"] == ["parameters"]
    assert path.stat().st_size < 1_000_000
    for number, cell in enumerate(codes, 1):
        assert len(cell.source.splitlines()) <= 30
        assert cell.execution_count == number
        assert not any(output.output_type == "error" for output in cell.outputs)
        for module in re.findall(r"^(?:from|import) (\S+)", cell.source, re.MULTILINE):
            assert module in {"arena", "cogmap", "numpy", "pathlib", "tempfile"}
    text = path.read_text(encoding="utf-8")
    assert not re.search(r"stderr|/(tmp|root|home|work)/", text)


def figures(cell: Any) -> int:
    return sum("image/png" in output.get("data", {}) for output in cell.get("outputs", []))
