"""Plastic layers that learn by local Hebbian rules; handed views and odours, they know nothing else."""

from neurons.atlas.atlas import Atlas
from neurons.atlas.disambiguation import place_branches
from neurons.atlas.heading_axis import heading_axes
from neurons.atlas.metric_map import MetricMap, MetricReading
from neurons.atlas.pieces import pieces
from neurons.atlas.synchronisation import Compass, synchronise
from neurons.circuit import Circuit
from neurons.dividing import Part, divided
from neurons.errors import NeuronsError
from neurons.layers.afferents import Afferents
from neurons.layers.charts import Charts, NearestCharts
from neurons.layers.heading_cells import HeadDirectionCells
from neurons.layers.olfaction import Olfaction
from neurons.layers.place_cells import PlaceCells
from neurons.layers.readout import ChartActivity, Readout
from neurons.layers.retina import Retina
from neurons.layers.sanger import Sanger
from neurons.merging import forked, merge
from neurons.network import Network
from neurons.renewal import RenewalStage
from neurons.rooms import Recognised, Rooms
from neurons.stages import SMELL_FIRST, STAGES, Batch, Stage

__all__ = [
    "SMELL_FIRST",
    "STAGES",
    "Afferents",
    "Atlas",
    "Batch",
    "ChartActivity",
    "Charts",
    "Circuit",
    "Compass",
    "HeadDirectionCells",
    "MetricMap",
    "MetricReading",
    "NearestCharts",
    "Network",
    "NeuronsError",
    "Olfaction",
    "Part",
    "PlaceCells",
    "Readout",
    "Recognised",
    "RenewalStage",
    "Retina",
    "Rooms",
    "Sanger",
    "Stage",
    "divided",
    "forked",
    "heading_axes",
    "merge",
    "pieces",
    "place_branches",
    "synchronise",
]
