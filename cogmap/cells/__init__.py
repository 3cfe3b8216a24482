"""Measures of cells: maps, curves, statistics and their nulls; spikes, and what can be decoded from them.

`session` reads an animal's spikes and track, `MeasuredSession` measures its cells.

All take samples: one row per view, each view one unit of occupancy; rates in Hz, positions in m, headings
in rad.
"""

from cogmap.cells.decoding.bayes import JointPosterior, joint_posterior, poisson_posterior
from cogmap.cells.decoding.decoders import (
    HeadingFrame,
    MapFrame,
    decode_positions,
    fit_heading_frame,
    fit_map_frame,
    heading_errors,
    likeliest,
    place_map,
    position_errors,
)
from cogmap.cells.decoding.patterns import pattern_correlations, population_vector_correlations
from cogmap.cells.measures.autocorrelogram import autocorrelograms
from cogmap.cells.measures.coherence import coherence
from cogmap.cells.measures.fields import PlaceFields, place_coverage, place_fields
from cogmap.cells.measures.grid import grid_statistics
from cogmap.cells.measures.gridness import Lattice, gridness, lattice
from cogmap.cells.measures.heading import heading_statistics
from cogmap.cells.measures.information import selectivity, sparsity, spatial_information
from cogmap.cells.measures.place import place_statistics
from cogmap.cells.measures.rayleigh import RayleighTest, rayleigh_test
from cogmap.cells.measures.stability import curve_stability, map_stability
from cogmap.cells.rates.bins import BinEdges, bin_edges, heading_centres
from cogmap.cells.rates.maps import RateMaps, rate_maps
from cogmap.cells.rates.shuffling import ShuffleTest, shuffle_test
from cogmap.cells.rates.spikes import poisson_spikes
from cogmap.cells.rates.tuning import Tuning, mean_vectors, tuning_curves, tuning_widths
from cogmap.cells.sessions.decoding import Decoded, decode_session
from cogmap.cells.sessions.measured import MeasuredSession
from cogmap.cells.sessions.session import Session, session

__all__ = [
    "BinEdges",
    "Decoded",
    "HeadingFrame",
    "JointPosterior",
    "Lattice",
    "MapFrame",
    "MeasuredSession",
    "PlaceFields",
    "RateMaps",
    "RayleighTest",
    "Session",
    "ShuffleTest",
    "Tuning",
    "autocorrelograms",
    "bin_edges",
    "coherence",
    "curve_stability",
    "decode_positions",
    "decode_session",
    "fit_heading_frame",
    "fit_map_frame",
    "grid_statistics",
    "gridness",
    "heading_centres",
    "heading_errors",
    "heading_statistics",
    "joint_posterior",
    "lattice",
    "likeliest",
    "map_stability",
    "mean_vectors",
    "pattern_correlations",
    "place_coverage",
    "place_fields",
    "place_map",
    "place_statistics",
    "poisson_posterior",
    "poisson_spikes",
    "population_vector_correlations",
    "position_errors",
    "rate_maps",
    "rayleigh_test",
    "selectivity",
    "session",
    "shuffle_test",
    "sparsity",
    "spatial_information",
    "tuning_curves",
    "tuning_widths",
]
