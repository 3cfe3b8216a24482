"""Dividing: a network whose atlas falls into pieces becomes several, each of them one of a room."""

from copy import deepcopy
from typing import NamedTuple

from jaxtyping import Int
from torch import Tensor

from neurons.atlas.atlas import Atlas
from neurons.atlas.pieces import pieces
from neurons.network import Network


class Part(NamedTuple):
    """A piece of an atlas, and its network."""

    charts: Int[Tensor, "charts"]
    """Of the whole atlas, by number."""
    network: Network


def divided(network: Network) -> list[Part]:
    """Part a network whose charts have just tiled their views by the pieces of its atlas; one if it is whole.

    Each part has the charts of its piece, and what stands on them is as before any view. Its epoch is as many
    views as it will have of those that came in one: their share is that of the views that its charts won.
    """
    points = network.charts.points
    found = pieces(Atlas.of(points), points)
    if len(found) == 1:
        return [Part(found[0], network)]
    won = network.charts.responsibility
    parts = []
    for charts in found:
        part = deepcopy(network)
        share = float(won[charts].sum() / won.sum())
        part.most_charts = max(len(charts), round(share * network.most_charts))
        part.keep_charts(charts)
        part.epoch = max(1, round(share * network.epoch))
        part.views_seen.fill_(part.begins(part.entered.name))
        parts.append(Part(charts, part))
    return parts
