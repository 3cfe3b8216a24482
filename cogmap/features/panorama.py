"""Panorama codes: points whose distance is that of the poses they were taken from, up to scale."""

from typing import Any

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.decomposition import PCA
from sklearn.utils.validation import check_is_fitted

from cogmap.errors import CogmapError
from cogmap.features.compass import synchronise_headings, turns
from cogmap.features.strips import strips
from cogmap.graph.knn import nearest_points
from cogmap.graph.neighbour_graph import neighbour_graph
from cogmap.inputs import checked_count
from cogmap.threads import one_thread


class PanoramaCode(TransformerMixin, BaseEstimator):
    r"""Place and heading of panoramic views, from these views alone.

    A view has the features (z, τ cos θ, τ sin θ). z, which no turn changes, are the principal components of
    the magnitudes of its Fourier series along azimuth, of total variance one over all views. θ is its heading
    from a common north, on which the turns between views from near places (`compass.turns`) agree.

    Turning changes an image far more than walking. Taken apart, both can be weighed against each other.

    Parameters
    ----------
    components
        Of z; fewer when there are fewer views.
    turning
        τ: how much a turn by one rad counts, in standard deviations of z.
    neighbours
        Views from near places that agree on north.

    Attributes
    ----------
    headings_ : array (views,)
        θ in rad, in a frame of their own.

    Raises
    ------
    CogmapError
        For views that are not panoramas or all alike, fewer different ones than neighbours, and counts below
        one.
    """

    def __init__(self, components: int = 40, *, turning: float = 0.65, neighbours: int = 20) -> None:
        self.components = components
        self.turning = turning
        self.neighbours = neighbours

    def fit(self, X: Any, y: object = None) -> "PanoramaCode":
        """Learn components and north from panoramas, uint8 (views, height, width, 3)."""
        self.fit_transform(X, y)
        return self

    def fit_transform(self, X: Any, y: object = None) -> Float[np.ndarray, "views features"]:
        """Learn components and north from panoramas, and give the features of these."""
        del y
        self._train = strips(X)
        count = len(self._train.turn_invariant)
        if not np.ptp(self._train.turn_invariant, axis=0).any():
            raise CogmapError(f"{count} panoramas are all alike; explore more than one place")
        components = min(checked_count("components", self.components), count)
        neighbours = min(checked_count("neighbours", self.neighbours), count - 1)
        with one_thread():
            # 4,000 views are enough for principal components.
            sample = self._train.turn_invariant[:: -(-count // 4000)]
            components = min(components, *sample.shape)
            self._axes = PCA(components, svd_solver="covariance_eigh").fit(sample)
            found = self._axes.transform(self._train.turn_invariant).astype(np.float64)
            self._scale = 1 / np.sqrt(found.var(axis=0).sum())
            self._places = self._scale * found
            graph = neighbour_graph(self._places, neighbours)
            edges = np.column_stack(sp.triu(graph, 1).nonzero())
            self.headings_ = synchronise_headings(graph, edges, turns(self._train, edges))
        return self._features(self._places, self.headings_)

    def transform(self, X: Any) -> Float[np.ndarray, "views features"]:
        """Give the features of other panoramas."""
        check_is_fitted(self)
        test = strips(X)
        with one_thread():
            places = self._scale * self._axes.transform(test.turn_invariant).astype(np.float64)
            # The five nearest known views tell the heading of another.
            nearest = nearest_points(self._places, min(5, len(self._places)), queries=places).indices
            pairs = np.column_stack([np.repeat(np.arange(len(places)), nearest.shape[1]), nearest.ravel()])
            label = self.headings_[pairs[:, 1]] + turns(test, pairs, self._train)
        headings = np.angle(np.exp(1j * label).reshape(nearest.shape).sum(axis=1))
        return self._features(places, headings)

    def _features(
        self, places: Float[np.ndarray, "views components"], headings: Float[np.ndarray, "views"]
    ) -> Float[np.ndarray, "views features"]:
        ahead = self.turning * np.column_stack([np.cos(headings), np.sin(headings)])
        return np.column_stack([places, ahead])
