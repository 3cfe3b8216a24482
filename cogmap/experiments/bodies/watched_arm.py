"""An arm before a fixed eye."""

from dataclasses import replace

from arena import Arm, Overhead
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.bodies.body_trial import BodyTrial
from cogmap.experiments.bodies.shoulder_sense import shoulder_split


@experiment(room="furnished", views=12_000, takes=("body", "camera"), body="arm")
def watched_arm(conditions: Conditions) -> Result:
    """Two joints of an arm that is watched from above: a body that is seen, not felt."""
    trial = BodyTrial.of(conditions, Arm(), Overhead(64, 64, noise=0.01))
    result = trial.result("watched arm")
    return replace(result, metrics={**result.metrics, **shoulder_split(trial, conditions.seed)})
