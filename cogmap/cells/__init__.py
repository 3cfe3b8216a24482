"""Measures of cells: rate maps, tuning curves, fields, statistics, and what can be decoded from a population.

All take samples: one row per view, each view one unit of occupancy; rates in Hz, positions in m, headings
in rad.
"""

from cogmap.cells.bins import BinEdges, bin_edges
from cogmap.cells.decoding import (
    HeadingFrame,
    MapFrame,
    decode_positions,
    fit_heading_frame,
    fit_map_frame,
    heading_errors,
    place_map,
    position_errors,
)
from cogmap.cells.fields import PlaceFields, place_coverage, place_fields
from cogmap.cells.heading import heading_statistics
from cogmap.cells.information import selectivity, sparsity, spatial_information
from cogmap.cells.maps import RateMaps, rate_maps
from cogmap.cells.place import place_statistics
from cogmap.cells.tuning import mean_vectors, tuning_curves

__all__ = [
    "BinEdges",
    "HeadingFrame",
    "MapFrame",
    "PlaceFields",
    "RateMaps",
    "bin_edges",
    "decode_positions",
    "fit_heading_frame",
    "fit_map_frame",
    "heading_errors",
    "heading_statistics",
    "mean_vectors",
    "place_coverage",
    "place_fields",
    "place_map",
    "place_statistics",
    "position_errors",
    "rate_maps",
    "selectivity",
    "sparsity",
    "spatial_information",
    "tuning_curves",
]
