"""Nearest points and the graphs of neighbours that they make."""

from cogmap.graph.knn import Nearest, PointSearch, nearest_points
from cogmap.graph.neighbour_graph import Components, components, lengthen_shortcuts, neighbour_graph

__all__ = [
    "Components",
    "Nearest",
    "PointSearch",
    "components",
    "lengthen_shortcuts",
    "nearest_points",
    "neighbour_graph",
]
