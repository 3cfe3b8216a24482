"""The visual roadmap: a way from one view to another through remembered views."""

from dataclasses import KW_ONLY, dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int
from scipy.sparse.csgraph import dijkstra
from sklearn.preprocessing import normalize

from cogmap.errors import CogmapError
from cogmap.graph.knn import Metric
from cogmap.graph.neighbour_graph import Components, components, neighbour_graph, warn_of_pieces
from cogmap.graph.points import AnyCloud, Checked, as_rows, checked_cloud


@dataclass(eq=False)
class VisualRoadmap:
    r"""Plans routes as sequences of remembered views: shortest paths in their neighbour graph.

    The source and the destination are each taken for the remembered view nearest to them, and Dijkstra's
    algorithm runs between these over edges of cost

    .. math:: c_{ij} = \lVert f_i - f_j \rVert^p .

    A p above 1 takes several short steps rather than a long one, which may lead through an obstacle and whose
    length the features understate. Views are remembered from where a body can be, so the way is free wherever
    steps are shorter than what is between. The graph is made at the first plan.

    Parameters
    ----------
    features
        Of the remembered views, (views, features), dense or sparse: `PanoramaCode`, `BagOfWords`.
    neighbours
        How many nearest views each is joined to, where these count it among theirs.
    power
        p.
    metric
        Of the features; "cosine" for bags of words.
    one_sided
        Nearest views that each is joined to in any case.

    Raises
    ------
    CogmapError
        From `plan`, for features that do not fit, and when there is no way.

    References
    ----------
    Algorithm 1 of the paper on visual maps. Kavraki, Švestka, Latombe & Overmars (1996), Probabilistic
    roadmaps for path planning in high-dimensional configuration spaces.
    """

    features: AnyCloud
    _: KW_ONLY
    neighbours: int = 45
    power: float = 1.25
    metric: Metric = "euclidean"
    one_sided: int = 5

    def plan(self, view_a: AnyCloud, view_b: AnyCloud) -> Int[np.ndarray, "steps"]:
        """Give the indices of the views on the way from view a to view b, given by their features.

        Parameters
        ----------
        view_a, view_b
            One view each, (features,) or (1, features).

        Raises
        ------
        CogmapError
            When no chain of remembered views joins them.
        """
        start, goal = self.nearest(view_a), self.nearest(view_b)
        labels, sizes = self.pieces.labels, self.pieces.sizes
        if labels[start] != labels[goal]:
            raise CogmapError(
                f"no way leads from view {start} to view {goal}: they are in separate pieces of the "
                f"neighbour graph, of {sizes[labels[start]]} and {sizes[labels[goal]]} views; "
                "explore between them or ask for more neighbours"
            )
        before = dijkstra(self.graph, indices=[goal], return_predecessors=True)[1][0]
        route = [start]
        # So scipy's Dijkstra calls the predecessor of a point that has none.
        while before[route[-1]] != -9999:
            route.append(int(before[route[-1]]))
        return np.array(route)

    def nearest(self, view: AnyCloud) -> int:
        """Give the index of the remembered view nearest to one given by its features."""
        row = as_rows("the view", view)
        test = self._prepared(np.atleast_2d(row) if isinstance(row, np.ndarray) else row)
        train, squares = self._train
        if test.shape != (1, train.shape[1]):
            raise CogmapError(
                f"the view has features of shape {test.shape}; give one row of {train.shape[1]} features"
            )
        products = train @ (test.toarray() if sp.issparse(test) else test)[0]
        return int(np.argmin(squares - 2 * products))

    def __len__(self) -> int:
        return len(self._train[1])

    @cached_property
    def graph(self) -> sp.csr_array:
        """Symmetric costs between neighbours."""
        if len(self) == 1:
            return sp.csr_array((1, 1))
        graph = neighbour_graph(self.features, self.neighbours, metric=self.metric, one_sided=self.one_sided)
        graph.data **= self.power
        return graph

    @cached_property
    def pieces(self) -> Components:
        """The connected pieces of the graph; a `cogmap.SeparatePiecesWarning` says when it has several."""
        pieces = components(self.graph)
        warn_of_pieces(pieces, "no way leads from one to another")
        return pieces

    @cached_property
    def _train(self) -> tuple[Checked, Float[np.ndarray, "views"]]:
        train = self._prepared(self.features)
        squares = train.multiply(train).sum(axis=1) if sp.issparse(train) else (train**2).sum(axis=1)
        return train, np.asarray(squares)

    def _prepared(self, views: AnyCloud) -> Checked:
        checked = checked_cloud(views)
        directions: Checked = normalize(checked) if self.metric == "cosine" else checked
        return directions
