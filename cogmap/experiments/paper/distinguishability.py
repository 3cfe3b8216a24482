"""Distinguishable views: in a white room opposite corners look the same, and a blue wall tells them apart."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pandas as pd
import torch
from jaxtyping import Float
from sklearn.decomposition import PCA

from arena import Arena, Brownian, Camera
from cogmap.evaluation.pose_agreement import motion_distances
from cogmap.experiments import Conditions, Result, experiment, pose_columns
from cogmap.graph import nearest_points
from cogmap.plots import plot_barcodes, plot_confusion, plot_views
from cogmap.shape import Betti, betti
from cogmap.threads import one_thread
from neurons.layers.retina import Retina

ROOMS = {"white": "white_rectangle", "blue_wall": "blue_wall"}


class _Seen(NamedTuple):
    nearest: pd.DataFrame
    """`x_m`, `y_m`, `heading_rad` of each query, those of its nearest view, and whether it is confused."""
    shape: Betti
    pair: np.ndarray
    poses: np.ndarray
    """A view and that from the opposite pose."""


@experiment(room="white_rectangle", views=17_000, any_room=False)
def distinguishability(conditions: Conditions, *, queries: int = 2000) -> Result:
    """Count how often the view most like a query was taken from about the opposite pose.

    A white rectangle with nothing in it looks the same from (x, y, θ) and from (−x, −y, θ + π); with one wall
    blue it does not. A query is confused when its nearest view lies nearer to the opposite pose than to its
    own. Strips are compared as the retina leaves them, in their principal components; the Betti numbers are
    those of the same codes. `queries` are views of a fresh walk.
    """
    seen = {name: _look(conditions, Arena.load(room), queries) for name, room in ROOMS.items()}
    return Result(
        metrics={
            **{f"confusion_{name}": float(item.nearest["confused"].mean()) for name, item in seen.items()},
            **{f"betti_{name}": list(item.shape.numbers) for name, item in seen.items()},
            **{f"betti_resolved_{name}": list(item.shape.resolved) for name, item in seen.items()},
            **{f"betti_votes_{name}": list(item.shape.votes) for name, item in seen.items()},
        },
        tables={f"nearest_{name}": item.nearest for name, item in seen.items()},
        figures={
            "confusion": plot_confusion({name: item.nearest for name, item in seen.items()}),
            "views": plot_views(
                np.concatenate([item.pair for item in seen.values()]),
                np.concatenate([item.poses for item in seen.values()]),
                2,
            ),
            "barcodes": plot_barcodes({f"{name} room": item.shape for name, item in seen.items()}),
        },
        captions={
            "confusion": "Where the nearest view was taken, turned half round or not",
            "views": "A view of each room, beside that from the opposite pose",
        },
    )


def _look(conditions: Conditions, room: Arena, queries: int) -> _Seen:
    strips = Camera.panoramic()
    here = replace(conditions, room=room)
    walk = here.explore(Brownian(), strips)
    fresh = here.explore(Brownian(), strips, views=min(queries, conditions.views), fresh=True)
    train, test = retina_codes(np.asarray(walk.views), np.asarray(fresh.views), conditions.seed)
    nearest = walk.require("poses")[nearest_points(train, 1, queries=test).indices[:, 0]]
    poses = fresh.require("poses")
    across = opposite(room, poses)
    confused = pose_distances(nearest, across) < pose_distances(nearest, poses)
    first = np.stack([poses[0], across[0]])
    return _Seen(
        nearest=pd.DataFrame(
            {**pose_columns(poses), **pose_columns(nearest, "nearest_"), "confused": confused}
        ),
        shape=betti(train, seed=conditions.seed),
        pair=strips.render(room, first),
        poses=first,
    )


def opposite(room: Arena, poses: Float[np.ndarray, "views 3"]) -> Float[np.ndarray, "views 3"]:
    """Poses after half a turn about the middle of the room."""
    x0, y0, x1, y1 = room.bounds
    turned: np.ndarray = np.array([x0 + x1, y0 + y1, np.pi]) + poses * [-1, -1, 1]
    return turned


def pose_distances(ours: Float[np.ndarray, "views 3"], theirs: Float[np.ndarray, "views 3"]) -> np.ndarray:
    """How far each pose is from the one in the same row, m."""
    return np.array([motion_distances(a[None], b[None])[0, 0] for a, b in zip(ours, theirs, strict=True)])


def retina_codes(
    train: np.ndarray, test: np.ndarray, seed: int, *, components: int = 60, batch: int = 1024
) -> tuple[Float[np.ndarray, "views components"], Float[np.ndarray, "queries components"]]:
    """Give the principal components, of the known views, of what the retina makes of strips."""
    retina = Retina(*train.shape[1:3])
    with one_thread():
        sensed = [
            torch.cat([retina(part) for part in torch.from_numpy(views).split(batch)]).numpy()
            for views in (train, test)
        ]
        pca = PCA(min(components, len(train)), random_state=seed)
        return pca.fit_transform(sensed[0]), pca.transform(sensed[1])
