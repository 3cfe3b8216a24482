"""Development of a map on views that are all there: epochs of stages, one after the other."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor
from tqdm import tqdm

from neurons.dividing import Part, divided
from neurons.network import Network
from neurons.rooms import Rooms
from neurons.stages import StripStage, chosen, joined


class Development:
    """Lets networks pass all stages on views whose strips are kept in memory.

    Views come in random order in every epoch but those of stages that learn from their order. Where an atlas
    falls into pieces, each goes on with the views that its own charts win.

    Parameters
    ----------
    seconds
        Time spent per stage, added to, s.
    batch
        Views learnt together.
    seed
        Of the order of views.
    progress
        Whether to show a bar on stderr.
    """

    def __init__(self, seconds: dict[str, float], *, batch: int, seed: int, progress: bool) -> None:
        self._seconds, self._batch, self._quiet = seconds, batch, not progress
        self._order = np.random.default_rng(seed)
        self._bar: tqdm[Any] = tqdm(disable=True)

    def of(
        self,
        network: Network,
        strips: Float[Tensor, "views features"],
        log_odours: Float[Tensor, "views odorants"],
    ) -> list[Network]:
        """Let a network learn from views; give it, or those into which it has parted."""
        with tqdm(total=network.epochs, unit="epoch", disable=self._quiet) as self._bar:
            return self._pass(network, strips, log_odours)

    def of_known(
        self,
        rooms: Rooms,
        strips: Float[Tensor, "views features"],
        log_odours: Float[Tensor, "views odorants"],
        *,
        least: int,
    ) -> Int[Tensor, "_"]:
        """Let rooms that are known learn their views of a walk, and give the rows of all others.

        Fewer than `least` of these beside views of known rooms are strange views of known rooms.
        """
        batches = torch.arange(len(strips), device=strips.device).split(self._batch)
        new = [rooms.are_new(strips[rows], log_odours[rows]) for rows in batches]
        count = sum(len(rows) for rows, novel in zip(batches, new, strict=True) if novel)
        if count < min(least, len(strips)):
            new = [False] * len(new)
        jump = True
        for rows, novel in zip(batches, new, strict=True):
            if not novel:
                rooms.learn(strips[rows], log_odours[rows], jump=jump)
            jump = novel
        none = batches[0][:0]
        return torch.cat([none, *(rows for rows, novel in zip(batches, new, strict=True) if novel)])

    @contextmanager
    def timed(self, what: str) -> Iterator[None]:
        """Add the time that something takes to that of a stage."""
        started = time.perf_counter()
        yield
        self._seconds[what] = self._seconds.get(what, 0.0) + time.perf_counter() - started

    def _pass(
        self,
        network: Network,
        strips: Float[Tensor, "views features"],
        log_odours: Float[Tensor, "views odorants"],
    ) -> list[Network]:
        count = network.epoch = len(strips)
        network.views_seen.fill_(network.begins(network.entered.name))
        see, seen = StripStage.see, strips
        while int(network.views_seen) < network.epochs * count:
            charted = network.charted
            with self.timed(network.stage.name):
                network.advance_stage()
                if network.charted and not charted:
                    parts = divided(network)
                    if len(parts) > 1:
                        break
                stage = network.stage
                self._bar.set_description(stage.name)
                # what a stage sees is made by layers that are fixed: once for all its epochs
                if type(stage).see is not see:
                    see = type(stage).see
                    seen = joined([network.see(some) for some in strips.split(self._batch)])
                if stage.in_order:
                    network.break_sequence()  # each epoch begins the walk anew
                epoch = np.arange(count) if stage.in_order else self._order.permutation(count)
                for rows in torch.from_numpy(epoch).to(strips.device).split(self._batch):
                    network.learn_seen(chosen(seen, rows), log_odours[rows])
            self._bar.n = int(network.views_seen) // count
            self._bar.refresh()
        else:
            return [network]
        homes = self._homes(network, parts, strips, log_odours)
        return [
            grown
            for part, home in zip(parts, homes, strict=True)
            for grown in self._pass(part.network, strips[home], log_odours[home])
        ]

    def _homes(
        self,
        whole: Network,
        parts: list[Part],
        strips: Float[Tensor, "views features"],
        log_odours: Float[Tensor, "views odorants"],
    ) -> list[Bool[Tensor, "views"]]:
        """Give to each part the views that its charts win, of all as they have competed."""
        winner = torch.cat(
            [
                whole.charts.excite(whole.code(seen), 1, smelt).chart[:, 0]
                for seen, smelt in zip(
                    *(each.split(self._batch) for each in (strips, log_odours)), strict=True
                )
            ]
        )
        return [torch.isin(winner, part.charts) for part in parts]
