"""Generalised coordinates: degrees of freedom, loops and coordinates of any body, from images alone."""

from cogmap.coordinates.chart_dimension import chart_dimension
from cogmap.coordinates.generalised_coordinates import GeneralisedCoordinates
from cogmap.coordinates.split import split_torus
from cogmap.coordinates.view_code import ViewCode

__all__ = ["GeneralisedCoordinates", "ViewCode", "chart_dimension", "split_torus"]
