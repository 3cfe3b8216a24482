import warnings

import numpy as np
import pytest

from arena import Arena, Brownian, Camera, explore
from cogmap import Activity, CognitiveMap, UntrustedMapWarning
from cogmap.evaluation.populations import GroundTruth, as_one_table, competing_cells, grow_map, perceive


@pytest.fixture(scope="module")
def truth() -> GroundTruth:
    room = Arena.load("open_field")
    rng = np.random.default_rng(0)
    train, poses = (
        np.column_stack([room.sample_free(4000, 0.18, rng), rng.uniform(-np.pi, np.pi, 4000)])
        for _ in range(2)
    )
    return GroundTruth.of(room, train, poses)


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
    assert place.place_coverage > 0.75
    assert heading.heading_figures["heading_cells_passing"] == 1
    assert heading.place_figures["place_cells_passing"] == heading.place_coverage == 0
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


def test_cells_that_compete_for_places_are_place_cells(truth: GroundTruth) -> None:
    (rates,) = competing_cells(truth.train[:, :2], truth.poses[:, :2], seed=0, cells=60)
    assert truth.measure(rates).place_figures["place_cells_passing"] > 0.9
    assert truth.position(truth.train[:, :2], truth.poses[:, :2])["position_median_m"] < 0.05


def test_a_map_is_grown_as_told() -> None:
    walk = explore(Arena.load("furnished"), Brownian(), Camera.panoramic(90, 15), views=120, seed=3)
    usual = grow_map(walk, {}, seed=3)
    assert (usual.charts, usual.seed, usual.place_cells) == (40, 3, 150)
    other = grow_map(walk, {"charts": 30, "place_cells": 20}, seed=3)
    assert (other.charts, other.seed) == (30, 3)
    assert other.perceive(odours=walk.odours).place.shape == (120, 20)


@pytest.mark.parametrize("warning", [UntrustedMapWarning, UserWarning])
def test_only_a_map_that_is_not_trusted_is_left_to_the_metrics(
    monkeypatch: pytest.MonkeyPatch, warning: type[Warning]
) -> None:
    def look(*_: object) -> Activity:
        warnings.warn("this map is not to be trusted", warning, stacklevel=1)
        return Activity(
            *(np.zeros((1, 2), np.float32) for _ in range(2)),
            np.zeros(1, np.float32),
            *(np.zeros((1, 2), np.float32) for _ in range(2)),
        )

    monkeypatch.setattr(CognitiveMap, "perceive", look)
    if warning is UserWarning:
        with pytest.warns(UserWarning, match="trusted"):
            perceive(CognitiveMap(), None)
    else:
        perceive(CognitiveMap(), None)
