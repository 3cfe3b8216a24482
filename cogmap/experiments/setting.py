"""Where an experiment takes place, and how much of it there is."""

from __future__ import annotations

from dataclasses import dataclass

from arena import Arena


@dataclass(frozen=True)
class Setting:
    """What every experiment is told: a room, a number of views, a seed."""

    room: Arena
    views: int
    seed: int = 0
    """Of walks, noise and all that is drawn; a fresh walk, to score on, uses seed + 1000."""
    progress: bool = False
    """Whether to show progress on stderr."""
