from dataclasses import replace

import numpy as np
import pytest

from arena import Arena, Camera, Disc, Rotation
from cogmap.cells import position_errors
from cogmap.evaluation.ground_truth import as_one_table
from cogmap.evaluation.scoring import score
from cogmap.experiments import Conditions
from cogmap.experiments.trial import Trial, show_cells

CONDITIONS = Conditions(Arena.load("furnished"), 600, seed=1)


@pytest.fixture(scope="module")
def trial() -> Trial:
    return Trial.of(CONDITIONS, camera=Camera.panoramic(90, 15))


def test_it_is_two_walks_a_map_and_the_truth(trial: Trial) -> None:
    assert len(trial.walk) == len(trial.fresh) == 600
    assert not np.array_equal(trial.walk.require("poses"), trial.fresh.require("poses"))
    np.testing.assert_array_equal(trial.truth.train, trial.walk.require("poses"))
    np.testing.assert_array_equal(trial.truth.poses, trial.fresh.require("poses"))
    assert (trial.cmap.charts, trial.cmap.seed) == (200, 1)
    np.testing.assert_array_equal(trial.codes[1], trial.cmap.encode(trial.fresh.views))
    assert trial.place.rates.shape == trial.test.place.shape
    assert trial.cmap is trial.cmap


def test_its_score_is_that_of_what_is_perceived(trial: Trial) -> None:
    plain = score(
        trial.test,
        trial.truth.poses,
        train=(trial.train, trial.truth.train),
        reachable=trial.truth.reachable,
    )
    assert trial.score == plain
    walked = replace(trial, reachable=None)
    np.testing.assert_array_equal(walked.truth.reachable, trial.truth.train[:, :2])
    assert walked.score == score(trial.test, trial.truth.poses, train=(trial.train, trial.truth.train))


def test_the_nose_alone_is_read_by_the_decoder_of_the_score(trial: Trial) -> None:
    walk, fresh = np.log(trial.walk.odours), np.log(trial.fresh.odours)
    away = position_errors(walk, trial.truth.train[:, :2], fresh, trial.truth.poses[:, :2])
    assert trial.nose_figures["nose_position_median_m"] == np.median(away)
    assert trial.nose_figures["nose_position_p95_m"] == np.percentile(away, 95)


def test_its_figures_are_those_of_both_populations_and_the_score(trial: Trial) -> None:
    assert trial.figures == trial.place.place_figures | trial.heading.heading_figures | trial.score


def test_a_silent_population_is_shown_unless_told(trial: Trial) -> None:
    cells = {"place": trial.place, "mute": trial.truth.measure(0 * trial.place.rates)}
    tables, figures = show_cells(cells)
    assert tables["cells"].equals(as_one_table(cells))
    assert figures.keys() == {"cells", "examples"}
    assert len(figures["examples"].subfigs) == 2
    assert len(show_cells(cells, silent=False)[1]["examples"].subfigs) == 1


def test_another_nose_is_another_map_of_the_same_walks(trial: Trial) -> None:
    other = replace(trial, conditions=replace(CONDITIONS, map={"charts": 50, "place_cells": 20}))
    assert other.walk is trial.walk
    assert other.cmap.charts == 50
    assert other.place.rates.shape[1] == 20


def test_conditions_go_before_what_it_is_told() -> None:
    small = Trial.of(replace(CONDITIONS, views=60, body=Disc(radius=0.05), camera=Camera.panoramic(12, 2)))
    assert small.walk.views.shape == (60, 2, 12, 3)
    usual = Trial.of(replace(CONDITIONS, views=60), Rotation(), camera=Camera.panoramic(12, 2))
    assert small.walk.attributes["body"]["radius"] == 0.05
    assert np.ptp(small.truth.reachable, axis=0).min() > np.ptp(usual.truth.reachable, axis=0).min() + 0.2
    assert np.ptp(usual.walk.require("poses")[:, :2]) < np.ptp(small.walk.require("poses")[:, :2])
