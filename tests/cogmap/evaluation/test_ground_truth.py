from typing import Any

import numpy as np
import pytest

from arena import Arena
from cogmap import cells as module
from cogmap.evaluation.ground_truth import CellMetrics, GroundTruth, as_one_table, map_correlations


@pytest.fixture(scope="module")
def truth() -> GroundTruth:
    room = Arena.load("open_field")
    rng = np.random.default_rng(0)
    train, poses = (
        np.column_stack([room.sample_free(4000, 0.18, rng), rng.uniform(-np.pi, np.pi, 4000)])
        for _ in range(2)
    )
    return GroundTruth(train, poses, room.sample_free(20_000, 0.18, np.random.default_rng(0)))


def place_rates(poses: np.ndarray) -> np.ndarray:
    centres = np.random.default_rng(1).uniform([-1.5, -1.0], [1.5, 1.0], (40, 2))
    return 10 * np.exp(-((poses[:, None, :2] - centres) ** 2).sum(axis=2) / 0.18)


def heading_rates(poses: np.ndarray) -> np.ndarray:
    preferred = np.linspace(-np.pi, np.pi, 20, endpoint=False)
    return 10 * np.exp(5 * (np.cos(poses[:, 2:] - preferred) - 1))


def test_ideal_cells_pass_as_what_they_are(truth: GroundTruth) -> None:
    place, heading = (truth.measure(tuned(truth.poses)) for tuned in (place_rates, heading_rates))
    assert place.place_figures["place_cells_passing"] == 1
    assert place.heading_figures["heading_cells_passing"] == 0
    assert place.place_figures["in_field_direction_vector"] < 0.15
    assert place.place_figures["place_coverage"] > 0.75
    assert heading.heading_figures["heading_cells_passing"] == 1
    assert heading.place_figures["place_cells_passing"] == heading.place_figures["place_coverage"] == 0
    table = as_one_table({"place": place, "heading": heading})
    assert table.groupby("population").size().to_dict() == {"place": 40, "heading": 20}


def test_cells_tied_to_both_pass_as_neither(truth: GroundTruth) -> None:
    both = truth.measure(place_rates(truth.poses)[:, :20] * heading_rates(truth.poses))
    assert both.place_figures["place_cells_passing"] == both.heading_figures["heading_cells_passing"] == 0
    assert both.place_figures["in_field_direction_vector"] > 0.8


def test_cells_without_a_compass_are_silent(truth: GroundTruth) -> None:
    blind = truth.measure(np.full((4000, 5), np.nan))
    assert blind.heading_figures == {"heading_cells_passing": 0.0}
    assert blind.place_figures == {"place_cells_passing": 0.0, "place_coverage": 0.0, "field_area_m2": 0.0}


def test_maps_of_different_cells_lie_on_the_same_bins(truth: GroundTruth) -> None:
    place, heading = (truth.measure(tuned(truth.poses)) for tuned in (place_rates, heading_rates))
    assert place.maps.rates.shape[1:] == heading.maps.rates.shape[1:] == truth.edges.shape
    np.testing.assert_allclose(map_correlations(place.maps, place.maps), 1)
    assert place.tuning.maps is place.maps


def test_what_is_measured_is_worked_out_once(truth: GroundTruth, monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []

    def counted(name: str) -> None:
        usual = getattr(module, name)

        def call(*words: Any, **named: Any) -> Any:
            done.append(name)
            return usual(*words, **named)

        monkeypatch.setattr(module, name, call)

    for name in ("rate_maps", "place_fields", "place_statistics", "heading_statistics", "tuning_curves"):
        counted(name)
    cells: CellMetrics = truth.measure(place_rates(truth.poses))
    assert not done
    _ = cells.table, cells.place_figures, cells.heading_figures, cells.tuning, cells.coverage(truth.walked)
    assert sorted(done) == [
        "heading_statistics", "place_fields", "place_statistics", "rate_maps", "tuning_curves"
    ]  # fmt: skip
