import json
from pathlib import Path

import pytest

from benchmarks import __main__ as benchmarks
from benchmarks.scaling import growth

SCALING = growth((1, 2, 4), float)
KNOWN = {
    "machine": {"processor": "Abacus", "cores": 2, "python": "3.11.7"},
    "scaling": {"eating_by_leaves": SCALING, "load_before": 1.0, "load_after": 1.0},
}


@pytest.fixture
def known(tmp_path: Path) -> Path:
    path = tmp_path / "bench.json"
    path.write_text(json.dumps(KNOWN))
    return path


def test_page_and_figure_are_written_from_a_file_without_measuring(
    known: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    report = known.parent / "docs" / "performance.md"
    benchmarks.app(["--from", str(known), "--report", str(report)])
    assert json.loads(capsys.readouterr().out) == KNOWN
    assert "![Log–log plots of seconds against sizes](performance.png)" in report.read_text()
    assert report.with_suffix(".png").read_bytes().startswith(b"\x89PNG")


def test_named_subject_is_measured_beside_what_is_known(
    known: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(benchmarks, "subject", lambda _: lambda: {"views": 3})
    benchmarks.app(["walking", "--from", str(known)])
    found = json.loads(capsys.readouterr().out)
    assert list(found) == ["machine", "scaling", "walking"]
    assert found["scaling"] == KNOWN["scaling"]
    assert found["walking"]["views"] == 3
    assert found["walking"]["load_before"] >= 0


def test_unknown_subject_is_named() -> None:
    with pytest.raises(SystemExit, match=r"no benchmark of sleeping; choose among rendering, walking"):
        benchmarks.app(["sleeping"])
