"""Steered explorations: what one explorer meets that a policy steers, written down as it comes."""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from arena.acting import Step
from arena.atomic import atomic_write
from arena.bodies.base import POSE, Body
from arena.errors import ArenaError
from arena.eye.camera import Images
from arena.motions.policy import Policy, Sensed
from arena.recordings import storage
from arena.recordings.recording import Recording
from arena.recordings.sharding import SHARD, write_shards


def of_one(policy: Policy, motors: int = 2) -> Policy:
    """Let a policy for one explorer steer a batch of one, which has so many motors."""

    def steer(sensed: Sensed) -> np.ndarray:
        command = policy({name: values[0] for name, values in sensed.items()})
        return np.full((1, motors), np.nan) if command is None else np.asarray(command, float)[None]

    return steer


def write_down(
    steps: Iterator[Step],
    dt: float,
    out: Path | None,
    shape: tuple[int, int, int],
    attributes: dict[str, Any],
    *,
    body: Body,
) -> Recording:
    """Record the steps (dt s each) of a batch of one, in memory, or on disk shard by shard.

    Raises
    ------
    ArenaError
        When there is something at `out` already, or it cannot be written.
    """
    odours, poses, commands, joints = (list[np.ndarray]() for _ in range(4))

    def views() -> Iterator[tuple[slice, Images]]:
        while shard := list(islice(steps, SHARD)):
            odours.extend(step.sensed["odour"][0] for step in shard)
            poses.extend(step.poses[0] for step in shard)
            commands.extend(step.commands[0] for step in shard)
            joints.extend(step.configurations[0] for step in shard)
            images = np.array([step.sensed["view"][0] for step in shard])
            yield slice(len(poses) - len(shard), len(poses)), images

    def columns() -> dict[str, Any]:
        return {
            "times": dt * np.arange(len(poses)),
            "odours": np.array(odours),
            "poses": np.array(poses),
            "commands": np.array(commands),
            **({} if body.axes == POSE else {"joints": np.array(joints)}),
        }

    if out is None:
        images = np.concatenate([images for _, images in views()])
        return Recording(views=images, **columns(), attributes={**attributes, "views": len(images)})
    with atomic_write(out, ArenaError, overwrite=False) as folder:
        write_shards(folder / "views", views())
        storage.describe(folder, (len(poses), *shape), columns(), {**attributes, "views": len(poses)})
    return Recording.open(out)
