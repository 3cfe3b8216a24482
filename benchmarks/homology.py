"""How fast the homology of a cloud is found, against shortest paths alone."""

import numpy as np
from scipy.sparse.csgraph import dijkstra
from sklearn.decomposition import PCA

from arena import Brownian, Camera, explore
from benchmarks.timing import ROOM, Figures, seconds, versus
from cogmap.graph import lengthen_shortcuts, neighbour_graph
from cogmap.graph.shortest_paths import Paths
from cogmap.shape import betti

VIEWS = 17_000
CODES = 60
"""Components of the views, as many as a map has."""
SOURCES = 300
"""Points from which paths alone are measured."""
ROUNDS = 3


def homology() -> Figures:
    """Find Betti numbers of 17,000 codes to H2, three draws of landmarks, on all cores; landmarks per second.

    In one graph, and for its seconds also with the second one that must agree.
    Beside scipy's shortest paths from landmarks over the same graph, which are but a part of it; so are ours,
    measured alone as well.
    """
    views = explore(ROOM, Brownian(), Camera.panoramic(90, 15), views=VIEWS).views
    codes = PCA(CODES, svd_solver="covariance_eigh").fit_transform(np.reshape(views, (VIEWS, -1)) / 255)
    graph = lengthen_shortcuts(neighbour_graph(codes))
    sources = np.random.default_rng(0).choice(VIEWS, SOURCES, replace=False)
    paths = Paths(graph)

    def count() -> int:
        found = betti(codes, check=None)
        return found.draws * max(found.landmarks)

    def walk() -> int:
        return len(paths.lengths(sources))

    def theirs() -> int:
        return len(dijkstra(graph, indices=sources))

    found = versus(count, theirs, ROUNDS, beside="scipy's dijkstra")
    return {
        "betti": {
            **found,
            "seconds": count() / float(found["per_s"]),
            "checked_seconds": seconds(lambda: betti(codes), 1),
        },
        "paths": versus(walk, theirs, ROUNDS, beside="scipy's dijkstra"),
        "paths_equal_scipy": int(np.array_equal(paths.lengths(sources), dijkstra(graph, indices=sources))),
    }
