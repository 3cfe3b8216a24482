"""A sense of one joint: it splits the torus of an arm, as smell splits place from heading."""

from __future__ import annotations

from typing import Any

import numpy as np

from arena.angles import wrap_angle
from cogmap.coordinates.split import split_torus
from cogmap.evaluation.angle_cells import share_of_one_angle
from cogmap.experiments.bodies.body_trial import BodyTrial

NOISE = 0.1
"""Of what the first link feels of its own tilt, as a share of the most it can feel."""


def shoulder_split(trial: BodyTrial, seed: int) -> dict[str, Any]:
    """Let the first link feel its tilt, and measure what the torus splits into; nothing without a torus.

    `shoulder_cells_passing` are those of the phase that is felt, tuned to the first joint alone, and
    `elbow_cells_passing` those of the other phase, tuned to the second joint, or to the angle in space of the
    second link, and not to the first; `elbow_angle` says to which. `sense_ranks` are the directions felt with
    this sense, without any, and with one of both joints.
    """
    found, rng = trial.coordinates, np.random.default_rng(seed)
    if found.coordinates_ is None or found.loops_ != 2 or trial.joints.shape[1] != 2:
        return {}
    shoulder, elbow = trial.joints.T
    nothing = NOISE * rng.standard_normal((len(shoulder), 4))
    tilts = np.column_stack([wave(joint) for joint in (shoulder, elbow) for wave in (np.cos, np.sin)])
    felt, *controls = (
        split_torus(found.codes_, found.coordinates_, sense, seed=seed)
        for sense in ((tilts + nothing)[:, :2], nothing, tilts + nothing)
    )
    figures: dict[str, Any] = {"sense_ranks": [felt.rank, *(control.rank for control in controls)]}
    if felt.felt is None or felt.unfelt is None:
        return figures
    angles = {"joint_2": elbow, "joint_1 + joint_2": wrap_angle(shoulder + elbow)}
    shares = {name: share_of_one_angle(felt.unfelt, angle, shoulder) for name, angle in angles.items()}
    best = max(shares, key=shares.__getitem__)
    return figures | {
        "shoulder_cells_passing": share_of_one_angle(felt.felt, shoulder, elbow),
        "elbow_cells_passing": shares[best],
        "elbow_angle": best,
    }
