"""An arm with an eye on its hand."""

from dataclasses import replace

from arena import Arm, Camera
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.bodies.body_trial import BodyTrial
from cogmap.experiments.bodies.shoulder_sense import shoulder_split


@experiment(room="furnished", views=12_000, takes=("body", "camera"), body="arm")
def arm(conditions: Conditions) -> Result:
    """Two joints from what their hand sees: a torus, a cylinder or a disc, by how many have limits."""
    trial = BodyTrial.of(conditions, Arm(), Camera.panoramic(90, 15, noise=0.01))
    result = trial.result("arm")
    return replace(result, metrics={**result.metrics, **shoulder_split(trial, conditions.seed)})
