"""Visual smell: a second sense made of panoramas themselves, which turning leaves alone."""

from typing import Any

import numpy as np
from jaxtyping import Float32
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.utils.validation import check_is_fitted

from cogmap.errors import CogmapError
from cogmap.features.seam import seam_is_open
from cogmap.features.strips import strips
from cogmap.features.turn_invariant import turn_invariant_axes
from cogmap.inputs import checked_count
from cogmap.threads import one_thread


class VisualSmell(TransformerMixin, BaseEstimator):
    r"""A second sense for an explorer that has a panoramic camera and no nose.

    A turn shifts the columns of a panorama, and leaves the magnitudes of its Fourier series along azimuth as
    they are. Their first principal components z tell place and not heading, as smell does, so that

    .. math:: o = e^{z / s}, \qquad s^2 = \sum_i \operatorname{var} z_i

    can be given to a `CognitiveMap` where odours are asked for. Both senses are then of one eye: in rooms
    where places look alike neither tells them apart, and the map's guard has only walking to go by.

    Parameters
    ----------
    components
        Odorants. In `furnished` a map by three heads 1.0° wrong (median), by four and by six .85°.

    Attributes
    ----------
    scale_
        s, of the views that it was fitted to.

    Raises
    ------
    CogmapError
        For views that are not panoramas, or all alike, and counts below one.

    Examples
    --------
    >>> odours = VisualSmell().fit_transform(recording.views)
    >>> cmap = CognitiveMap().fit(recording.views, odours)
    """

    def __init__(self, components: int = 4) -> None:
        self.components = components

    def fit(self, X: Any, y: object = None) -> "VisualSmell":
        """Learn the components of panoramas, uint8 (views, height, width, 3), in an array or lazy."""
        self.fit_transform(X, y)
        return self

    def fit_transform(self, X: Any, y: object = None) -> Float32[np.ndarray, "views odorants"]:
        """Learn the components of panoramas, and give what these smell of, all > 0."""
        del y
        components = checked_count("components", self.components)
        seen = strips(X).turn_invariant
        if seam_is_open(X):
            raise CogmapError(
                "these views do not look all around, and of others a turn changes everything; give "
                "panoramas, or another signal that knows place but not heading"
            )
        with one_thread():
            self._axes = turn_invariant_axes(seen, components)
            found = self._axes.transform(seen)
        self.scale_ = np.sqrt(found.var(axis=0).sum())
        return np.asarray(np.exp(found / self.scale_))

    def transform(self, X: Any) -> Float32[np.ndarray, "views odorants"]:
        """Give what other panoramas smell of, all > 0."""
        check_is_fitted(self)
        with one_thread():
            found = self._axes.transform(strips(X).turn_invariant)
        return np.asarray(np.exp(found / self.scale_))
