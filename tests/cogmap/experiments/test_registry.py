import json
from functools import partial
from pathlib import Path

import matplotlib.image
import numpy as np
import pandas as pd
import pytest

from arena import Arena, Nose
from cogmap import CogmapError
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.paper import distinguishability
from cogmap.experiments.registry import experiment, experiments, listing, run_experiment
from cogmap.experiments.result import Result
from cogmap.tables import as_markdown

VIEWS = {
    "rotation": 200,
    "cyclic": 200,
    "brownian": 200,
    "similarity": 200,
    "localisation": 200,
    "roadmap": 800,
    "fusion": 200,
    "odour_ablation": 200,
}
KEYS = {
    "rotation": {"test_correlation", "median_error_deg", "betti", "dimension", "geodesic_rank_correlation"},
    "cyclic": {"heading_resultant", "translation_r2", "betti", "dimension"},
    "brownian": {"position_r2", "heading_resultant", "betti", "dimension"},
    "similarity": {"euclidean", "bag_of_words", "earth_mover"},
    "localisation": {"position_median_m", "heading_median_deg", "nearest_position_median_m", "placed"},
    "roadmap": {"success", "length_ratio_median", "paths_touching", "deviation_mean", "query_ms"},
    "distinguishability": {"confusion_white", "confusion_blue_wall", "betti_white", "betti_blue_wall"},
    "fusion": {"vision_only", "olfaction_only", "fused", "visual_smell", "competition"},
    "odour_ablation": {
        "1_sources_0.1_noise",
        "4_sources_0.1_noise",
        "3_sources_0_noise",
        "3_sources_0.3_noise",
    },
}


@pytest.fixture
def few_pairs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Plan between few poses: most of a small roadmap else."""
    monkeypatch.setattr("cogmap.experiments.paper.roadmap.PAIRS", 30)


def test_each_says_what_it_does_and_what_it_is_about() -> None:
    found = listing()
    assert {entry["about"] for entry in found} == {
        "Experiments of the paper",
        "Bodies whose mechanism nobody has described",
        "Controls of the cells",
        "Many rooms",
        "What an explorer does with its map: imagine, expect and reach",
    }
    assert all(entry["what it does"].endswith(".") for entry in found)
    assert len(found) == len(experiments()) >= 17


def test_the_table_of_the_documentation_is_that_of_the_registry() -> None:
    page = Path(__file__).parents[3] / "docs" / "experiments.md"
    assert page.read_text(encoding="utf-8") == as_markdown(listing()) + "\n", (
        "write it anew: cogmap experiment --list > docs/experiments.md"
    )


def test_no_two_have_the_same_name() -> None:
    def fusion(_: Conditions) -> Result:
        raise AssertionError

    with pytest.raises(
        CogmapError, match=r"experiment 'fusion' in cogmap.experiments.controls.fusion already"
    ):
        experiment(room="furnished", views=200)(fusion)


@pytest.mark.usefixtures("few_words", "few_pairs")
@pytest.mark.parametrize("name", VIEWS)
def test_each_writes_metrics_figures_and_tables(name: str, tmp_path: Path) -> None:
    out = tmp_path / name
    assert_written(name, out, run_experiment(name, out, views=VIEWS[name], seed=1))


def assert_written(name: str, out: Path, result: Result) -> None:
    assert result.metrics.keys() >= {"experiment", "arena", "views", "seed"} | KEYS[name]
    chosen = experiments()[name]
    assert result.metrics["arena"] == ", ".join((chosen.room, *chosen.extra_rooms))
    assert json.loads((out / "metrics.json").read_text(encoding="utf-8")) == result.metrics
    assert {file.stem for file in out.glob("*.png")} == result.figures.keys() == result.captions.keys()
    assert {file.stem for file in out.glob("*.parquet")} == result.tables.keys()
    for figure in result.figures:
        assert matplotlib.image.imread(out / f"{figure}.png").std() > 0.01
    for table, rows in result.tables.items():
        pd.testing.assert_frame_equal(pd.read_parquet(out / f"{table}.parquet"), rows.reset_index(drop=True))


def test_the_white_room_is_confused_and_the_blue_wall_is_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    few = partial(distinguishability.betti, landmarks=(60, 30))
    monkeypatch.setattr(distinguishability, "betti", few)
    result = run_experiment("distinguishability", tmp_path / "out", views=1200, seed=1)
    assert_written("distinguishability", tmp_path / "out", result)
    metrics = result.metrics
    assert 0.4 < metrics["confusion_white"] < 0.6
    assert metrics["confusion_blue_wall"] < 0.02


@pytest.mark.usefixtures("few_words")
def test_the_same_seed_gives_the_same_tables() -> None:
    room = Arena.load("open_field")
    one, same = (run_experiment("rotation", views=200, seed=2, room=room) for _ in range(2))
    assert one.metrics["arena"] == "open_field"
    assert one.metrics == same.metrics
    for name, table in one.tables.items():
        np.testing.assert_array_equal(table.to_numpy(), same.tables[name].to_numpy())


def test_what_has_rooms_of_its_own_is_done_nowhere_else() -> None:
    with pytest.raises(CogmapError, match="rooms of its own"):
        run_experiment("distinguishability", room=Arena.load("furnished"))


@pytest.mark.parametrize(
    ("name", "views", "says"),
    [
        ("levitation", None, "unknown experiment 'levitation'; choose one of .*rotation"),
        ("rotation", 10, "views is 10"),
    ],
)
def test_what_cannot_be_done_is_refused_and_nothing_is_written(
    name: str, views: int | None, says: str, tmp_path: Path
) -> None:
    with pytest.raises(CogmapError, match=says):
        run_experiment(name, tmp_path / "out", views=views)
    assert not list(tmp_path.iterdir())


def test_another_folder_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("years of work", encoding="utf-8")
    with pytest.raises(CogmapError, match="not the result of an experiment"):
        run_experiment("rotation", tmp_path, views=200)
    assert [file.name for file in tmp_path.iterdir()] == ["thesis.txt"]


def test_what_an_experiment_does_not_take_is_refused() -> None:
    with pytest.raises(CogmapError, match="rotation does not take another nose"):
        run_experiment("rotation", views=200, nose=Nose(noise=0.3))
