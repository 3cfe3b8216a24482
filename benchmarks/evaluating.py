"""How fast place cells say what they fire, and cells are measured, against RatInABox's place cells."""

import importlib.util
from collections.abc import Callable

import numpy as np
import torch

from benchmarks.timing import ROOM, Figures, missing, one_core, poses, rate, seconds, versus
from cogmap.cells import heading_statistics, place_statistics
from cogmap.threads import one_thread
from neurons.layers.place_cells import PlaceCells

CELLS = 1000
POSITIONS = 10_000
ROUNDS = 7


def evaluating() -> Figures:
    """Evaluate a thousand place cells at ten thousand positions, positions per second of one core.

    In turn with RatInABox's. Both are given positions in m and return every rate. Ours smell the room's
    odours there and compare log concentrations with what each cell has learnt, its centre and its covariance;
    RatInABox's compare the distance to each centre with one width, by its fastest geometry, which sees no
    walls. Measuring is that of a thousand cells on ten thousand views, every statistic in one call.
    """
    where = poses(POSITIONS)
    with one_core(), one_thread():
        smelling, layer = grown(where[:, :2])
        figures = {"measuring": measuring(layer(smelling()).numpy(), where)}

        def ours() -> int:
            return len(layer(smelling()))

        if importlib.util.find_spec("ratinabox") is None:
            return {"place_cells": {"per_s": rate(ours), **missing("RatInABox")}, **figures}
        return {"place_cells": versus(ours, rats(where[:, :2]), ROUNDS, beside="RatInABox"), **figures}


def grown(
    positions: np.ndarray, cells: int = CELLS
) -> tuple[Callable[[], torch.Tensor], Callable[[torch.Tensor], torch.Tensor]]:
    """Give the nose at these positions, and the tuning of cells that have competed for what it smells."""

    def smell() -> torch.Tensor:
        return torch.from_numpy(np.log(ROOM.odours.concentration(positions))).float()

    odours = smell()
    layer = PlaceCells(cells, 1, odours.shape[1])
    for batch in odours.split(256):
        layer.compete(batch, window=POSITIONS)
    return smell, layer.tuning


def rats(positions: np.ndarray) -> Callable[[], int]:
    """Give work that evaluates RatInABox's place cells in a box of the platform's size."""
    from ratinabox.Agent import Agent  # noqa: PLC0415  a peer that may be missing
    from ratinabox.Environment import Environment  # noqa: PLC0415
    from ratinabox.Neurons import PlaceCells as Peers  # noqa: PLC0415

    box = Environment(params={"aspect": 4 / 3, "scale": 3})
    settings = {"n": CELLS, "wall_geometry": "euclidean", "max_fr": 20.0}
    cells, inside = Peers(Agent(box), params=settings), positions - positions.min(axis=0)

    def evaluate() -> int:
        return cells.get_state(evaluate_at=None, pos=inside).shape[1]

    return evaluate


def measuring(rates: np.ndarray, where: np.ndarray) -> Figures:
    """Seconds in which a thousand cells are measured on ten thousand views, every statistic in one call."""
    positions, headings = where[:, :2], where[:, 2]
    return {
        "place_statistics_s": seconds(lambda: place_statistics(rates, positions, headings)),
        "heading_statistics_s": seconds(lambda: heading_statistics(rates, positions, headings)),
    }
