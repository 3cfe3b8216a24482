"""Commands that show an explorer at large: a page in the browser, and a film."""

import socket
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter

from arena import Arena, Camera, Recording
from arena.bodies.catalogue import bodies
from arena.eye.overhead import Overhead
from cogmap.commands.acting import _refine, _world
from cogmap.commands.common import Json, MaybePath, Seed, UserPath, tell
from cogmap.control import MotorModel
from cogmap.coordinates import GeneralisedCoordinates
from cogmap.errors import CogmapError
from cogmap.experiments.acting.travels import babble
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.pages.film import check_film, write_frames
from cogmap.pages.live.filming import RATE, journeys_filmed
from cogmap.pages.live.freezing import freeze as frozen
from cogmap.pages.live.mind import Mind
from cogmap.pages.live.posture import Mechanism
from cogmap.pages.live.world import World


def _page(
    cmap: UserPath,
    /,
    *,
    memory: UserPath,
    arena: str | None = None,
    motor: MaybePath = None,
    replay: list[UserPath] | None = None,
    freeze: MaybePath = None,
    poses: int = 240,
    port: int = 8080,
    open_browser: Annotated[bool, Parameter(name="--show", negative="")] = False,
    seed: Seed = 0,
) -> None:
    """Show the explorer in a browser: it looks, dreams, and goes where one points, until Ctrl-C.

    The page is served on this machine alone. Needs the extra `page`: `pip install 'cogmap[page]'`.

    Examples: `cogmap page map --memory walk.zarr --arena furnished`; with the motor model that `cogmap reach`
    left: `cogmap page map --memory walk.zarr --motor reached/motor --replay rat.zarr`; as one file to mail,
    which needs no server: `cogmap page map --memory walk.zarr --freeze page.html`.

    Parameters
    ----------
    cmap
        Folder that `cogmap learn --refine` wrote, whose places are relaxed first where they are not yet; or
        one of coordinates of an arm (`GeneralisedCoordinates.save`), to bend its joints.
    memory
        The recording that it was learnt from: what the explorer remembers.
    arena
        A room of the gallery or a TOML file; that of the recording when not given.
    motor
        Folder of a motor model that `cogmap reach` left; else the body babbles first.
    replay
        Other recordings to replay, of real animals' paths, too; may be given several times.
    freeze
        Write this .html file, which holds sampled poses and asks for nothing, and serve no page.
    poses
        How many it holds.
    port
        Of 127.0.0.1.
    open_browser
        Open the page in a browser at once.
    """
    if freeze is not None:
        world = _prepared(cmap, memory, arena, seed=seed, acts=False)
        written = frozen(world, freeze, poses=poses, seed=seed)
        tell({"page": str(written), "bytes": written.stat().st_size}, as_json=False)
        return
    try:
        from cogmap.pages.live.server import serve  # noqa: PLC0415
    except ImportError as error:
        raise CogmapError(
            f"the page needs NiceGUI ({error}); install it: pip install 'cogmap[page]'"
        ) from None
    _check_port(port)
    if (cmap / "coordinates.json").is_file():
        serve(_mechanism(cmap, memory), port=port, show=open_browser)
    else:
        world = _prepared(cmap, memory, arena, motor=motor, replay=replay or (), seed=seed)
        serve(world, port=port, show=open_browser)


def _film(
    cmap: UserPath,
    /,
    *,
    memory: UserPath,
    out: UserPath,
    arena: str | None = None,
    motor: MaybePath = None,
    seconds: float = 20.0,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Film the explorer as it goes from goal to goal by sight alone, as the page shows it, without a browser.

    Examples: `cogmap film map --memory walk.zarr --out journey.mp4`;
    `cogmap film map --memory walk.zarr --motor reached/motor --seconds 8 --out journey.gif`.

    Parameters
    ----------
    cmap
        Folder that `cogmap learn --refine` wrote; its places are relaxed first where they are not yet.
    memory
        The recording that the map was learnt from: what the explorer remembers.
    out
        Film to write, .mp4 or .gif, or a folder for PNGs; it must not exist.
    arena
        A room of the gallery or a TOML file; that of the recording when not given.
    motor
        Folder of a motor model that `cogmap reach` left; else the body babbles first.
    seconds
        How long it is.
    """
    check_film(out)
    world = _prepared(cmap, memory, arena, motor=motor, seed=seed)
    write_frames(journeys_filmed(world, seconds=seconds, seed=seed), out, rate=RATE)
    tell({"film": str(out), "seconds": seconds, "frames_per_second": RATE}, as_json=as_json)


def _prepared(
    cmap: Path,
    memory: Path,
    arena: str | None,
    *,
    motor: Path | None = None,
    replay: Sequence[Path] = (),
    seed: int,
    acts: bool = True,
) -> World:
    """Load a map with what it remembers, and make all that a first page would wait for."""
    grown, walk = CognitiveMap.load(cmap), Recording.open(memory)
    place = _world(walk, memory)
    room = place.room if arena is None else Arena.load(arena)
    _refine(grown, walk)
    known = None if motor is None else MotorModel.load(motor)
    if acts and known is None and grown.relaxed_places_ is not None:
        _say("the body babbles, to learn what its commands do")
        known = babble(room, place.camera, grown, place.body, seed)
    _say("what is remembered is laid out; it takes some seconds")
    mind = Mind(grown, memory=np.asarray(walk.views[:]), motor=known)
    replays = {path.stem: Recording.open(path) for path in (memory, *replay)}
    world = World(room, place.camera, place.body, mind, walk, replays=replays)
    world.prepare()
    return world


def _mechanism(coordinates: Path, memory: Path) -> Mechanism:
    """Load coordinates of a body with joints, and what the recording tells of it."""
    walk = Recording.open(memory)
    kinds = {kind.__name__: kind for kind in bodies().values()}
    try:
        told = {name: dict(walk.attributes[name]) for name in ("camera", "body")}
        seen_by, moved = told["camera"].pop("kind"), kinds[told["body"].pop("kind")]
        room = Arena.parse(walk.attributes["arena"])
        eye = {"Camera": Camera, "Overhead": Overhead}[seen_by](**told["camera"])
    except (KeyError, TypeError, ValueError):
        raise CogmapError(
            f"{memory} does not tell in which room, by which eye and body it was made; "
            "give a recording that `cogmap explore --body` wrote"
        ) from None
    return Mechanism(room, moved(**told["body"]), eye, GeneralisedCoordinates.load(coordinates), walk)


def _say(what: str) -> None:
    sys.stderr.write(f"cogmap: {what}\n")


def _check_port(port: int) -> None:
    with socket.socket() as door:
        door.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            door.bind(("127.0.0.1", port))
        except (OSError, OverflowError) as error:
            raise CogmapError(f"port {port} cannot be had ({error}); choose another with --port") from None
