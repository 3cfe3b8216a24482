import warnings

import numpy as np
import pytest

from arena import Arena, Brownian, Camera, Disc, explore
from cogmap import Activity, CognitiveMap, UntrustedMapWarning
from cogmap.evaluation.ground_truth import GroundTruth
from cogmap.evaluation.populations import competing_cells, grow_map, perceive, reachable_places


def test_cells_that_compete_for_places_are_place_cells() -> None:
    room, rng = Arena.load("open_field"), np.random.default_rng(0)
    train, poses = (
        np.column_stack([room.sample_free(4000, 0.18, rng), rng.uniform(-np.pi, np.pi, 4000)])
        for _ in range(2)
    )
    truth = GroundTruth(train, poses, reachable_places(room, Disc()))
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


def test_a_small_body_reaches_more() -> None:
    room = Arena.load("open_field")
    small, large = (np.ptp(reachable_places(room, Disc(radius=radius)), axis=0) for radius in (0.05, 0.4))
    assert (small - large > 0.6).all()


@pytest.mark.parametrize("warning", [UntrustedMapWarning, UserWarning])
def test_only_a_map_that_is_not_trusted_is_left_to_the_metrics(
    monkeypatch: pytest.MonkeyPatch, warning: type[Warning]
) -> None:
    def look(*_: object, odours: None) -> Activity:
        assert odours is None
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
