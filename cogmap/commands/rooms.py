"""Commands about rooms and the ways through them."""

import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Literal

import cv2
import numpy as np
from cyclopts import Parameter

from arena import Arena, Camera, Disc, TrackWarning, explore, gallery
from arena.atomic import check_absent
from arena.bodies.catalogue import bodies
from arena.motions.catalogue import motions
from arena.recordings.judged import judged
from cogmap.atomic import atomic_write
from cogmap.commands.common import Json, MaybePath, Seed, Told, UserPath, tell
from cogmap.errors import CogmapError
from cogmap.experiments.parameters import build, by_family, parse, unknown
from cogmap.plots import plot_room, plot_sheet


def _arena(
    name: str | None = None,
    /,
    *,
    out: MaybePath = None,
    sheet: MaybePath = None,
    view: MaybePath = None,
    pose: tuple[float, float, float] | None = None,
    width: int = 360,
    height: int = 60,
    schema: Annotated[bool, Parameter(negative="")] = False,
    as_json: Json = False,
) -> None:
    """Show a room: what is in it, a picture of it from above, and how it looks from inside.

    Examples: `cogmap arena pillar --out pillar.png --sheet views.png`; `cogmap arena my_room.toml --json`;
    `cogmap arena pillar --pose 1.2 -0.8 90 --view goal.png`; `cogmap arena --schema > arena.schema.json`.

    Parameters
    ----------
    name
        A room of the gallery or a TOML file.
    out
        PNG to write the picture from above to; it must not exist.
    sheet
        PNG to write perspective and panoramic views to; it must not exist.
    view
        PNG to write what is seen all around from `pose` to; it must not exist.
    pose
        x, y (m) and heading (°) from which `view` is taken.
    width, height
        Of the view, pixels.
    schema
        Print the JSON Schema of the TOML files instead.
    """
    if schema:
        tell(Arena.json_schema(), as_json=True)
        return
    if name is None:
        raise CogmapError(f"no room is given; choose one of {', '.join(gallery())} or give a TOML file")
    room = Arena.load(name)
    described = {
        "arena": room.name,
        **{parts: len(getattr(room, parts)) for parts in ("walls", "boxes", "pillars", "blocks")},
        "odour_sources": len(room.sources),
        "free_area_m2": float(room.free_space(Disc().radius).area),
    }
    if (view is None) != (pose is None):
        raise CogmapError("a view needs a place: give --view and --pose together")

    def take(file: Path) -> None:
        x, y, degrees = pose or (0.0, 0.0, 0.0)
        seen = Camera.panoramic(width, height).render(room, np.array([[x, y, np.deg2rad(degrees)]]))[0]
        file.write_bytes(cv2.imencode(".png", cv2.cvtColor(seen, cv2.COLOR_RGB2BGR))[1].tobytes())

    writers: tuple[tuple[Path | None, Callable[[Path], None]], ...] = (
        (out, lambda file: plot_room(room).savefig(file, format="png")),
        (sheet, lambda file: plot_sheet(room).savefig(file, format="png")),
        (view, take),
    )
    for path, write in writers:
        if path is not None:
            check_absent(path, CogmapError)
            if not path.parent.is_dir():  # a mistyped folder is not made
                raise CogmapError(f"cannot write {path}: No such file or directory")
            with atomic_write(path) as fresh:
                write(fresh)
    tell(described, as_json=as_json)


def _explore(
    arena: str,
    /,
    *,
    out: UserPath,
    motion: Annotated[str, Parameter(help=f"How to move: {', '.join(motions())}.")] = "brownian",
    odorant: int | None = None,
    path: MaybePath = None,
    fit: bool | None = None,
    views: int | None = None,
    camera: Literal["panoramic", "perspective", "overhead"] = "panoramic",
    width: int | None = None,
    height: int | None = None,
    nose_noise: float = 0.1,
    body: Annotated[str, Parameter(help=f"What moves: {', '.join(bodies())}.")] = "disc",
    told: Told = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Walk through a room and record what is seen and smelt; a killed exploration goes on when called again.

    Examples: `cogmap explore furnished --out walk.zarr`; `cogmap explore pillar --views 5000 --out p.zarr`;
    `cogmap explore furnished --motion rotation --camera perspective --out spin.zarr`;
    `cogmap explore open_field --motion replay --path rat.csv --fit --out rat.zarr`;
    `cogmap explore open_field --motion replay --path dlc.csv --fit --set motion.bodypart=nose
    --set motion.rate=30 --set motion.least_likelihood=0.9 --set motion.y_down=true --out rat.zarr`;
    `cogmap explore furnished --motion babble --body arm --camera overhead --set body.limits=one --out arm`.

    Parameters
    ----------
    arena
        A room of the gallery or a TOML file.
    out
        Folder of the recording.
    odorant
        Which odour `chemotaxis` climbs, from 0.
    path
        CSV, Parquet or NPZ file of the path that `replay` follows: columns t (s), x, y (m) and, optionally,
        heading (rad) or heading_deg. Other columns, units and lost samples are told by `--set`, such as
        `motion.x=nose_x`, `motion.missing=[0, 1023]`, `motion.calibration=[[80, 40], [560, 40], 1.2]`.
    fit
        Whether `replay` scales and moves the path to fit the room.
    views
        How many to take; what the motion does by default, such as 17,000 brownian ones, or all of a path.
    camera
        What it looks through: all around, 90° ahead, or down on it from above.
    width, height
        Of the views, pixels; 360×60 all around, 320×240 ahead and 64×64 from above by default.
    nose_noise
        Standard deviation of the log of the smelt concentration.
    told
        Any other parameter of motion, camera, nose or body, as `body.limits=one` or `motion.swing_every=100`.
    """
    given = {
        "motion": motion, "motion.odorant": odorant, "motion.path": path, "motion.fit": fit,
        "camera": camera, "camera.width": width, "camera.height": height,
        "nose.noise": nose_noise, "body": body,
    }  # fmt: skip
    parts = by_family({name: value for name, value in given.items() if value is not None} | parse(told or []))
    for family in parts.keys() - {"motion", "camera", "nose", "body"}:
        raise unknown(family, ["motion", "camera", "nose", "body"])
    recording = explore(
        Arena.load(arena),
        build("motion", parts["motion"]),
        build("camera", parts["camera"]),
        nose=build("nose", parts["nose"]),
        body=build("body", parts["body"]),
        views=views,
        seed=seed,
        out=out,
        progress=sys.stderr.isatty(),
    )
    said = judged(recording.attributes["walk"])
    if said:
        warnings.warn(f"{path or motion}: {said}", TrackWarning, stacklevel=2)
    odorants = recording.require("odours").shape[1]
    tell({"recording": str(out), "views": len(recording), "odorants": odorants}, as_json=as_json)
