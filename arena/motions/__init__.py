"""Ways of moving through an arena, one file each."""

from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from arena.arena import Arena
from arena.body import Body


class Walk(NamedTuple):
    """Where a body was when it looked."""

    times: Float[np.ndarray, " views"]
    """s, never decreasing."""
    poses: Float[np.ndarray, "views 3"]
    """x, y in m and heading in rad, in (−π, π]."""


@runtime_checkable
class Motion(Protocol):
    """Steers a body through an arena and says when it looks.

    A motion is a value: `model_dump` gives the parameters that, with the arena, the body and the generator's
    state, determine every walk to the last bit. All poses of a walk come from one `Drive`.
    """

    def walk(self, arena: Arena, body: Body, views: int, rng: np.random.Generator) -> Walk:
        """Move until this many views are taken.

        Raises
        ------
        ArenaError
            When the body cannot start.
        """
        ...

    def model_dump(self) -> dict[str, object]:
        """Give the parameters."""
        ...
