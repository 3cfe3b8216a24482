import numpy as np
import pytest

from arena import Arena, Babble, Camera, Rail, Turntable, explore
from cogmap.experiments import Conditions
from cogmap.experiments.bodies.body_trial import BodyTrial

EYE = Camera.panoramic(45, 8, noise=0.01)


@pytest.fixture(scope="module")
def trial() -> BodyTrial:
    conditions = Conditions(Arena.load("furnished"), 1600, seed=2)
    return BodyTrial.of(conditions, Turntable(), EYE)


def test_a_turntable_is_a_circle(trial: BodyTrial) -> None:
    metrics = trial.metrics
    assert (metrics["dimension"], metrics["betti"], metrics["memory_views"]) == (1, [1, 1, 0], 400)
    assert metrics["eye"] == "panorama"
    assert metrics["joint_median_deg"][0] < 0.5
    assert metrics["regression_median_deg"][0] < 1.5
    assert abs(metrics["windings_determinant"]) == 1


def test_what_is_scored_is_what_was_kept(trial: BodyTrial) -> None:
    walk = explore(Arena.load("furnished"), Babble(), EYE, body=Turntable(), views=1600, seed=2)
    np.testing.assert_array_equal(trial.walk.require("joints"), walk.require("joints"))
    np.testing.assert_array_equal(trial.joints, walk.require("joints")[trial.coordinates.indices_])
    np.testing.assert_array_equal(trial.kept.views, walk.views[trial.coordinates.indices_])
    assert not np.array_equal(trial.fresh.require("joints"), trial.walk.require("joints"))


def test_figures_and_table(trial: BodyTrial) -> None:
    result = trial.result("turntable")
    assert result.figures.keys() == {"barcodes", "coordinates"}
    table = result.tables["kept_views"]
    assert list(table) == ["angle", "phase_0"]
    assert len(table) == 400


def test_body_of_the_conditions_goes_first() -> None:
    conditions = Conditions(Arena.load("furnished"), 400, body=Rail(length=1.0))
    trial = BodyTrial.of(conditions, Turntable(), EYE)
    assert [axis.name for axis in trial.axes] == ["position"]
    assert trial.metrics["joints"] == ["position"]
    assert trial.joints.max() <= 1
