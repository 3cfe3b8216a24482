"""Three links: an arm whose hand sees alike with its elbow to either side."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float, Int

from arena import Arm, Axis, Body, Camera, Recording
from arena.angles import wrap_angle
from arena.bodies.base import POSE
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.bodies.body_trial import BodyTrial, Truth, all_axes
from cogmap.graph import nearest_points
from cogmap.plots import plot_look_alikes

APART = 1.0
"""Difference of joints (rad) from which on postures are not the same."""


@experiment(room="furnished", views=24_000, takes=("body", "camera"), body="arm")
def three_links(conditions: Conditions) -> Result:
    """Where visual distinguishability fails: two postures for one image, and what is found all the same.

    The manifold of views is that of the hand's poses, an annulus times a circle, not the three joints' torus.
    Figures are of the hand; `ambiguous_share` of the views have a look-alike in another posture, and
    `posture_median_deg` is what reading joints from them comes to.
    """
    body, eye = Arm(links=(0.7, 0.6, 0.5)), Camera.panoramic(90, 15, noise=0.01)
    trial = BodyTrial.of(conditions, body, eye, truth=hand)
    postures = replace(trial, truth=all_axes)
    pairs = look_alikes(trial.coordinates.codes_, postures.joints)
    # more alike than those that are kept, which are as far from each other as can be
    joints = trial.walk.require("joints")
    alike = look_alikes(trial.coordinates.encode(trial.walk.views), joints)
    # pairs that are not each other's
    shown = alike[np.linspace(0, len(alike) // 100, min(3, len(alike))).astype(int)]
    result = trial.result("three links")
    metrics = {
        **result.metrics,
        "ambiguous_share": len(pairs) / len(trial.kept),
        "posture_median_deg": postures.metrics["joint_median_deg"],
    }
    if not len(shown):
        return replace(result, metrics=metrics)
    segments = trial.body.segments(joints[shown.ravel()])
    figure = plot_look_alikes(
        segments.reshape(len(shown), 2, -1, 2, 2), np.stack([trial.walk.views[view] for view in shown])
    )
    return replace(
        result,
        metrics=metrics,
        figures={**result.figures, "look_alikes": figure},
        captions={**result.captions, "look_alikes": "Postures that differ, and what is seen in both"},
    )


def hand(body: Body, recording: Recording) -> Truth:
    """Take the pose of the hand for what is seen."""
    del body
    axes: tuple[Axis, ...] = POSE
    return axes, recording.require("poses")


def look_alikes(
    codes: Float[np.ndarray, "views components"], joints: Float[np.ndarray, "views joints"]
) -> Int[np.ndarray, "pairs 2"]:
    """Pair views with one of their five nearest whose joints (rad) differ by more than `APART`, if any.

    Those most alike come first.
    """
    near, distances = nearest_points(codes, 5)
    apart = np.abs(wrap_angle(joints[near] - joints[:, None])).max(axis=2)
    found = np.flatnonzero(apart.max(axis=1) > APART)
    which = (apart[found] > APART).argmax(axis=1)
    order = np.argsort(distances[found, which], kind="stable")
    return np.column_stack([found, near[found, which]])[order]
