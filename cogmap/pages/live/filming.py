"""Filming: an explorer that goes from goal to goal by sight alone, picture by picture."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from jaxtyping import UInt8

from cogmap.errors import CogmapError
from cogmap.pages.live.picture import Painting
from cogmap.pages.live.session import Doing, Session
from cogmap.pages.live.world import World

RATE = 12.5
"""Pictures per second: a whole number of hundredths of a second, as a GIF needs it."""
CLEAR = 0.05
"""How far (m) goals are from contact at least."""
REST = 0.8
"""Time (s) at a goal before the next is set."""


def journeys_filmed(
    world: World, *, seconds: float, seed: int = 0
) -> Iterator[UInt8[np.ndarray, "height width 3"]]:
    """Film an explorer that is shown the images of goals, one after the other.

    Parameters
    ----------
    world
        With a motor model and a refined map.
    seconds
        Of the film.
    seed
        Draws start and goals.

    Raises
    ------
    CogmapError
        For a film of no length, and an explorer that goes nowhere by itself, with the reason.
    """
    if not 0 < seconds < np.inf:
        raise CogmapError(f"a film of {seconds} s shows nothing; give a positive time")
    session, painting = Session(world, seed=seed), Painting(world)
    rng = np.random.default_rng(seed)
    rested = REST
    for _ in range(max(1, round(seconds * RATE))):
        if session.doing is not Doing.GOING:
            rested += 1 / RATE
            if rested >= REST:
                _aim(session, rng)
                rested = 0.0
        session.step(1 / RATE)
        yield painting.paint(session, session.look())


def _aim(session: Session, rng: np.random.Generator) -> None:
    """Set the farthest of a few goals, so that there is a way to be seen."""
    world = session.world
    places = world.room.sample_free(6, world.body.radius + CLEAR, rng)
    place = places[np.linalg.norm(places - session.pose[:2], axis=1).argmax()]
    session.aim(float(place[0]), float(place[1]), float(rng.uniform(-np.pi, np.pi)))
    if session.doing is not Doing.GOING:
        raise CogmapError(f"the explorer goes nowhere by itself: {session.said}")
