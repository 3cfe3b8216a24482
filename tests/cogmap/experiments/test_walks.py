import pytest

from cogmap.experiments.catalogue import experiment
from cogmap.experiments.walks import WALKS


def test_each_walk_is_learnt_both_ways_even_where_there_is_no_compass(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("cogmap.experiments.walks.WALKS", {"corridor": WALKS["corridor"]})
    result = experiment("walks", views=300)
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


@pytest.mark.full
def test_slow_features_give_one_population_a_walk_and_the_fusion_both() -> None:
    metrics = experiment("walks").metrics
    slow = {name: metrics[name]["slow_features"] for name in WALKS}
    assert slow["brownian"]["place_cells_passing"] > 0.8
    assert slow["brownian"]["heading_cells_passing"] == 0
    assert slow["slow_turning"]["place_cells_passing"] == 0
    assert slow["slow_turning"]["heading_cells_passing"] > 0.6
    assert slow["shuffled"]["place_cells_passing"] == slow["shuffled"]["heading_cells_passing"] == 0
    for name in ("brownian", "slow_turning", "shuffled"):
        assert metrics[name]["fused"]["place_cells_passing"] > 0.9
        assert metrics[name]["fused"]["heading_cells_passing"] > 0.9
    spread = (
        metrics["shuffled"]["fused"]["heading_median_deg"]
        / metrics["brownian"]["fused"]["heading_median_deg"]
    )
    assert 0.7 < spread < 1.4
