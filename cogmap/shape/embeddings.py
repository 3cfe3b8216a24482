"""Embeddings, ways of giving a cloud few coordinates, with one face: scikit-learn's."""

from typing import Literal, Protocol, get_args, runtime_checkable

import numpy as np
from jaxtyping import Float
from sklearn.decomposition import KernelPCA
from sklearn.manifold import Isomap

from cogmap.graph.points import AnyCloud
from cogmap.inputs import Whole, check_choice
from cogmap.shape.isomap import LandmarkIsomap

Method = Literal["landmark_isomap", "isomap", "kernel_pca"]


@runtime_checkable
class Embedding(Protocol):
    """Takes points (points, features) to coordinates (points, components)."""

    def fit_transform(self, X: AnyCloud) -> Float[np.ndarray, "points components"]:
        """Find the coordinates of a cloud."""
        ...

    def transform(self, X: AnyCloud) -> Float[np.ndarray, "places components"]:
        """Place other points."""
        ...


def embedding(method: Method, components: Whole = 4, *, neighbours: Whole = 15, seed: Whole = 0) -> Embedding:
    """Choose a way of embedding bags of words, whose rows have length one.

    All compare directions: the Euclidean distance of such rows is the chord that `LandmarkIsomap` measures,
    and the kernel is the cosine.

    Parameters
    ----------
    method
        "landmark_isomap", or scikit-learn's "isomap" or "kernel_pca", whose time grows with the cube and
        whose memory with the square of the points.
    components
        Coordinates.
    neighbours
        Of each point; without effect on kernel PCA.
    seed
        Draws landmarks and first guesses of eigenvectors.

    Raises
    ------
    CogmapError
        For an unknown method.
    """
    check_choice("method", method, get_args(Method))
    methods: dict[Method, Embedding] = {
        "landmark_isomap": LandmarkIsomap(components, neighbours=neighbours, metric="cosine", seed=seed),
        "isomap": Isomap(n_components=components, n_neighbors=neighbours),
        "kernel_pca": KernelPCA(components, kernel="cosine", random_state=seed),
    }
    return methods[method]
