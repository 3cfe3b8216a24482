"""A turntable: one joint that turns all round."""

from arena import Camera, Turntable
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.bodies.body_trial import BodyTrial


@experiment(room="furnished", views=4_000, takes=("body", "camera"), body="turntable")
def turntable(conditions: Conditions) -> Result:
    """One degree of freedom and a loop: the angle of a turntable from what is seen on it."""
    return BodyTrial.of(conditions, Turntable(), Camera.panoramic(90, 15, noise=0.01)).result("turntable")
