"""An arm with an eye on its hand."""

from arena import Arm, Camera
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.bodies.body_trial import BodyTrial


@experiment(room="furnished", views=12_000, takes=("body", "camera"), body="arm")
def arm(conditions: Conditions) -> Result:
    """Two joints from what their hand sees: a torus, a cylinder or a disc, by how many have limits."""
    return BodyTrial.of(conditions, Arm(), Camera.panoramic(90, 15, noise=0.01)).result("arm")
