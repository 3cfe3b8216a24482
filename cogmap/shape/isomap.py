"""Landmark Isomap: coordinates in which straight lines are as long as shortest paths in a neighbour graph."""

from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int
from scipy.linalg import eigh
from sklearn.base import BaseEstimator, ClassNamePrefixFeaturesOutMixin, TransformerMixin
from sklearn.utils import Tags
from sklearn.utils.validation import check_is_fitted, validate_data

from cogmap.graph.knn import Metric, nearest_points
from cogmap.graph.neighbour_graph import (
    SMALLEST,
    components,
    neighbour_graph,
    neighbourhood_means,
    warn_of_pieces,
)
from cogmap.graph.points import Cloud
from cogmap.graph.shortest_paths import Paths
from cogmap.inputs import Whole, checked_count
from cogmap.threads import one_thread


class PieceMap(NamedTuple):
    """How distances to the landmarks of one connected piece become coordinates."""

    points: Int[np.ndarray, "points"]
    """Which points of the cloud the piece consists of."""
    paths: Float[np.ndarray, "landmarks points"]
    """Lengths of the shortest paths from each landmark."""
    mean: Float[np.ndarray, "landmarks"]
    """Of the squared lengths among the landmarks."""
    axes: Float[np.ndarray, "components landmarks"]
    """−½ λ^−½ v, and 0 where the piece has no more dimensions."""

    def coordinates(
        self, paths: Float[np.ndarray, "landmarks places"]
    ) -> Float[np.ndarray, "places components"]:
        """Give the coordinates of what is so far from the landmarks."""
        return np.asarray((self.axes @ (paths**2 - self.mean[:, None])).T)


