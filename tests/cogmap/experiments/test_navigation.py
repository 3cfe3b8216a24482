from unittest.mock import patch

import numpy as np
import pandas as pd

from arena import Arena
from cogmap.experiments import roadmap as module
from cogmap.experiments.localisation import interpolated_poses, localisation
from cogmap.experiments.roadmap import draw_pairs, roadmap
from cogmap.experiments.setting import Setting
from cogmap.navigation import Location


def test_headings_are_interpolated_across_the_cut() -> None:
    poses = np.array([[0.0, 0, np.pi - 0.1], [1, 2, 0.1 - np.pi]])
    location = Location(np.array([[0, 1]]), np.array([[0.25, 0.75]]))
    np.testing.assert_allclose(interpolated_poses(location, poses), [[0.75, 1.5, 0.05 - np.pi]])


def test_pairs_are_apart_free_and_those_of_the_seed() -> None:
    room = Arena.load("obstacles")
    pairs = draw_pairs(room, 0.18, 3)
    np.testing.assert_array_equal(pairs, draw_pairs(room, 0.18, 3))
    assert pairs.shape == (200, 2, 3)
    assert room.is_free(pairs[:, :, :2].reshape(-1, 2), 0.18).all()
    assert np.linalg.norm(pairs[:, 0, :2] - pairs[:, 1, :2], axis=1).min() >= 1


def test_roadmap_gives_what_it_must_show() -> None:
    with patch.object(module, "prm_paths", return_value=None):
        found = roadmap(Setting(Arena.load("obstacles"), 400, seed=0))
    metrics = found.metrics
    assert not metrics["prm"]
    assert "prm_deviation_mean" not in metrics
    assert 0 < metrics["success"] <= 1
    assert 1 <= metrics["length_ratio_median"] < 2.5
    assert 0 < metrics["deviation_mean"] < metrics["deviation_max"]
    assert metrics["query_ms"] < 500
    assert set(found.figures) == {"routes", "images"}
    assert len(found.tables["pairs"]) == 200
    assert isinstance(found.tables["routes"], pd.DataFrame)


def test_localisation_is_better_than_the_nearest_view() -> None:
    found = localisation(Setting(Arena.load("furnished"), 200, seed=0))
    metrics = found.metrics
    assert metrics["placed"] == 1
    assert metrics["position_median_m"] < metrics["nearest_position_median_m"]
    assert metrics["heading_median_deg"] < metrics["nearest_heading_median_deg"]
    assert len(found.tables["views"]) == 200
    assert len(found.tables["neighbours"]) == 25
    assert set(found.figures) == {"neighbours", "errors"}
