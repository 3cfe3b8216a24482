"""The command that grows a map of what many explorers see."""

import sys
from typing import Annotated, Literal

from cyclopts import Parameter

from arena.motions.catalogue import motions
from cogmap.commands.common import Json, Seed, Told, UserPath, tell
from cogmap.experiments.parameters import build, by_family, parse, unknown
from cogmap.growing import grow

_TOLD = ("motion", "camera", "body", "nose", "map")


def _grow(
    arena: str,
    /,
    *,
    out: UserPath,
    explorers: int = 64,
    views: int = 1_000_000,
    charts: int | None = None,
    epoch: int | None = None,
    scheduler: str | None = None,
    threads: int | None = None,
    motion: Annotated[str, Parameter(help=f"How to move: {', '.join(motions())}.")] = "brownian",
    camera: Literal["panoramic", "perspective"] = "panoramic",
    width: int | None = None,
    height: int | None = None,
    nose_noise: float = 0.1,
    told: Told = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Grow one map of what many explorers see; killed at any moment, the same command goes on.

    Examples: `cogmap grow furnished --out map`;
    `cogmap grow pillar --explorers 16 --views 200000 --charts 6000 --out map2`;
    `cogmap grow furnished --out /shared/map --scheduler tcp://10.0.0.1:8786`.

    Parameters
    ----------
    arena
        A room of the gallery or a TOML file.
    out
        Folder of the map; it must not exist, and all workers of a scheduler must see it.
    explorers, views
        How many, and how many views of all of them together.
    charts
        Of the map; a third of the views by default, 6,000 at most.
    epoch
        Views of an epoch in the stages that one thread learns; 50,000 by default, or all if fewer.
    scheduler
        Address of a Dask scheduler, whose workers learn shares of the explorers.
    threads
        How many on this machine; as many as cores by default.
    camera
        What they look through: all around, or 90° ahead.
    width, height
        Of the views, pixels; 360×60 all around, 320×240 ahead by default.
    nose_noise
        Standard deviation of the log of the smelt concentration.
    told
        Any other parameter of motion, camera, nose, body or map, as `map.components=80`.
    """
    given = {
        "motion": motion, "camera": camera, "camera.width": width, "camera.height": height,
        "nose.noise": nose_noise,
    }  # fmt: skip
    parts = by_family({name: value for name, value in given.items() if value is not None} | parse(told or []))
    for family in parts.keys() - {*_TOLD}:
        raise unknown(family, list(_TOLD))
    grown = grow(
        arena,
        out,
        explorers=explorers,
        views=views,
        charts=charts,
        epoch=epoch,
        motion=build("motion", parts["motion"]),
        camera=build("camera", parts["camera"]),
        nose=build("nose", parts["nose"]),
        body=build("body", parts.get("body", {})),
        seed=seed,
        threads=threads,
        scheduler=scheduler,
        progress=sys.stderr.isatty(),
        **build("map", parts.get("map", {})),
    )
    verdict = {"trusted": grown.trusted_, "reason": grown.reason_, "metric_reason": grown.metric_reason_}
    about = {"map": str(out), "charts": grown.charts, "explorers": explorers, "views": views}
    tell({**about, **verdict, "seconds": grown.seconds_}, as_json=as_json)
