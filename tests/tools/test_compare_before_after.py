import json
import sys
from pathlib import Path

import numpy as np
import pytest

from tools.compare_before_after import compare, compare_arrays, main, metrics_that_differ, result, same


def said(folder: Path, metrics: dict[str, object], error: str = "") -> Path:
    folder.mkdir()
    (folder / "said.json").write_text(json.dumps({"metrics": metrics, "error": error}))
    return folder


def test_time_and_the_name_are_not_compared_but_the_last_digit_is() -> None:
    old = {
        "experiment": "walks",
        "seconds": {"learn": 3.0},
        "error_m": 0.1,
        "betti": [1, 0],
        "none": float("nan"),
    }
    new = {**old, "experiment": "slow_features", "seconds": {"learn": 4.0}}
    assert metrics_that_differ(old, new) == []
    assert metrics_that_differ(old, {**new, "error_m": 0.1 + 2**-56}) == [
        "error_m: 0.1 → 0.10000000000000002"
    ]
    assert metrics_that_differ(old, {**new, "betti": [1]}) == ["betti.1: 0 → missing"]


def test_arrays_are_compared_bit_by_bit_in_type_and_shape() -> None:
    array = np.array([np.nan, 0.0])
    assert same(array, array.copy())
    assert not same(array, np.array([np.nan, -0.0]))
    assert not same(array, array.astype(np.float32))
    assert not same(array, array[:, None])


def test_renamed_tensors_are_found_and_lost_ones_missed() -> None:
    one = np.ones(1)
    found = dict(
        compare_arrays({"age": one, "code": one, "gone": one}, {"seen": one, "code": -one}, {"age": "seen"})
    )
    assert list(found.values()) == [[], ["differs"], ["missing"]]
    assert dict(compare_arrays({}, {"fresh": one}, {})) == {"→ fresh": ["was not there"]}


def test_equal_refusals_are_equal_and_equal_crashes_are_not(tmp_path: Path) -> None:
    old, new = (said(tmp_path / name, {}, "cogmap: 600 views are too few") for name in ("old", "new"))
    assert [differences for _, differences in compare("homology", old, new)] == [[]]
    broken = said(tmp_path / "broken", {}, "ModuleNotFoundError: No module named 'cogmap'")
    assert [differences for _, differences in compare("homology", broken, broken)] == [["crashed", "crashed"]]


def test_result_is_kept_until_the_sources_change(tmp_path: Path) -> None:
    checkout, count = tmp_path / "checkout", tmp_path / "count"
    (checkout / "arena").mkdir(parents=True)
    script = f"open({str(count)!r}, 'a').write('x'); print('{{\"figure\": 1}}')"
    for text, runs in (("", 1), ("", 1), ("x = 1", 2)):
        (checkout / "arena" / "__init__.py").write_text(text)
        folder = result(checkout, sys.executable, tmp_path / "cache", "job", ["-c", script])
        assert json.loads((folder / "said.json").read_text()) == {"metrics": {"figure": 1}, "error": ""}
        assert len(count.read_text()) == runs


def test_what_differs_is_said_by_the_exit_status(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    figures = iter([1, 1, 1, 2])
    folders = iter(range(4))
    monkeypatch.setattr(
        "tools.compare_before_after.result",
        lambda *_: said(tmp_path / str(next(folders)), {"figure": next(figures)}),
    )
    monkeypatch.setattr(sys, "argv", ["compare", "old", "new", "--only", "cyclic"])
    assert [main(), main()] == [0, 1]
    assert capsys.readouterr().out.splitlines()[1:] == [
        "not equal cyclic: 1 figures",
        " " * 14 + "figure: 1 → 2",
    ]
