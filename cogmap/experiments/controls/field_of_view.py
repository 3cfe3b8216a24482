"""Field of view: what becomes of the map where the eye does not look all around."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from arena import Camera
from cogmap.cells import fit_heading_frame, heading_errors
from cogmap.evaluation.populations import trust_report
from cogmap.experiments import Conditions, Result, Trial, experiment, pose_errors
from cogmap.experiments.paper.localisation import interpolated_poses
from cogmap.navigation import Localiser
from cogmap.plots import plot_compass
from cogmap.shape import betti


@experiment(room="furnished", views=17_000, takes=("nose", "motion", "body", "map"))
def field_of_view(
    conditions: Conditions, *, degrees: tuple[float, ...] = (120.0, 90.0), rows: int = 120
) -> Result:
    """Learn the same walk through a panoramic eye, and through perspective ones of so many degrees.

    Of each eye: degrees of freedom and Betti numbers of the view manifold, of the views that were learnt; how
    far from the true pose fresh views are that are placed by the nearest code, and among codes by affine
    weights (`localised`); both populations; and whether the map is to be trusted.

    Walking shifts the picture of a perspective eye as turning does, and by how much depends on where it
    looks. So what the charts take for turning, the direction in which smell stays the same, is right in each
    chart but no angle: its integral around a place is off by some ten degrees and closes all the same, so
    that no agreement of charts can tell.

    Parameters
    ----------
    conditions
        As of every experiment.
    degrees
        Horizontal fields of view, less than 180.
    rows
        Pixels of a perspective view; square ones, 4 to 3 at 90°.
    """
    eyes = {"panorama": Camera.panoramic()} | {
        f"perspective_{angle:g}": Camera.perspective(
            round(rows * 4 / 3 * np.tan(np.deg2rad(angle) / 2)), rows, field_of_view=np.deg2rad(angle)
        )
        for angle in degrees
    }
    found: dict[str, dict[str, Any]] = {}
    drawn: dict[str, Figure] = {}
    for name, eye in eyes.items():
        trial = Trial.of(conditions, camera=eye)
        found[name] = _measured(trial)
        drawn |= _compass(name, trial)
    table = pd.DataFrame([{"eye": name, **figures} for name, figures in found.items()])
    captions = dict.fromkeys(drawn, "Learnt against true heading, the same colour for the same direction")
    return Result(found, tables={"eyes": table}, figures=drawn, captions=captions)


def _measured(trial: Trial) -> dict[str, Any]:
    cmap, (train, fresh) = trial.cmap, trial.codes
    holes = betti(train, seed=trial.conditions.seed)
    truth, poses = trial.truth.train, trial.truth.poses
    location = Localiser(train, metric="euclidean").locate(fresh)
    placed = {"nearest_": truth[location.indices[:, 0]], "localised_": interpolated_poses(location, truth)}
    return {
        "eye_found": cmap.eye_,
        "dimension": cmap.dimension_,
        "dimension_vote": cmap.vote_,
        "betti": list(holes.numbers),
        "betti_resolved": list(holes.resolved),
        **{
            name.replace("error", "median"): float(np.median(error))
            for prefix, read in placed.items()
            for name, error in pose_errors(read, poses, prefix).items()
        },
        **trial.figures,
        **trust_report(cmap),
    }


def _compass(name: str, trial: Trial) -> dict[str, Figure]:
    """Draw learnt against true headings; nothing without a compass."""
    truth, poses = trial.truth.train, trial.truth.poses
    phase = trial.test.phase
    if np.isnan(phase).all():
        return {}
    frame = fit_heading_frame(trial.train.phase, truth[:, 2])
    aligned = poses[:, 2] + heading_errors(phase, poses[:, 2], frame)
    return {f"compass_{name}": plot_compass(aligned, poses[:, 2], poses[:, :2])}