class LandmarkIsomap(ClassNamePrefixFeaturesOutMixin, TransformerMixin, BaseEstimator):
    r"""Isomap by landmarks: classical scaling of the shortest paths to some of the points.

    With Δ the squared distances among n landmarks, μ their means, H = I − 11ᵀ/n, and λ, v the largest
    eigenvalues and eigenvectors of −½ HΔH, a point at squared distances δ from the landmarks is placed at

    .. math:: y_i = -\tfrac12 \lambda_i^{-1/2} v_i^\top (\delta - \mu).

    With every point a landmark this is Isomap. A graph in pieces is left in pieces, as `pieces_` tells: each
    has its own map, around its own middle, and coordinates in different maps have nothing to do with each
    other. A `cogmap.SeparatePiecesWarning` says how many there are.

    Parameters
    ----------
    components
        Coordinates; those beyond the dimensions of a piece are 0.
    neighbours
        Nearest points that each point is joined to.
    one_sided
        How many of these even when they do not count it among theirs (`neighbour_graph`); all when None.
    landmarks
        Drawn from each piece, or all of its points where these are fewer.
    averaging
        Whether to give each point the mean of its own and its neighbours' coordinates. This takes away the
        noise of single edges: of the variance of place in bags of words, 3 % is lost instead of 6 %.
    metric
        "euclidean", or "cosine" for bags of words.
    seed
        Draws the landmarks.

    Attributes
    ----------
    embedding_ : array (points, components)
        Coordinates of the points that it was fitted on.
    graph_ : sparse array (points, points)
        Their neighbour graph.
    pieces_ : Components
        The connected pieces of the graph, the largest first.
    maps_ : tuple of PieceMap
        One a piece.

    Raises
    ------
    CogmapError
        From `fit` for counts below one or too few distinct points.

    References
    ----------
    Tenenbaum, de Silva & Langford (2000), A global geometric framework for nonlinear dimensionality
    reduction. de Silva & Tenenbaum (2004), Sparse multidimensional scaling using landmark points.
    """

    def __init__(
        self,
        components: Whole = 4,
        *,
        neighbours: Whole = 15,
        one_sided: int | None = None,
        landmarks: Whole = 400,
        averaging: bool = False,
        metric: Metric = "euclidean",
        seed: Whole = 0,
    ) -> None:
        self.components = components
        self.neighbours = neighbours
        self.one_sided = one_sided
        self.landmarks = landmarks
        self.averaging = averaging
        self.metric = metric
        self.seed = seed

    def fit(self, X: Any, y: object = None) -> "LandmarkIsomap":
        """Find neighbours, paths and coordinates of a cloud, (points, features), dense or sparse."""
        del y
        checked_count("components", self.components)
        checked_count("landmarks", self.landmarks)
        X = self._points = self._checked(X, reset=True)
        self.graph_ = neighbour_graph(X, self.neighbours, metric=self.metric, one_sided=self.one_sided)
        self.pieces_ = components(self.graph_)
        warn_of_pieces(self.pieces_, "each has coordinates of its own (`pieces_`)")
        self._position = np.empty(X.shape[0], dtype=int)
        self._single = np.empty((X.shape[0], self.components))
        rng = np.random.default_rng(self.seed)
        maps = []
        with one_thread():
            for piece in range(self.pieces_.number):
                points = np.flatnonzero(self.pieces_.labels == piece)
                self._position[points] = np.arange(len(points))
                maps.append(self._scale(points, rng))
                self._single[points] = maps[-1].coordinates(maps[-1].paths)
        self.maps_ = tuple(maps)
        self.embedding_ = self._single
        if self.averaging:
            self.embedding_ = neighbourhood_means(self.graph_) @ self._single
        return self

    def fit_transform(self, X: Any, y: object = None) -> Float[np.ndarray, "points components"]:
        """Find the coordinates of a cloud."""
        return self.fit(X, y).embedding_

    def transform(self, X: Any) -> Float[np.ndarray, "places components"]:
        """Place other points by way of their nearest neighbours in the cloud.

        Each goes to the map of its nearest neighbour; what is near to nothing gets NaN.
        """
        check_is_fitted(self)
        X = self._checked(X, reset=False)
        ends, lengths = nearest_points(self._points, self.neighbours, queries=X, metric=self.metric)
        labels = np.where(ends < 0, -1, self.pieces_.labels[ends])
        near = (labels == labels[:, :1]) & (ends >= 0)
        lengths = np.where(near, lengths, np.inf)
        position = np.where(near, self._position[ends], 0)
        placed = np.full((X.shape[0], self.components), np.nan)
        with one_thread():
            for piece in np.unique(labels[near]):
                chart, here = self.maps_[piece], np.flatnonzero(labels[:, 0] == piece)
                # All at once the paths would fill the memory.
                for block in np.split(here, range(256, len(here), 256)):
                    paths = (chart.paths[:, position[block]] + lengths[block]).min(axis=2)
                    placed[block] = chart.coordinates(paths)
        if self.averaging:
            known = np.where(near[:, :, None], self._single[ends], 0).sum(axis=1)
            placed = (placed + known) / (1 + near.sum(axis=1, keepdims=True))
        return placed

    def _scale(self, points: Int[np.ndarray, "points"], rng: np.random.Generator) -> PieceMap:
        """Classical scaling of one piece."""
        count = min(self.landmarks, len(points))
        landmarks = np.sort(rng.choice(len(points), count, replace=False))
        paths = Paths(self.graph_[points][:, points]).lengths(landmarks)
        squares = paths[:, landmarks] ** 2
        mean = squares.mean(axis=0)
        centred = -0.5 * (squares - mean - mean[:, None] + mean.mean())
        kept = min(self.components, count)
        values, vectors = eigh((centred + centred.T) / 2, subset_by_index=(count - kept, count - 1))
        values, vectors = values[::-1], vectors[:, ::-1]
        # Rounding leaves eigenvalues of 1e-16 where there is no dimension.
        real = values > 1e-9 * max(values[0], SMALLEST)
        axes = np.zeros((self.components, count))
        axes[:kept][real] = (-0.5 * vectors[:, real] / np.sqrt(values[real])).T
        # Eigenvectors have no sign of their own.
        axes *= np.sign(axes[np.arange(self.components), np.abs(axes).argmax(axis=1)] + 0.0)[:, None]
        return PieceMap(points, paths, mean, axes)

    def _checked(self, X: Any, *, reset: bool) -> Cloud:
        checked = validate_data(
            self,
            X,
            reset=reset,
            accept_sparse="csr",
            dtype=(np.float64, np.float32),
            ensure_min_samples=2 if reset else 1,
        )
        return checked if isinstance(checked, np.ndarray) else sp.csr_array(checked)

    @property
    def _n_features_out(self) -> int:
        return int(self.components)

    def __sklearn_tags__(self) -> Tags:
        tags = super().__sklearn_tags__()
        tags.input_tags.sparse = True
        return tags
