"""The figures, from results only: arrays in, a matplotlib Figure out."""

from cogmap.plots.afferents import plot_afferents
from cogmap.plots.barcode_grid import plot_barcode_grid
from cogmap.plots.barcodes import plot_barcodes
from cogmap.plots.cases import plot_cases
from cogmap.plots.cell_types import plot_cell_types
from cogmap.plots.compass import plot_compass
from cogmap.plots.confusion import plot_confusion
from cogmap.plots.courses import plot_courses
from cogmap.plots.embedding import plot_embedding
from cogmap.plots.examples import Tuning, plot_examples
from cogmap.plots.goals import plot_goals
from cogmap.plots.heading_cells import plot_tuning_curves
from cogmap.plots.likeness import plot_likeness
from cogmap.plots.localisation import plot_localisation
from cogmap.plots.metric_map import plot_metric_map
from cogmap.plots.neighbours import plot_neighbours
from cogmap.plots.place_cells import plot_rate_maps
from cogmap.plots.position import plot_position
from cogmap.plots.quasi_metric import plot_quasi_metric
from cogmap.plots.room import plot_room
from cogmap.plots.routes import plot_routes
from cogmap.plots.sheet import plot_sheet
from cogmap.plots.translation import plot_translation
from cogmap.plots.trends import plot_trend
from cogmap.plots.views import plot_views
from cogmap.plots.walk import plot_walk

__all__ = [
    "Tuning",
    "plot_afferents",
    "plot_barcode_grid",
    "plot_barcodes",
    "plot_cases",
    "plot_cell_types",
    "plot_compass",
    "plot_confusion",
    "plot_courses",
    "plot_embedding",
    "plot_examples",
    "plot_goals",
    "plot_likeness",
    "plot_localisation",
    "plot_metric_map",
    "plot_neighbours",
    "plot_position",
    "plot_quasi_metric",
    "plot_rate_maps",
    "plot_room",
    "plot_routes",
    "plot_sheet",
    "plot_translation",
    "plot_trend",
    "plot_tuning_curves",
    "plot_views",
    "plot_walk",
]
