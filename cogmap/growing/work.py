"""What threads do for a map that grows: each task is a share, and knows nothing of the others."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numba
import numpy as np
import torch
from jaxtyping import Float, Float32
from torch import Tensor

from cogmap.growing.expedition import Expedition, Share, Way
from cogmap.map.cognitive_map import BATCH, CognitiveMap
from cogmap.portable import arithmetic
from cogmap.threads import one_thread
from neurons.layers.readout import Recalled
from neurons.network import Network
from neurons.stages import Batch, chosen

Columns = tuple[np.ndarray, ...]
"""Codes, or what was recalled of them: chart, weight, heading, odour."""
Sums = dict[str, np.ndarray]
"""What has been summed up, by the names it is saved under, and how many views there are behind it."""


class Task(NamedTuple):
    """What is to be done for a share."""

    number: int
    """Of the share."""
    work: Callable[..., Any]
    given: tuple[Any, ...]


class Outcome(NamedTuple):
    """What came of a task."""

    number: int
    found: Any
    arithmetic: str
    """How it was calculated."""


def do(task: Task) -> Outcome:
    """Do a task on one thread, so that whoever does it finds the same bits."""
    with one_thread(), _one_painter():
        return Outcome(task.number, task.work(*task.given), arithmetic())


def walk_share(expedition: Expedition, share: Share) -> Way:
    """Let explorers walk, one after the other."""
    ways = [expedition.walk(explorer) for explorer in range(share.first, share.end)]
    return Way(*(np.concatenate(columns) for columns in zip(*ways, strict=True)))


def code_share(
    expedition: Expedition, share: Share, poses: Float[np.ndarray, "views axes"], path: Path
) -> Columns:
    """Look at all that explorers see, and give its principal components."""
    cmap, first = map_at(path), share.rows.start
    codes = []
    for explorer in range(share.first, share.end):
        rows = expedition.rows(explorer)
        way = poses[rows.start - first : rows.stop - first]
        codes.append(cmap.encode(expedition.views_on(explorer, way)))
    return (np.concatenate(codes),)


def recall_share(codes: Float32[np.ndarray, "views components"], path: Path) -> Columns:
    """Tell what charts recall of codes."""
    network = network_of(map_at(path))
    recalled = [recall(network, batch) for batch in torch.from_numpy(codes).split(BATCH)]
    chart, *others = (torch.cat(parts).numpy() for parts in zip(*recalled, strict=True))
    return (chart.astype(np.int32), *others)


def learn_share(
    columns: Columns, log_odours: Float32[np.ndarray, "views odorants"], walks: list[slice], path: Path
) -> Sums:
    """Let a blank fork of a map learn walks, each of which begins anew, and give what it has summed up.

    Parameters
    ----------
    columns
        What its present stage sees: codes, or what was recalled of them.
    log_odours, walks
        What was smelt there, and which rows are whose.
    path
        Of the map.
    """
    blank = map_at(path).fork()
    network, stage = network_of(blank), network_of(blank).entered
    seen, smells = seen_of(columns), torch.from_numpy(log_odours)
    for walk in walks:
        network.break_sequence()
        for rows in torch.arange(walk.start, walk.stop).split(BATCH):
            # not by `learn_seen`, which would go on to the next stage after an epoch
            stage.learn(network, Batch(chosen(seen, rows), smells[rows], 1.0, window=float(network.epoch)))
    network.views_seen += min(len(smells), stage.epochs * network.epoch)
    state = blank.state_dict()
    return {name: state[name].numpy() for name in (*stage.sums, "views_seen")}


def seen_of(columns: Columns) -> Any:
    """Make of what is remembered what a stage sees."""
    first, *others = (torch.from_numpy(column) for column in columns)
    return Recalled(first.long(), *others) if others else first


def recall(network: Network, codes: Float[Tensor, "views components"]) -> Recalled:
    """Tell heading and smell from codes, as `Circuit.recall` does from strips."""
    told: Recalled = network.readout(network.charts, codes, network.readout.excite(network.charts, codes))
    return told


def network_of(cmap: CognitiveMap) -> Network:
    """Give the network of a map: its codes are learnt here without being made again from views."""
    return cmap._rooms[0]  # noqa: SLF001


@lru_cache(maxsize=1)
def map_at(path: Path) -> CognitiveMap:
    """Read a map that was put down for all who help, once for all shares."""
    return CognitiveMap.load(path)


@contextmanager
def _one_painter() -> Iterator[None]:
    """Paint on one thread, as others work beside this one."""
    threads = numba.get_num_threads()
    numba.set_num_threads(1)
    try:
        yield
    finally:
        numba.set_num_threads(threads)
