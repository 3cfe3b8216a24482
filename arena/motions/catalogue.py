"""Motions by their names."""

from collections.abc import Callable

from arena.motions.base import Motion
from arena.motions.brownian import Brownian
from arena.motions.chemotaxis import Chemotaxis
from arena.motions.cyclic import Cyclic
from arena.motions.replay import Replay
from arena.motions.rotation import Rotation
from arena.motions.track import Track

MOTIONS: dict[str, Callable[..., Motion]] = {
    "brownian": Brownian,
    "rotation": Rotation,
    "cyclic": Cyclic,
    "chemotaxis": Chemotaxis,
    "track": Track,
    "replay": Replay,
}
