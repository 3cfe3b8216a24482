"""Frames: what a page shows of a moment, in numbers and pictures that JSON can carry."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from jaxtyping import Float

from cogmap.pages.live.pictures import data_url, heat, packed
from cogmap.pages.live.scenery import Json
from cogmap.pages.live.session import Look, Session
from cogmap.pages.live.world import World


def frame(session: Session, look: Look) -> Json:
    """Give all that changes from step to step."""
    activity, thought = look.thought.activity, look.thought
    dreamt = thought.dreamt
    return {
        "pose": _listed(look.pose),
        "ghost": _listed(look.ghost),
        "errors": {"m": _number(look.errors[0]), "rad": _number(look.errors[1])},
        "touched": look.touched,
        "seen": data_url(look.view),
        "dream": None if dreamt is None else data_url(dreamt.view),
        "surprise": None if dreamt is None or dreamt.unusual is None else data_url(heat(dreamt.unusual)),
        "surprised": None if dreamt is None or dreamt.unusual is None else _number(dreamt.unusual.max()),
        "novelty": None if activity.novelty is None else _number(activity.novelty[0]),
        "place": _bytes(activity.place[0], session.world.full_rates[0]),
        "heading": _bytes(activity.heading[0], session.world.full_rates[1]),
        "near": [_remembered(session.world, int(view)) for view in thought.nearest],
        "point": _listed(thought.point),
        "doing": session.doing.value,
        "lights": session.lights,
        "goal": _listed(session.goal),
        "route": np.round(session.route, 3).tolist(),
        "said": session.said,
        "replay": {"name": session.replay, "at": session.at, "length": session.length},
    }


def dreamt_frames(session: Session, since: int) -> list[str]:
    """Give the dreamt views of the route from one on, which are sent once each."""
    return [data_url(view) for view in session.dreamt[since:]]


@lru_cache(maxsize=256)
def _remembered(world: World, view: int) -> Json:
    pose = world.poses[view]
    return {"view": data_url(np.asarray(world.mind.memory[view])), "pose": np.round(pose, 3).tolist()}


def _bytes(rates: Float[np.ndarray, "cells"], full: float) -> str:
    return packed(np.round(255 * np.clip(np.nan_to_num(rates) / full, 0, 1)).astype(np.uint8))


def _listed(values: Any) -> list[float | None] | None:
    return None if values is None else [_number(value) for value in values]


def _number(value: Any) -> float | None:
    return round(float(value), 4) if np.isfinite(value) else None
