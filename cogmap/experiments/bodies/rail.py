"""A rail: one joint that slides."""

from arena import Camera, Rail
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.bodies.body_trial import BodyTrial


@experiment(room="furnished", views=4_000, takes=("body", "camera"), body="rail")
def rail(conditions: Conditions) -> Result:
    """One degree of freedom and no loop: the place of a carriage from what is seen on it."""
    return BodyTrial.of(conditions, Rail(), Camera.panoramic(90, 15, noise=0.01)).result("rail")
