"""An arm with an eye on its hand."""

from arena import Arm, Camera
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.bodies.body_trial import BodyTrial
from cogmap.experiments.bodies.joint_reaching import joint_reaching
from cogmap.experiments.bodies.shoulder_sense import shoulder_split


@experiment(room="furnished", views=12_000, takes=("body", "camera"), body="arm")
def arm(conditions: Conditions) -> Result:
    """Two joints from what their hand sees: a torus, a cylinder or a disc, by how many have limits."""
    eye = Camera.panoramic(90, 15, noise=0.01)
    trial = BodyTrial.of(conditions, Arm(), eye)
    result = trial.result("arm").joined(Result(shoulder_split(trial, conditions.seed)))
    return result.joined(joint_reaching(trial, conditions, eye))
