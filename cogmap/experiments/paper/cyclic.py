"""Cyclic motion, to and fro with spins: the images lie on a cylinder of heading and translation."""

from __future__ import annotations

import numpy as np

from arena import Camera, Cyclic
from cogmap.evaluation.quasi_metric import quasi_metric
from cogmap.experiments.conditions import Conditions, poses_of
from cogmap.experiments.paper.view_manifold import view_manifold
from cogmap.experiments.registry import experiment
from cogmap.experiments.result import Result
from cogmap.plots import (
    plot_barcodes,
    plot_compass,
    plot_embedding,
    plot_quasi_metric,
    plot_translation,
    plot_walk,
)
from cogmap.shape import height_coordinate


@experiment(room="furnished", views=4_000)
def cyclic(conditions: Conditions) -> Result:
    """Figs. 4 and 5: find the cylinder, the angle around it and the height along it.

    `translation_r2` is the squared correlation of the height with the distance along the way that the body
    went to and fro on, which is the first principal axis of its positions.
    """
    walk = conditions.explore(Cyclic(), Camera.perspective())
    poses = poses_of(walk)
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
            "walk": plot_walk(conditions.room, walk.times, poses),
            "cylinder": plot_embedding(found.embedding, poses[:, 2], {"translation (m)": along}),
            "heading": plot_compass(table["loop_rad"].to_numpy()[known], poses[known, 2], poses[known, :2]),
            "translation": plot_translation(height[known], along[known], poses[known, 2]),
            "distances": plot_quasi_metric(near.pairs, near.places),
            "barcodes": plot_barcodes({"images of a run to and fro": found.shape}),
        },
        captions={
            "walk": "The way through the room, and place and heading over time",
            "cylinder": "Coordinates on the manifold, coloured by heading and by place along the way",
            "heading": "Heading read off the views against the true one",
            "translation": "Coordinate along the cylinder against place along the way",
            "distances": "Distance along the manifold against distance between poses",
            "barcodes": "Bars of loops and voids, each with the threshold above which it counts",
        },
    )


def _along_the_way(positions: np.ndarray) -> np.ndarray:
    """Distance from the middle of the way along its direction, m."""
    centred = positions - positions.mean(axis=0)
    axis = np.linalg.svd(centred.T @ centred)[0][:, 0]
    along: np.ndarray = centred @ axis
    return along
