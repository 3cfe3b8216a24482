"""The charts' linear decoder: how views change with pose across each chart of a map."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, Float32, Float64, Int, UInt8
from scipy.spatial import KDTree
from sklearn.utils import gen_batches

from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.graph.knn import nearest_points
from cogmap.imagination.alignment import coarse, coarse_size
from cogmap.imagination.turning import Painted
from cogmap.imagination.warp import averaged, sampled
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.threads import one_thread

WINNERS = 4
"""Charts that learn from a view, and charts that a view is mixed of."""
RIDGE = 0.03
"""Of the slopes, in units of the usual variance of pose across a chart."""
BATCH = 1000
"""Views learnt together; fixed, so that the same views give the same sums."""


class _Mixture(NamedTuple):
    """Charts that speak of each target."""

    chart: Int[np.ndarray, "targets winners"]
    weight: Float32[np.ndarray, "targets winners"]
    readout: Float32[np.ndarray, "targets winners 4"]
    """By which the sums of a chart become what it says."""


@dataclass(eq=False)
class ChartDecoder:
    r"""Decodes views from poses: in each chart of a map a ridge regression of pixels on pose.

    A panorama v, averaged down to 90 columns, that was seen at the pose (x, y, θ) in the frame of the map is
    learnt by the four charts k nearest to its code, as sums over views

    .. math:: G_k = \sum f f^\top,\quad X_k = \sum f\,v^\top,\qquad f = (1, x, y, θ - φ_k)^\top,

    φ_k being the chart's own heading. What is seen from a pose is mixed of what the four charts say whose
    views are nearest to it, in units of the usual breadth of a chart. So it is blurred, and quick; it needs
    no memory of views, and two decoders of one map merge by adding. The sums take 194 MB for 3,000 charts and
    views of 6:1.

    Parameters
    ----------
    centres, phases
        Of the charts: codes, and headings in the frame of the map.
    view_shape
        (height, width, 3) of the views.
    gram, cross
        The sums G and X.

    References
    ----------
    Roweis, Saul & Hinton (2002), Global coordination of local linear models. NIPS 14.
    """

    centres: Float32[np.ndarray, "charts components"]
    phases: Float32[np.ndarray, "charts"]
    view_shape: tuple[int, int, int]
    gram: Float64[np.ndarray, "charts 4 4"]
    cross: Float32[np.ndarray, "charts 4 values"]

    @classmethod
    def learn(cls, cmap: CognitiveMap, views: Any, poses: Float[np.ndarray, "views 3"]) -> ChartDecoder:
        """Learn from views and the poses (x, y, phase) at which the map perceives them."""
        state = cmap.state_dict()
        centres, phases = (state[name].cpu().numpy() for name in ("charts.centres", "readout.phases"))
        shape = (int(views.shape[1]), int(views.shape[2]), 3)
        rows, columns = coarse_size(*shape[:2])
        gram = np.zeros((len(phases), 4, 4))
        cross = np.zeros((len(phases), 4, rows * columns * 3), np.float32)
        decoder = cls(centres, phases, shape, gram, cross)
        with one_thread():
            for batch in gen_batches(len(poses), BATCH):
                decoder._add(cmap.encode(views[batch]), views[batch], poses[batch])
        return decoder

    def merge(self, other: ChartDecoder) -> ChartDecoder:
        """Add what another decoder, of the same charts, has learnt from other views.

        Raises
        ------
        CogmapError
            When the other is of another map, or of views of another size.
        """
        same = np.array_equal(self.centres, other.centres) and np.array_equal(self.phases, other.phases)
        if not same or self.view_shape != other.view_shape:
            raise CogmapError("these decoders are of different maps or cameras; merge those of one map")
        self.gram += other.gram
        self.cross += other.cross
        return self

    def paint(self, poses: Float[np.ndarray, "targets 3"]) -> Iterator[Painted]:
        """Decode views from poses in the frame of the map, one after the other."""
        mixture = self._mixture(poses)
        with one_thread():
            for chart, weight, readout in zip(*mixture, strict=True):
                said = np.einsum("cf,cfv->cv", readout, self.cross[chart])
                yield averaged(np.stack([self._enlarged(view) for view in said]), weight)

    def _add(
        self,
        codes: Float32[np.ndarray, "views components"],
        views: UInt8[np.ndarray, "views height width 3"],
        poses: Float[np.ndarray, "views 3"],
    ) -> None:
        small = np.stack([coarse(view) for view in views])
        nearest = nearest_points(self.centres, min(WINNERS, len(self.centres)), queries=codes).indices
        chart, view = nearest.ravel(), np.arange(len(views)).repeat(nearest.shape[1])
        pose = poses[view]
        # a chart is a small part of a turn, so that what is left needs no circle
        pose[:, 2] = wrap_angle(pose[:, 2] - self.phases[chart])
        design = np.column_stack([np.ones(len(pose)), pose])
        order = np.argsort(chart, kind="stable")
        for rows in np.split(order, np.flatnonzero(np.diff(chart[order])) + 1):
            f = design[rows].T
            self.gram[chart[rows[0]]] += f @ f.T
            self.cross[chart[rows[0]]] += f.astype(np.float32) @ small[view[rows]]

    def _mixture(self, poses: Float[np.ndarray, "targets 3"]) -> _Mixture:
        """Choose charts, and solve their regressions for the targets alone."""
        heard = np.flatnonzero(self.gram[:, 0, 0])
        mass = self.gram[heard, 0, 0]
        mean = self.gram[heard, 0, 1:] / mass[:, None]
        covariance = self.gram[heard, 1:, 1:] / mass[:, None, None] - mean[:, :, None] * mean[:, None]
        variance = np.median(np.diagonal(covariance, axis1=1, axis2=2), axis=0) + 1e-9
        variance[:2] = variance[:2].mean()
        centre = mean.copy()
        centre[:, 2] += self.phases[heard]
        tree = KDTree(_scaled(centre, variance))
        count = np.arange(1, min(WINNERS, len(heard)) + 1)
        distance, near = (np.asarray(part) for part in tree.query(_scaled(poses, variance), k=count))
        # beyond all charts the nearest still speaks
        weight = np.exp((np.square(distance[:, :1]) - np.square(distance)) / 4)
        offset = poses[:, None] - centre[near]
        offset[:, :, 2] = wrap_angle(offset[:, :, 2])
        spread = covariance[near] + RIDGE * np.diag(variance)
        slopes = np.linalg.solve(spread, offset[:, :, :, None])[:, :, :, 0]
        readout = np.concatenate([1 - (slopes * mean[near]).sum(axis=2, keepdims=True), slopes], axis=2)
        return _Mixture(
            heard[near],
            np.asarray(weight / weight.sum(axis=1, keepdims=True), np.float32),
            np.asarray(readout / mass[near][:, :, None], np.float32),
        )

    def _enlarged(self, view: Float32[np.ndarray, "values"]) -> Float32[np.ndarray, "height width 3"]:
        height, width, _ = self.view_shape
        rows, columns = coarse_size(height, width)
        y, x = np.mgrid[:height, :width].astype(np.float32) + np.float32(0.5)
        where = np.stack([x * (columns / width), y * (rows / height)], axis=2) - np.float32(0.5)
        return sampled(view.reshape(rows, columns, 3), where, cv2.INTER_CUBIC)


def _scaled(
    poses: Float[np.ndarray, "poses 3"], variance: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "poses 4"]:
    """Lay poses where distances are in units of what is usual across a chart, heading on a circle."""
    place, heading = poses[:, :2] / np.sqrt(variance[:2]), poses[:, 2]
    return np.column_stack(
        [place, np.column_stack([np.cos(heading), np.sin(heading)]) / np.sqrt(variance[2])]
    )
