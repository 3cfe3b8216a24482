import errno
import json
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from filelock import FileLock

from cogmap import CogmapError, Plan, UnlikeArithmeticWarning, cli, crew, sweep
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.registry import Experiment, experiments
from cogmap.portable import arithmetic
from cogmap.sweeps.ledger import is_full_disk, sealed
from cogmap.sweeps.points import Point

GRID: dict[str, list[Any]] = {"nose.noise": [0.0, 0.5], "map.charts": [15, 40]}
PLAN = Plan.create(experiment="toy", seeds=[0, 1], grid=GRID)
UNLUCKY = Plan.create(experiment="toy", grid={"map.charts": [12, 13, 40]})


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> list[Conditions]:
    """Every setting that the experiment was done in."""
    done: list[Conditions] = []
    usual = experiments()["toy"]

    def run(conditions: Conditions) -> Any:
        done.append(conditions)
        return usual.run(conditions)

    monkeypatch.setitem(experiments(), "toy", usual._replace(run=run))
    return done


def test_a_table_with_a_row_for_each_point_and_seed(tmp_path: Path) -> None:
    table = sweep(PLAN, tmp_path / "out", workers=1)
    assert table[["nose.noise", "map.charts", "seed"]].to_numpy().tolist() == [
        [noise, charts, seed] for noise in (0.0, 0.5) for charts in (15, 40) for seed in (0, 1)
    ]
    assert table["by_charts.share"].tolist() == [1 / 15, 1 / 15, 1 / 40, 1 / 40] * 2
    assert table["by_charts.betti.1"].tolist() == [0, 1] * 4
    assert table["trusted"].tolist() == [False, False, True, True] * 2
    assert not any("seconds" in name or name.endswith("_ms") for name in table)
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "out" / "table.parquet"), table)
    read = pd.read_csv(tmp_path / "out" / "table.csv")
    assert read["smell"].tolist() == table["smell"].tolist()
    assert read.columns.tolist() == table.columns.tolist()
    assert {file.name for file in (tmp_path / "out").iterdir()} == {
        "SHA256SUMS", "about.json", "figures", "plan.toml", "points", "sweep.json",
        "table.csv", "table.parquet",
    }  # fmt: skip
    assert (
        json.loads((tmp_path / "out" / "about.json").read_text("utf-8"))["command"]
        == "cogmap sweep plan.toml"
    )
    assert Plan.load(tmp_path / "out" / "plan.toml") == PLAN
    assert {file.stem for file in (tmp_path / "out" / "figures").iterdir()} == {
        "smell", "by_charts.share", "by_charts.betti.1", "trusted"
    }  # fmt: skip


def test_what_is_finished_is_not_done_again(tmp_path: Path, counted: list[Conditions]) -> None:
    whole = sweep(PLAN, tmp_path / "whole", workers=1)
    files = sorted((tmp_path / "whole" / "points").iterdir())
    content = {file.name: file.read_bytes() for file in files}
    for file in files[::3]:
        file.unlink()
    assert len(counted) == len(files) == 8
    pd.testing.assert_frame_equal(sweep(PLAN, tmp_path / "whole", workers=1), whole)
    assert len(counted) == 8 + 3
    assert content == {file.name: file.read_bytes() for file in files}


def test_points_share_their_walks(tmp_path: Path, counted: list[Conditions]) -> None:
    sweep(PLAN, tmp_path / "out", workers=1, keep_walks=True)
    walks = [file.name for file in (tmp_path / "out" / "walks").iterdir() if file.suffix == ".zarr"]
    assert len(walks) == 4  # two seeds and two noses
    assert {conditions.library for conditions in counted} == {(tmp_path / "out" / "walks").resolve()}


def test_a_point_that_fails_is_a_row_and_can_be_done_again(tmp_path: Path, counted: list[Conditions]) -> None:
    table = sweep(UNLUCKY, tmp_path / "out", workers=1)
    assert table["error"].tolist() == ["", "RuntimeError: thirteen charts are bad luck", ""]
    assert table["smell"].isna().tolist() == [False, True, False]
    assert len(counted) == 3
    sweep(UNLUCKY, tmp_path / "out", workers=1)
    assert len(counted) == 3
    sweep(UNLUCKY, tmp_path / "out", workers=1, retry_failed=True)
    assert [conditions.map["charts"] for conditions in counted] == [12, 13, 40, 13]


def test_a_point_that_is_mended_loses_its_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sweep(UNLUCKY, tmp_path / "out", workers=1)

    def mended(conditions: Conditions) -> Any:
        return toy.run(
            Conditions(conditions.room, conditions.views, library=conditions.library, map={"charts": 40})
        )

    toy = experiments()["toy"]
    monkeypatch.setitem(experiments(), "toy", toy._replace(run=mended))
    table = sweep(UNLUCKY, tmp_path / "out", workers=1, retry_failed=True)
    assert table["error"].tolist() == ["", "", ""]
    assert table["by_charts.share"].tolist() == [1 / 12, 1 / 40, 1 / 40]


def test_points_of_unlike_processors_are_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    sweep(UNLUCKY, tmp_path / "out", workers=1)
    first = min((tmp_path / "out" / "points").iterdir())
    record = json.loads(first.read_text("utf-8"))
    assert record["arithmetic"] == arithmetic()
    del record["digest"]
    first.write_text(sealed(record | {"arithmetic": "deadbeef"}), "utf-8")
    with pytest.warns(UnlikeArithmeticWarning, match=r"done in 2 arithmetics \(.*deadbeef.*cogmap portable"):
        sweep(UNLUCKY, tmp_path / "out", workers=1)
    file = tmp_path / "unlucky.toml"
    file.write_text(UNLUCKY.to_toml(), "utf-8")
    monkeypatch.setattr(sys, "argv", ["cogmap", "sweep", str(file), "--out", str(tmp_path / "out")])
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        cli.main()
    assert "cogmap: the points of this sweep were done in 2 arithmetics" in capsys.readouterr().err


