"""Cyclic motion, to and fro with spins: the images lie on a cylinder of heading and translation."""

from __future__ import annotations

import numpy as np

from arena import Camera, Cyclic
from cogmap import plots
from cogmap.evaluation.quasi_metric import quasi_metric
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.paper.view_manifold import view_manifold
from cogmap.shape import height_coordinate


@experiment(room="furnished", views=4_000)
def cyclic(conditions: Conditions) -> Result:
    """Figs. 4 and 5: find the cylinder, the angle around it and the height along it.

    `translation_r2` is the squared correlation of the height with the distance along the way that the body
    went to and fro on, which is the first principal axis of its positions.
    """
    walk = conditions.explore(Cyclic(), Camera.perspective())
    poses = walk.require("poses")
    found = view_manifold(walk.views, conditions)
    # The two ends of the cylinder show in four coordinates; later ones bend it.
    height = height_coordinate(found.graph, found.embedding[:, :4], found.phase)
    along = _along_the_way(poses[:, :2])
    known = np.isfinite(height)
    near = quasi_metric(found.graph, poses, conditions.seed)
    table = found.table(poses).assign(along_m=along, height=height)
    return Result(
        metrics={
            "translation_r2": float(np.corrcoef(height[known], along[known])[0, 1] ** 2),
            **found.metrics(poses),
            **near.metrics,
        },
        tables={"views": table, "distances": near.pairs, "places": near.places},
        figures={
            "walk": plots.plot_walk(conditions.room, walk.times, poses),
            "cylinder": plots.plot_embedding(found.embedding, poses[:, 2], {"translation (m)": along}),
            "heading": plots.plot_compass(
                table["loop_rad"].to_numpy()[known], poses[known, 2], poses[known, :2]
            ),
            "translation": plots.plot_translation(height[known], along[known], poses[known, 2]),
            "distances": plots.plot_quasi_metric(near.pairs, near.places),
            "barcodes": plots.plot_barcodes({"images of a run to and fro": found.shape}),
        },
        captions={
            "walk": "The way through the room, and place and heading over time",
            "cylinder": "Coordinates on the manifold, coloured by heading and by place along the way",
            "translation": "Coordinate along the cylinder against place along the way",
        },
    )


def _along_the_way(positions: np.ndarray) -> np.ndarray:
    """Distance from the middle of the way along its direction, m."""
    centred = positions - positions.mean(axis=0)
    axis = np.linalg.svd(centred.T @ centred)[0][:, 0]
    along: np.ndarray = centred @ axis
    return along
