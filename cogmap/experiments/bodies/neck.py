"""A neck: a base and a head, one joint more than the eye can tell unless it sees its own deck."""

import numpy as np

from arena import Axis, Body, Camera, Neck, Recording
from arena.angles import wrap_angle
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.bodies.body_trial import BodyTrial, Truth, all_axes


@experiment(room="furnished", views=24_000, takes=("body", "camera"), body="neck")
def neck(conditions: Conditions) -> Result:
    """See only the sum of two joints of a redundant mechanism, until it sees its own deck."""
    eye = Camera.panoramic(90, 15, noise=0.01)
    return BodyTrial.of(conditions, Neck(), eye, truth=visible_axes).result("neck")


def visible_axes(body: Body, recording: Recording) -> Truth:
    """Tell place and gaze, base and pan together, or all four axes where the deck is seen."""
    axes, joints = all_axes(body, recording)
    if isinstance(body, Neck) and body.deck == "seen":
        return axes, joints
    gaze = wrap_angle(joints[:, 2] + joints[:, 3])
    return (*axes[:2], Axis("gaze", "circle", "rad")), np.column_stack([joints[:, :2], gaze])
