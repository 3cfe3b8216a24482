"""The figures, from results only: arrays in, a matplotlib Figure out."""

from cogmap.plots.acting.catchment import plot_catchment
from cogmap.plots.acting.dreams import (
    plot_dream_errors,
    plot_dreams,
    plot_expectations,
    plot_film,
    plot_surprise,
)
from cogmap.plots.acting.dynamics import plot_foretold, plot_stops
from cogmap.plots.acting.journeys import plot_journeys
from cogmap.plots.acting.looking_round import plot_looking_round
from cogmap.plots.acting.reached import plot_reached
from cogmap.plots.bodies.coordinates import plot_coordinates
from cogmap.plots.bodies.joint_reach import plot_joint_reach
from cogmap.plots.bodies.look_alikes import plot_look_alikes
from cogmap.plots.cells.afferents import plot_afferents
from cogmap.plots.cells.cell_types import plot_cell_types
from cogmap.plots.cells.cue_control import plot_cue_control
from cogmap.plots.cells.examples import plot_examples
from cogmap.plots.cells.grid_cells import plot_grid_cells
from cogmap.plots.cells.heading_cells import plot_tuning_curves
from cogmap.plots.cells.learning_curves import plot_courses
from cogmap.plots.cells.place_cells import plot_rate_maps
from cogmap.plots.many_rooms.fields import plot_fields
from cogmap.plots.many_rooms.forgetting import plot_forgetting
from cogmap.plots.many_rooms.morph import plot_morph
from cogmap.plots.many_rooms.new_wall import plot_new_wall
from cogmap.plots.many_rooms.remapping import plot_remapping
from cogmap.plots.one_factor import plot_cases
from cogmap.plots.rooms.contact_sheet import plot_sheet
from cogmap.plots.rooms.goals import plot_goals
from cogmap.plots.rooms.nearest_views import plot_likeness
from cogmap.plots.rooms.neighbours import plot_neighbours
from cogmap.plots.rooms.room import plot_room
from cogmap.plots.rooms.routes import plot_routes
from cogmap.plots.rooms.views import plot_views
from cogmap.plots.rooms.walk import plot_walk
from cogmap.plots.shape.barcode_grid import plot_barcode_grid
from cogmap.plots.shape.barcodes import plot_barcodes
from cogmap.plots.shape.embedding import plot_embedding
from cogmap.plots.sweep import plot_trend
from cogmap.plots.truth.confusion import plot_confusion
from cogmap.plots.truth.decoding import plot_decoding
from cogmap.plots.truth.heading_errors import plot_compass
from cogmap.plots.truth.localisation import plot_localisation
from cogmap.plots.truth.metric_map import plot_metric_map
from cogmap.plots.truth.position import plot_position
from cogmap.plots.truth.quasi_metric import plot_quasi_metric
from cogmap.plots.truth.translation import plot_translation

__all__ = [
    "plot_afferents",
    "plot_barcode_grid",
    "plot_barcodes",
    "plot_cases",
    "plot_catchment",
    "plot_cell_types",
    "plot_compass",
    "plot_confusion",
    "plot_coordinates",
    "plot_courses",
    "plot_cue_control",
    "plot_decoding",
    "plot_dream_errors",
    "plot_dreams",
    "plot_embedding",
    "plot_examples",
    "plot_expectations",
    "plot_fields",
    "plot_film",
    "plot_foretold",
    "plot_forgetting",
    "plot_goals",
    "plot_grid_cells",
    "plot_joint_reach",
    "plot_journeys",
    "plot_likeness",
    "plot_localisation",
    "plot_look_alikes",
    "plot_looking_round",
    "plot_metric_map",
    "plot_morph",
    "plot_neighbours",
    "plot_new_wall",
    "plot_position",
    "plot_quasi_metric",
    "plot_rate_maps",
    "plot_reached",
    "plot_remapping",
    "plot_room",
    "plot_routes",
    "plot_sheet",
    "plot_stops",
    "plot_surprise",
    "plot_translation",
    "plot_trend",
    "plot_tuning_curves",
    "plot_views",
    "plot_walk",
]
