import pytest

from cogmap.experiments.controls.slow_feature_comparison import WALKS
from cogmap.experiments.registry import run_experiment


def test_each_walk_is_learnt_both_ways_even_where_there_is_no_compass(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(
        "cogmap.experiments.controls.slow_feature_comparison.WALKS", {"corridor": WALKS["corridor"]}
    )
    result = run_experiment("slow_features", views=300)
    corridor = result.metrics["corridor"]
    assert corridor.keys() == {"slow_features", "fused"}
    assert not corridor["fused"]["trusted"]
    assert corridor["fused"]["heading_cells_passing"] == 0
    assert "heading_median_deg" not in corridor["fused"]
    assert corridor["fused"].keys() >= {"place_cells_passing", "position_median_m"}
    assert result.tables["cells"].groupby("population").size().to_dict() == {
        "corridor, fused heading": 60,
        "corridor, fused place": 150,
        "corridor, slow features": 16,
    }
    assert result.figures.keys() == {"slow_features", "fused_place", "fused_heading"}