def test_another_folder_is_left_alone(tmp_path: Path) -> None:
    sweep(UNLUCKY, tmp_path / "out", workers=1)
    with pytest.raises(CogmapError, match="holds another sweep"):
        sweep(PLAN, tmp_path / "out")
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter").write_text("years of work", encoding="utf-8")
    (tmp_path / "file").write_text("", encoding="utf-8")
    for name in ("thesis", "file"):
        with pytest.raises(CogmapError, match="not the folder of a sweep"):
            sweep(PLAN, tmp_path / name)
    assert [file.name for file in (tmp_path / "thesis").iterdir()] == ["chapter"]


def test_two_commands_do_not_meet_in_one_folder(tmp_path: Path) -> None:
    (tmp_path / "work").mkdir()
    with FileLock(tmp_path / "work" / "sweep.lock"), pytest.raises(CogmapError, match="another command"):
        sweep(PLAN, tmp_path)


def test_a_damaged_file_is_named(tmp_path: Path) -> None:
    sweep(UNLUCKY, tmp_path, workers=1)
    next((tmp_path / "points").iterdir()).write_text("{", encoding="utf-8")
    with pytest.raises(CogmapError, match="is damaged; remove it"):
        sweep(UNLUCKY, tmp_path, workers=1)
    (tmp_path / "sweep.json").write_text("[]", encoding="utf-8")
    with pytest.raises(CogmapError, match=r"sweep.json is damaged"):
        sweep(UNLUCKY, tmp_path, workers=1)


@pytest.mark.parametrize("wrapped", [False, True])
def test_a_full_disk_is_one_sentence_and_loses_nothing(
    wrapped: bool,  # noqa: FBT001
    tmp_path: Path,
    counted: list[Conditions],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    toy = experiments()["toy"]

    def fill(conditions: Conditions) -> Any:
        if len(counted) == 2:
            full = OSError(errno.ENOSPC, "No space left on device")
            if wrapped:
                error = CogmapError("cannot write")
                error.__context__ = full
                raise error
            raise full
        return toy.run(conditions)

    monkeypatch.setitem(experiments(), "toy", toy._replace(run=fill))
    with pytest.raises(CogmapError, match="no space left on a disk; all points that are finished are kept"):
        sweep(PLAN, tmp_path, workers=1)
    assert len(list((tmp_path / "points").iterdir())) == 2
    monkeypatch.setitem(experiments(), "toy", toy)
    assert (sweep(PLAN, tmp_path, workers=1)["error"] == "").all()
    assert len(counted) == 8


def test_only_a_lack_of_space_is_a_full_disk() -> None:
    assert is_full_disk(OSError(errno.EDQUOT, "quota"))
    assert not is_full_disk(FileNotFoundError(errno.ENOENT, "gone"))
    assert not is_full_disk(ValueError("no"))


def test_a_folder_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(CogmapError, match="cannot write to"):
        sweep(PLAN, tmp_path / "file" / "below")


def test_a_scheduler_that_is_not_there_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crew, "PATIENCE", 0.5)
    for address in ("tcp://127.0.0.1:9", "nonsense"):
        with pytest.raises(CogmapError, match=f"no Dask scheduler answers at {address}"):
            sweep(PLAN, tmp_path, scheduler=address)
    with pytest.raises(CogmapError, match="give one of them"):
        sweep(PLAN, tmp_path, scheduler="tcp://127.0.0.1:9", workers=2)


def test_bad_points_are_refused_before_anything_is_done(tmp_path: Path) -> None:
    bad = Plan.create(experiment="toy", grid={"nose.noise": [0.1, -1.0]})
    with pytest.raises(ValueError, match="noise is -1"):
        sweep(bad, tmp_path / "out")
    with pytest.raises(CogmapError, match="workers is 0"):
        sweep(PLAN, tmp_path / "out", workers=0)
    assert not (tmp_path / "out").exists()


@pytest.fixture
def run(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., tuple[str, str]]:
    def call(*words: object) -> tuple[str, str]:
        monkeypatch.setattr(sys, "argv", ["cogmap", *map(str, words)])
        with suppress(SystemExit):
            cli.main()
        out, err = capsys.readouterr()
        return out, err

    return call


def test_the_command(run: Callable[..., tuple[str, str]], tmp_path: Path) -> None:
    file = tmp_path / "sweep.toml"
    file.write_text('experiment = "toy"\n[grid]\n"map.charts" = [12, 13, 40]\n', encoding="utf-8")
    out, err = run("sweep", file, "--out", tmp_path / "out", "--workers", 1, "--json")
    assert json.loads(out) == {
        "table": str(tmp_path / "out" / "table.csv"), "rows": 3, "failed": 1, "untrusted": 1
    }  # fmt: skip
    assert "1 of 3 points failed, the first with RuntimeError: thirteen" in err
    out, err = run("sweep", tmp_path / "nowhere.toml", "--out", tmp_path / "out")
    assert not out
    assert len(err.splitlines()) == 1


def test_a_stranger_experiment_reaches_the_catalogue_of_a_worker(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    chosen: Experiment = experiments()["toy"]

    def forgetful(work: Callable[[Point], None], points: list[Point], workers: int | None, _: Any) -> Any:
        assert workers == 1
        del experiments()["toy"]
        for point in points:
            yield work(point)

    monkeypatch.setattr("cogmap.sweeps.sweeping.on_this_machine", forgetful)
    assert (sweep(PLAN, tmp_path, workers=1)["error"] == "").all()
    assert experiments()["toy"] is chosen
