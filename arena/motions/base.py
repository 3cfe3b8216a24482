"""The contract of a motion: it steers a body through an arena and says when it looks."""

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from arena.bodies.base import Body
from arena.bodies.disc import Disc
from arena.rooms.arena import Arena


class Walk(NamedTuple):
    """Where a body was when it looked."""

    times: Float[np.ndarray, " views"]
    """s, never decreasing."""
    poses: Float[np.ndarray, "views axes"]
    """x, y in m and heading in rad, in (−π, π]; of another body than a disc, where it was on its axes."""
    notes: Mapping[str, object] = {}
    """What else there is to know about this walk, as far as JSON can say; `explore` keeps it."""
    commands: Float[np.ndarray, "views motors"] | None = None
    """What was commanded from each view to the next, in [−1, 1], by a motion that gives one a view."""


def join(strides: Iterable[Walk]) -> Walk:
    """Put the parts of a walk together; the last has the notes."""
    parts = list(strides)
    given = [part.commands for part in parts if part.commands is not None]
    times, poses = (np.concatenate([part[k] for part in parts]) for k in range(2))
    return Walk(times, poses, parts[-1].notes, np.concatenate(given) if given else None)


@runtime_checkable
class Motion(Protocol):
    """Steers a body through an arena and says when it looks.

    A motion is a value: `model_dump` gives the parameters that, with the arena, the body and the generator's
    state, determine every walk to the last bit. All poses of a walk come from one `Drive`, or from a recorded
    path; the body is free in each. Most motions steer a `Disc` only; see `MovesAnyBody`.
    """

    @property
    def default_views(self) -> int | None:
        """How many `explore` takes unless told; None takes all there are."""

    def walk(self, arena: Arena, body: Disc, views: int | None, rng: np.random.Generator) -> Walk:
        """Move until this many views are taken.

        Raises
        ------
        ArenaError
            When the body cannot start.
        """

    def model_dump(self) -> dict[str, object]:
        """Give the parameters."""


@runtime_checkable
class MovesAnyBody(Protocol):
    """A motion that moves any body, as `Motion` a disc."""

    @property
    def any_body(self) -> bool:
        """That it does."""

    def walk(self, arena: Arena, body: Body, views: int | None, rng: np.random.Generator) -> Walk:
        """Move until this many views are taken."""


class Striding:
    """A motion that gives its views while it goes on: `explore` paints them meanwhile."""

    def strides(
        self, arena: Arena, body: Disc, views: int | None, rng: np.random.Generator
    ) -> Iterator[Walk]:
        """Move, some views at a time, until this many are taken; raises as `walk` does."""
        raise NotImplementedError

    def walk(self, arena: Arena, body: Disc, views: int | None, rng: np.random.Generator) -> Walk:
        """Move until this many views are taken."""
        return join(self.strides(arena, body, views, rng))
