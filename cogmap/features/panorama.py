"""Panorama codes: points whose distance is that of the poses they were taken from, up to scale."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.utils.validation import check_is_fitted

from cogmap.features.compass import misfit, synchronise_headings, turns
from cogmap.features.strips import Strips, strips
from cogmap.features.turn_invariant import turn_invariant_axes
from cogmap.graph.knn import nearest_points
from cogmap.graph.spots import spot_graph
from cogmap.inputs import checked_count
from cogmap.threads import one_thread

FIT = 5
"""Nearest known views that tell how known another is, and its heading where nothing weighs them."""


class Compared(NamedTuple):
    """What known views tell of others."""

    headings: Float[np.ndarray, "views"]
    """rad."""
    misfit: Float[np.ndarray, "views"]
    """Of the known one that fits best (`compass.misfit`), among the nearest."""


class Turned(NamedTuple):
    """By how much known views have to be turned to look as others do."""

    turns: Float[np.ndarray, "views near"]
    """Heading of the other minus that of the known view, rad in (−π, π]."""
    misfit: Float[np.ndarray, "views"]
    """As in `Compared`."""


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
        Near places that agree with each on north.

    Attributes
    ----------
    headings_ : array (views,)
        θ in rad, in a frame of their own.
    places_ : array (views, components)
        z.

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
        seen = strips(X)
        count = len(seen.turn_invariant)
        components = checked_count("components", self.components)
        neighbours = min(checked_count("neighbours", self.neighbours), count - 1)
        with one_thread():
            axes = turn_invariant_axes(seen.turn_invariant, components)
            found = axes.transform(seen.turn_invariant).astype(np.float64)
            scale = 1 / np.sqrt(found.var(axis=0).sum())
            self.places_ = scale * found
            # in the order in which they are stored: products round otherwise in another
            self._axes = np.ascontiguousarray(axes.components_)
            self._mean, self._scale, self._grey = axes.mean_, scale, seen.grey
            graph = spot_graph(self.places_, neighbours)
            edges = np.column_stack(sp.triu(graph, 1).nonzero())
            self.headings_ = synchronise_headings(graph, edges, turns(seen.grey, edges))
        return self._features(self.places_, self.headings_)

    def transform(self, X: Any) -> Float[np.ndarray, "views features"]:
        """Give the features of other panoramas."""
        check_is_fitted(self)
        test = strips(X)
        places = self.place(test)
        nearest = nearest_points(self.places_, min(FIT, len(self.places_)), queries=places).indices
        return self._features(places, self.heading(test, nearest))

    def place(self, seen: Strips) -> Float[np.ndarray, "views components"]:
        """Give z of other panoramas."""
        with one_thread():
            found = (seen.turn_invariant - self._mean) @ self._axes.T
        return np.asarray(self._scale * found.astype(np.float64))

    def heading(self, seen: Strips, nearest: Int[np.ndarray, "views near"]) -> Float[np.ndarray, "views"]:
        """Give θ of other panoramas, rad, as the mean of what these known views near each tell of it."""
        return self.compare(seen, nearest).headings

    def compare(
        self,
        seen: Strips,
        nearest: Int[np.ndarray, "views near"],
        weights: Float[np.ndarray, "views near"] | None = None,
    ) -> Compared:
        """Turn known views to other panoramas, and see how well the nearest of them fit.

        A turn is the more wrong the farther the known view is, and wrong the other way on the other side:
        affine weights (`affine_weights`) cancel that. All count alike when None.
        """
        turned, unlike = self.turn(seen, nearest)
        told = np.exp(1j * (self.headings_[nearest] + turned))
        heading = np.angle((told if weights is None else weights * told).sum(axis=1))
        return Compared(np.asarray(heading), unlike)

    def turn(self, seen: Strips, nearest: Int[np.ndarray, "views near"]) -> Turned:
        """Turn known views to other panoramas, and see how well the nearest of them fit."""
        pairs = np.column_stack([np.repeat(np.arange(len(nearest)), nearest.shape[1]), nearest.ravel()])
        with one_thread():
            turned = turns(seen.grey, pairs, self._grey)
            fits = np.arange(len(pairs)).reshape(nearest.shape)[:, :FIT].ravel()
            unlike = misfit(seen.grey, pairs[fits], turned[fits], self._grey).reshape(len(nearest), -1)
        return Turned(turned.reshape(nearest.shape), unlike.min(axis=1))

    def compare_known(self, pairs: Int[np.ndarray, "pairs 2"]) -> Compared:
        """Give by how much the first of near known views is turned from the second, and their misfit."""
        with one_thread():
            turned = turns(self._grey, pairs)
            return Compared(turned, misfit(self._grey, pairs, turned))

    def state(self) -> dict[str, np.ndarray]:
        """Give all that was learnt, by name; complex numbers as pairs of real ones."""
        check_is_fitted(self)
        grey = self._grey.view(np.float32).reshape(*self._grey.shape, 2)
        return {
            "mean": self._mean,
            "axes": self._axes,
            "scale": np.array(self._scale),
            "places": self.places_,
            "headings": self.headings_,
            "grey": grey,
        }

    @classmethod
    def from_state(cls, state: Mapping[str, np.ndarray]) -> "PanoramaCode":
        """Make a code of what `state` gave."""
        code = cls(len(state["axes"]))
        code._mean, code._axes, code._scale = state["mean"], state["axes"], float(state["scale"])
        code.places_, code.headings_ = state["places"], state["headings"]
        code._grey = state["grey"].view(np.complex64)[..., 0]
        return code

    def _features(
        self, places: Float[np.ndarray, "views components"], headings: Float[np.ndarray, "views"]
    ) -> Float[np.ndarray, "views features"]:
        ahead = self.turning * np.column_stack([np.cos(headings), np.sin(headings)])
        return np.column_stack([places, ahead])
