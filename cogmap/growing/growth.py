"""The growth of a map: through its stages, in some of which one thread learns, and in most all of them."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from jaxtyping import Int

from cogmap.errors import CogmapError, UnlikeArithmeticWarning
from cogmap.growing.checkpoint import Checkpoint, Place
from cogmap.growing.expedition import Expedition
from cogmap.growing.memory import Memory, picked
from cogmap.growing.progress import Progress
from cogmap.growing.work import (
    Outcome,
    Task,
    code_share,
    learn_share,
    network_of,
    recall_share,
    seen_of,
    walk_share,
)
from cogmap.map.cognitive_map import BATCH, CognitiveMap
from cogmap.portable import arithmetic
from cogmap.threads import one_thread
from neurons.network import Network
from neurons.stages import CodedStage, RecallStage, Stage, chosen

PIECE = 1024
"""Views that one thread learns at a time; then it may put down how far it has come."""
EVERY = 20.0
"""Seconds after which it does, which takes some tenths of a second."""
WAYS, CODES, RECALLED = "ways", "codes", "recalled"
"""What is remembered of views: where they were taken and what was smelt; their codes; what charts recall."""

Crew = Callable[[Iterable[Task]], Iterator[Outcome]]
"""Who does tasks, in whatever order."""


class Growth:
    """A map on its way through its stages.

    Parameters
    ----------
    expedition
        Who sees what.
    checkpoint
        Where it is put down how far it has come.
    crew
        Who does shares.
    bar
        Where it is told.
    """

    def __init__(self, expedition: Expedition, checkpoint: Checkpoint, crew: Crew, bar: Progress) -> None:
        self.expedition, self.checkpoint, self.bar = expedition, checkpoint, bar
        self.shares, self.memory = expedition.shares, Memory(expedition.shares)
        self._crew, self._saved = crew, time.monotonic()
        self._arithmetics, self._seconds = set[str](), dict[str, float]()

    def run(self, blank: CognitiveMap) -> CognitiveMap:
        """Bring a map that has learnt nothing, or what was put down of it, through all stages."""
        begun = self.checkpoint.load()
        self.cmap, place = begun or (blank, None)
        if place is None:
            self.bar.expect(WAYS, self.expedition.views)
            self._ensure(WAYS)
            # views tell the eye, and with it the network
            self._learn_views(None, min(BATCH, int(self.cmap.epoch)), 0)
            place = Place(self._network.stage.name, 0)
        stage, merged = self._named(place.stage), place.merged
        self._expect(stage, merged)
        while True:
            self._ensure(_needed(stage), merged if stage.sums else 0)
            with self._timed(stage.name):
                if stage.sums:
                    self._learn_together(stage, merged)
                elif stage != self._network.stages[-1]:
                    self._learn_alone(stage)
            if stage == self._network.stages[-1]:
                self._warn_of_unlike()
                self.cmap.seconds_ = self._seconds
                return self.cmap
            with one_thread(), self._timed(stage.name):
                self._network.advance_stage()
            stage, merged = self._network.stage, 0
            self._save(Place(stage.name, merged))

    def _learn_alone(self, stage: Stage[Any]) -> None:
        """Learn a stage in which units compete, from views picked by chance."""
        network, needed = self._network, _needed(stage)
        begins, whole = network.begins(stage.name), stage.epochs * network.epoch
        while (learnt := int(network.views_seen) - begins) < whole:
            count = min(PIECE, whole - learnt)
            if needed == WAYS:
                self._learn_views(stage, count, learnt)
            else:
                rows = self._picked(stage, learnt, count)
                seen = seen_of(self.memory.take(needed, rows))
                smells = torch.from_numpy(self.memory.take(WAYS, rows)[1])
                with one_thread():
                    for batch in torch.arange(count).split(BATCH):
                        network.learn_seen(chosen(seen, batch), smells[batch])
            self.bar.update(stage.name, count)
            self._save(Place(stage.name, 0), every=EVERY)

    def _learn_views(self, stage: Stage[Any] | None, count: int, learnt: int) -> None:
        """Learn from views themselves; before the first there is no stage yet."""
        poses, smells = self.memory.take(WAYS, self._picked(stage, learnt, count))
        odours = np.exp(smells) if smells.shape[1] else None
        self.cmap.partial_fit(self.expedition.views_from(poses, learnt)[:], odours)

    def _learn_together(self, stage: Stage[Any], merged: int) -> None:
        """Learn a stage of sums from all views: forks learn shares, and are merged in the order of these."""
        if merged == len(self.shares):
            return
        needed, waiting = _needed(stage), dict[int, dict[str, np.ndarray]]()
        with self._lent(stage.name, partial(self._fork, stage, merged)) as path:
            fork = CognitiveMap.load(path)
            sums = fork.state_dict()
            tasks = (self._lesson(number, needed, path) for number in range(merged, len(self.shares)))
            for number, found in self._done(stage.name, tasks):
                waiting[number] = found
                while merged in waiting:
                    for name, summed in waiting.pop(merged).items():
                        sums[name].copy_(torch.from_numpy(np.asarray(summed)))
                    self.cmap.merge(fork)
                    merged += 1
                    self._save(Place(stage.name, merged), every=EVERY)
            self._save(Place(stage.name, merged))

    def _lent(self, name: str, make: Callable[[], CognitiveMap]) -> AbstractContextManager[Path]:
        """Put a map down for those who help; where charts are added, they do it again with another."""
        return self.checkpoint.lent(f"{name} on {len(self._network.charts)} charts", make)

    def _fork(self, stage: Stage[Any], merged: int) -> CognitiveMap:
        if merged:
            raise CogmapError(
                f"the map that {stage.name} is learnt on has vanished from {self.checkpoint.folder}; remove "
                "this and start again"
            )
        return self.cmap.fork()

    def _lesson(self, number: int, needed: str, path: Path) -> Task:
        share, rows = self.shares[number], self.shares[number].rows
        walks = [self.expedition.rows(explorer) for explorer in range(share.first, share.end)]
        walks = [slice(walk.start - rows.start, walk.stop - rows.start) for walk in walks]
        given = self.memory.take(needed, rows), self.memory.take(WAYS, rows)[1], walks, path
        return Task(number, learn_share, given)

    def _ensure(self, name: str, first: int = 0) -> None:
        """Have something remembered of shares from the first on; after a kill it is made again."""
        self._make(name, [number for number in self.memory.lacks(name) if number >= first])
        if name == RECALLED:
            self.memory.forget(CODES)

    def _make(self, name: str, shares: Sequence[int]) -> None:
        """Make what is remembered of some shares, and first what it is made of."""
        if not shares:
            return
        if name == WAYS:
            tasks = (Task(number, walk_share, (self.expedition, self.shares[number])) for number in shares)
            with self._timed(name):
                self._remember(name, tasks)
            return
        source = WAYS if name == CODES else CODES
        self._make(source, [number for number in self.memory.lacks(source) if number in shares])
        with self._timed(name), self._lent(name, lambda: self.cmap) as path:
            self._remember(name, (self._look(name, number, path) for number in shares))

    def _look(self, name: str, number: int, path: Path) -> Task:
        share = self.shares[number]
        if name == CODES:
            poses, _ = self.memory.take(WAYS, share.rows)
            return Task(number, code_share, (self.expedition, share, poses, path))
        (codes,) = self.memory.take(CODES, share.rows)
        return Task(number, recall_share, (codes, path))

    def _remember(self, name: str, tasks: Iterable[Task]) -> None:
        for number, found in self._done(name, tasks):
            self.memory.put(name, number, found)

    def _done(self, name: str, tasks: Iterable[Task]) -> Iterator[tuple[int, Any]]:
        """Have tasks done, and tell how it goes on."""
        for number, found, calculated in self._crew(tasks):
            self._arithmetics.add(calculated)
            rows = self.shares[number].rows
            self.bar.update(name, rows.stop - rows.start)
            yield number, found

    def _picked(self, stage: Stage[Any] | None, learnt: int, count: int) -> Int[np.ndarray, "_"]:
        index = 0 if stage is None else self._network.stages.index(stage)
        return picked(self.expedition.views, learnt, count, (self.expedition.seed, index))

    def _save(self, place: Place, *, every: float = 0.0) -> None:
        """Put down how far it has come, unless it has just been done."""
        if time.monotonic() - self._saved >= every:
            self.checkpoint.save(self.cmap, place)
            self._saved = time.monotonic()

    @property
    def _network(self) -> Network:
        return network_of(self.cmap)

    def _named(self, name: str) -> Stage[Any]:
        return next(stage for stage in self._network.stages if stage.name == name)

    def _expect(self, stage: Stage[Any], merged: int) -> None:
        """Tell the bar what is left from a stage on."""
        network = self._network
        first = self.shares[merged].rows.start if merged < len(self.shares) else self.expedition.views
        learnt = first if stage.sums else int(network.views_seen) - network.begins(stage.name)
        left = [each for each in network.stages[network.stages.index(stage) :] if self._lasts(each)]
        for each in left:
            self.bar.expect(each.name, self._lasts(each) - learnt * (each == stage))
        needed = {_needed(each) for each in left}
        needed |= {WAYS, CODES} if RECALLED in needed else {WAYS}
        # in the last stage nothing is made again of what is merged
        made = learnt if stage.sums and len(left) == 1 else 0
        for name in needed:
            if self.memory.lacks(name):
                self.bar.expect(name, self.expedition.views - made)

    def _lasts(self, stage: Stage[Any]) -> int:
        """Count the views that a stage is shown."""
        if stage.sums:
            return self.expedition.views
        return 0 if stage == self._network.stages[-1] else stage.epochs * self._network.epoch

    @contextmanager
    def _timed(self, name: str) -> Iterator[None]:
        started = time.perf_counter()
        yield
        self._seconds[name] = self._seconds.get(name, 0.0) + time.perf_counter() - started

    def _warn_of_unlike(self) -> None:
        """Say so when shares were done by processors that calculate differently."""
        found = self._arithmetics | {arithmetic()}
        if len(found) > 1:
            warnings.warn(
                f"shares of this map were done in {len(found)} arithmetics ({', '.join(sorted(found))}), so "
                "that it may differ by rounding; start this command and all workers with `cogmap portable`",
                UnlikeArithmeticWarning,
                stacklevel=4,
            )


def _needed(stage: Stage[Any]) -> str:
    """Name what a stage learns from."""
    if isinstance(stage, RecallStage):
        return RECALLED
    return CODES if isinstance(stage, CodedStage) else WAYS
