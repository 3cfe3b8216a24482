"""Commands about what an explorer does with its map: imagine and reach."""

import sys
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
import pandas as pd
from cyclopts import Parameter

from arena import Arena, Camera, Disc, Recording
from arena.acting import Journeys
from arena.bodies.catalogue import bodies
from cogmap.atomic import result_folder
from cogmap.commands.common import Json, MaybePath, Seed, UserPath, read_image, tell
from cogmap.control import MotorModel, Outcome, Reacher, Reaching
from cogmap.errors import CogmapError
from cogmap.experiments.acting.travels import babble, draw_poses, travel
from cogmap.experiments.poses import pose_columns
from cogmap.experiments.result import Result
from cogmap.imagination import Imagination
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.map.novelty import check_known
from cogmap.pages.film import check_film, write_film
from cogmap.plots import plot_journeys


def _dream(
    cmap: UserPath,
    recording: UserPath,
    /,
    *,
    start: Annotated[UserPath, Parameter(name="--from")],
    goal: Annotated[UserPath, Parameter(name="--to")],
    out: UserPath,
    as_json: Json = False,
) -> None:
    """Imagine the way from one view to another, as a film.

    The map's places are relaxed first, from the views of the recording, where they are not yet.

    Example: `cogmap dream map walk.zarr --from here.png --to there.png --out film.mp4`.

    Parameters
    ----------
    cmap
        Folder that `cogmap learn` wrote.
    recording
        Whose views are remembered: those that the map was learnt from.
    start, goal
        Images of the first and the last view, of the size the map was learnt from.
    out
        Film to write, .mp4 or .gif, or a folder for PNGs; it must not exist.
    """
    check_film(out)
    grown, walk = CognitiveMap.load(cmap), Recording.open(recording).without_truth()
    ends = [read_image(path, grown.view_shape_) for path in (start, goal)]
    _refine(grown, walk)
    dream = Imagination(grown, memory=walk.views).film(*ends)
    write_film(dream.views, out)
    tell({"film": str(out), "frames": len(dream), "spread": float(np.median(dream.spread))}, as_json=as_json)


def _reach(
    cmap: UserPath,
    recording: UserPath,
    /,
    *,
    goal: UserPath,
    out: UserPath,
    motor: MaybePath = None,
    start: tuple[float, float, float] | None = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Go to where an image was taken, by sight alone, and look where it looks.

    Without a motor model the body babbles first, in the room of the recording, and leaves what it has learnt
    as `motor` in the folder. Beside it: the journey as a table and as a picture, and its metrics.

    Examples: `cogmap arena furnished --pose 1.2 -0.8 90 --view goal.png`, then
    `cogmap reach map walk.zarr --goal goal.png --out reached`;
    `cogmap reach map walk.zarr --goal goal.png --motor reached/motor --start -1 0.5 180 --out again --json`.

    Parameters
    ----------
    cmap
        Folder that `cogmap learn` wrote.
    recording
        The one that the map was learnt from: it tells room, camera and body, and by its views places are
        relaxed where they are not yet.
    goal
        PNG of the size that the map was learnt from.
    out
        Folder for the journey; an earlier result there is replaced.
    motor
        Folder of a motor model that an earlier call left.
    start
        x, y (m) and heading (°); drawn when not given.
    """
    grown, walk = CognitiveMap.load(cmap), Recording.open(recording)
    image, world = read_image(goal, grown.view_shape_), _world(walk, recording)
    known = None if motor is None else MotorModel.load(motor)
    if start is not None:
        pose = (start[0], start[1], float(np.deg2rad(start[2])))
        world.body.place(world.room, pose, np.random.default_rng(seed))
    _refine(grown, walk)
    if grown.relaxed_places_ is None:
        raise CogmapError(f"this map's places are too coarse to act on: {grown.refine_reason_}")
    check_known(grown.perceive(image[None]), "goal")
    with result_folder(out) as folder:
        if known is None:
            known = babble(world.room, world.camera, grown, world.body, seed)
            known.save(folder / "motor")
        go = Reacher(grown, known).towards(image[None])
        drawn = draw_poses(world.room, world.body.radius, 1, np.random.default_rng(seed))
        begins = drawn if start is None else np.array([pose])
        gone = travel(world.room, go, world.camera, begins, body=world.body, seed=seed)
        result = Result(
            metrics=_metrics(go, gone),
            tables={"journey": _table(gone)},
            figures={"journey": plot_journeys(world.room, gone, None, image[None], world.camera)},
            captions={"journey": "The way over the room, what was seen on it, and the image of the goal"},
        )
        result.write(folder)
    tell(result.metrics, as_json=as_json)


def _refine(cmap: CognitiveMap, walk: Recording) -> None:
    """Relax places where they are not yet, and say so: it takes a while."""
    if cmap.relaxed_places_ is None:
        sys.stderr.write("cogmap: this map is not refined yet; its places are relaxed from the recording\n")
        cmap.refine(walk.views)


class _World(NamedTuple):
    """Where a recording was made, and by whom."""

    room: Arena
    camera: Camera
    body: Disc


def _world(walk: Recording, path: Path) -> _World:
    """Make anew what the attributes of a recording tell."""
    kinds = {kind.__name__: kind for kind in bodies().values()}
    try:
        told = {name: dict(walk.attributes[name]) for name in ("camera", "body")}
        seen_by, moved = told["camera"].pop("kind"), kinds[told["body"].pop("kind")]
        room = Arena.parse(walk.attributes["arena"])
    except (KeyError, TypeError, ValueError):
        seen_by = None
    if seen_by != Camera.__name__:
        raise CogmapError(
            f"{path} does not tell in which room, by which camera and body it was made; "
            "give a recording that `cogmap explore` wrote"
        )
    body = moved(**told["body"])
    if not isinstance(body, Disc):
        raise CogmapError(
            f"{path} was made by a body of kind {type(body).__name__}; only a disc goes by a map"
        )
    return _World(room, Camera(**told["camera"]), body)


def _metrics(go: Reaching, gone: Journeys) -> dict[str, object]:
    way = np.linalg.norm(np.diff(gone.poses[:, 0, :2], axis=0), axis=1).sum()
    return {
        "outcome": Outcome(go.outcomes_[0]).name.lower(),
        "reason": go.reasons_[0],
        "seconds": float(gone.times[gone.steps[0]]),
        "way_m": float(way),
        "touched": bool(gone.touched.any()),
    }


def _table(gone: Journeys) -> pd.DataFrame:
    """Tell of each look when and where it was, what was commanded there, and whether something stopped it."""
    commands = np.concatenate([gone.commands[:, 0], np.full((1, 2), np.nan)])
    return pd.DataFrame(
        {
            "time_s": gone.times,
            **pose_columns(gone.poses[:, 0]),
            "first_command": commands[:, 0],
            "second_command": commands[:, 1],
            "touched": np.append(gone.touched[:, 0], False),
        }
    )
