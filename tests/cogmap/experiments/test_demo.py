import json
from pathlib import Path
from typing import Any

import matplotlib.image
import pytest

from arena import Arena
from cogmap import CogmapError, CognitiveMap
from cogmap.experiments.demo import demo

FIGURES = ["barcodes", "compass", "heading_cells", "metric_map", "place_cells", "position", "room", "views"]
KEYS = {
    "position_median_m", "position_p95_m", "nose_position_median_m", "nose_position_p95_m",
    "heading_median_deg", "heading_p95_deg", "heading_resultant", "place_cells_passing", "place_coverage",
    "heading_cells_passing", "metric_map_r2", "metric_map_median_m", "metric_reason",
    "betti_view_manifold", "betti_fused", "betti_place", "betti_heading", "betti_seen_and_smelt",
    "betti_view_manifold_resolved", "betti_fused_resolved", "betti_place_resolved", "betti_heading_resolved",
    "betti_seen_and_smelt_resolved",
    "seconds", "peak_memory_bytes", "views", "trusted", "reason", "reasons",
    "heading_trusted", "place_trusted", "metric_map_trusted", "topology_trusted",
}  # fmt: skip


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    out = tmp_path_factory.mktemp("demo") / "out"
    return out, demo(Arena.load("furnished"), out, views=5000, landmarks=(100, 40), seed=1)


def test_it_writes_every_figure_the_map_and_the_metrics(result: tuple[Path, dict[str, Any]]) -> None:
    out, metrics = result
    assert sorted(file.stem for file in out.glob("*.png")) == FIGURES
    for name in FIGURES:
        assert matplotlib.image.imread(out / f"{name}.png").std() > 0.01
    assert json.loads((out / "metrics.json").read_text(encoding="utf-8")) == metrics
    assert sorted(json.loads((out / "captions.json").read_text(encoding="utf-8"))) == FIGURES
    assert CognitiveMap.load(out / "map").trusted_ == metrics["trusted"]
    assert metrics.keys() >= KEYS


def test_views_stay_on_disk_and_leave_nothing_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[Path] = []

    def explore_no_more(*_: object, out: Path, **__: object) -> None:
        seen.append(out.parent.parent)
        raise CogmapError("seen enough")

    monkeypatch.setattr("cogmap.experiments.conditions.explore", explore_no_more)
    with pytest.raises(CogmapError, match="seen enough"):
        demo(Arena.load("furnished"), tmp_path / "out", views=20)
    assert seen
    assert not seen[0].exists()


def test_even_a_small_one_learns(result: tuple[Path, dict[str, Any]]) -> None:
    _, metrics = result
    assert metrics["trusted"], metrics["reason"]
    for answer in ("heading", "place", "metric_map", "topology"):
        assert metrics[f"{answer}_trusted"] == (not metrics["reasons"][answer])
    assert metrics["heading_trusted"]
    assert metrics["place_trusted"]
    assert metrics["heading_resultant"] > 0.98
    assert 1.5 * metrics["position_median_m"] < metrics["nose_position_median_m"]
    assert metrics["heading_cells_passing"] > 0.9
    assert metrics["betti_heading"] == [1, 1, 0]
    assert metrics["betti_heading_resolved"] == [not reason for reason in metrics["betti_reasons"]["heading"]]
    assert metrics["peak_memory_bytes"] > 1e8


def test_without_a_compass_it_says_what_can_be_said(tmp_path: Path) -> None:
    out = tmp_path / "out"
    metrics = demo(Arena.load("open_field"), out, views=60, landmarks=(30, 25))
    assert not metrics["heading_trusted"]
    assert "no loop of its charts closes" in metrics["reason"]
    assert "heading_median_deg" not in metrics
    assert "betti_heading" not in metrics
    assert metrics["position_median_m"] > 0
    without = {"compass", "heading_cells", "metric_map"}
    assert {file.stem for file in out.glob("*.png")} == set(FIGURES) - without


def test_too_few_views_are_refused_and_nothing_is_written(tmp_path: Path) -> None:
    with pytest.raises(CogmapError, match="views is 0"):
        demo(Arena.load("furnished"), tmp_path / "out", views=0)
    assert not list(tmp_path.iterdir())
