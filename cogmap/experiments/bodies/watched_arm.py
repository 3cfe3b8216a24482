"""An arm before a fixed eye."""

from arena import Arm, Overhead
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.bodies.body_trial import BodyTrial
from cogmap.experiments.bodies.joint_reaching import joint_reaching
from cogmap.experiments.bodies.shoulder_sense import shoulder_split


@experiment(room="furnished", views=12_000, takes=("body", "camera"), body="arm")
def watched_arm(conditions: Conditions) -> Result:
    """Two joints of an arm that is watched from above: a body that is seen, not felt."""
    eye = Overhead(64, 64, noise=0.01)
    trial = BodyTrial.of(conditions, Arm(), eye)
    result = trial.result("watched arm").joined(Result(shoulder_split(trial, conditions.seed)))
    return result.joined(joint_reaching(trial, conditions, eye))
