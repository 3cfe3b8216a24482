"""A brownian walk all over the room: the images lie on a solid torus of position and heading."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from sklearn.metrics import r2_score
from sklearn.neighbors import KNeighborsRegressor

from arena import Brownian, Camera
from arena.angles import wrap_angle
from cogmap import plots
from cogmap.evaluation.quasi_metric import quasi_metric
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.paper.view_manifold import view_manifold
from cogmap.shape import LandmarkIsomap


@experiment(room="furnished", views=17_000)
def brownian(conditions: Conditions, *, components: int = 4, held_out: float = 0.1) -> Result:
    """Figs. 3 and 6: find the solid torus, and read poses off four coordinates of it.

    One view in ten is held out of the embedding and placed in it afterwards; `position_r2` is the share of
    the variance of x and y of these views that the poses of their ten nearest others in the embedding tell.
    Four `components` are the least number of dimensions in which R²×S¹ lies without crossing itself or being
    folded; `held_out` is a share of the views.
    """
    walk = conditions.explore(Brownian(), Camera.perspective())
    poses = walk.require("poses")
    found = view_manifold(walk.views, conditions)
    order = np.random.default_rng(conditions.seed).permutation(len(poses))
    held, train = np.split(order, [round(held_out * len(poses))])
    isomap = LandmarkIsomap(components, metric="cosine", averaging=True, seed=conditions.seed)
    read = _read_poses(
        isomap.fit_transform(found.words[train]), poses[train], isomap.transform(found.words[held])
    )
    truth = poses[held]
    turn = wrap_angle(read[:, 2] - truth[:, 2])
    near = quasi_metric(found.graph, poses, conditions.seed)
    shape = found.metrics(poses)
    places = {"x (m)": poses[:, 0], "y (m)": poses[:, 1]}
    return Result(
        metrics={
            "position_r2": r2_score(truth[:, :2], read[:, :2], multioutput="raw_values").tolist(),
            "position_median_m": float(np.median(np.linalg.norm(read[:, :2] - truth[:, :2], axis=1))),
            **shape,
            "loop_resultant": shape["heading_resultant"],
            "heading_resultant": float(abs(np.exp(1j * turn).mean())),
            "heading_median_deg": float(np.rad2deg(np.median(abs(turn)))),
            **near.metrics,
        },
        tables={"views": found.table(poses), "distances": near.pairs, "places": near.places},
        figures={
            "room": plots.plot_room(conditions.room, poses),
            "torus": plots.plot_embedding(found.embedding, poses[:, 2], places),
            "torus_fourth": plots.plot_embedding(found.embedding, poses[:, 2], places, coordinates=(0, 1, 3)),
            "heading": plots.plot_compass(read[:, 2], truth[:, 2], truth[:, :2]),
            "position": plots.plot_position(read[:, :2], truth[:, :2]),
            "distances": plots.plot_quasi_metric(near.pairs, near.places),
            "barcodes": plots.plot_barcodes({"images of a walk": found.shape}),
        },
        captions={
            "torus": "The first three coordinates of the views, coloured by heading and by place",
            "torus_fourth": "The first, second and fourth coordinate, coloured by heading and by place",
            "position": "Position read off the views against the true one",
        },
    )


def _read_poses(
    train: Float[np.ndarray, "train components"],
    poses: Float[np.ndarray, "train 3"],
    held: Float[np.ndarray, "views components"],
    neighbours: int = 10,
) -> Float[np.ndarray, "views 3"]:
    """Mean pose of the nearest views in the embedding, weighted by 1 / distance."""
    target = np.column_stack([poses[:, :2], np.cos(poses[:, 2]), np.sin(poses[:, 2])])
    reader = KNeighborsRegressor(neighbours, weights="distance").fit(train, target)
    x, y, cosine, sine = reader.predict(held).T
    return np.column_stack([x, y, np.arctan2(sine, cosine)])
