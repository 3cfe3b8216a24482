"""Frames per second of the eye, against ViZDoom, a memory copy and pymunk's segment queries."""

import importlib.util
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numba
import numpy as np
import pymunk

from arena import Arena, Camera
from benchmarks.timing import ROOM, Figures, missing, one_core, poses, seconds, versus

CAMERAS = {
    "perspective_320x240": Camera.perspective(),
    "panoramic_360x60": Camera.panoramic(),
    "strip_92x15": Camera.panoramic(92, 15),
}
COPIED = 64 * 10**6
"""Bytes of images that a plain copy moves, more than caches hold."""
VIEWS = 200
BATCH = 8
"""Views painted at a time, into the same images: what a core's cache holds."""


def rendering() -> Figures:
    """Measure everything about rendering."""
    with one_core():
        figures: Figures = {
            "surfaces": len(ROOM.surfaces.start),
            **{name: on_one_core(camera) for name, camera in CAMERAS.items()},
            "perspective_320x240_over_vizdoom_one_core": over_vizdoom(),
            "perspective_400_surfaces_cost": cost_of_surfaces(CAMERAS["perspective_320x240"]),
            "panoramic_400_surfaces_cost": cost_of_surfaces(CAMERAS["panoramic_360x60"]),
            "strip_400_surfaces_cost": cost_of_surfaces(CAMERAS["strip_92x15"]),
            "depth_over_pymunk_rays_one_core": over_pymunk(),
        }
    return {**figures, "perspective_two_threads_over_one": two_threads()}


def painting(camera: Camera, room: Arena = ROOM, batch: int = BATCH) -> Callable[[], int]:
    """Give work that paints views, so many at a time, into the same images."""
    batches = np.split(poses(VIEWS, room), range(batch, VIEWS, batch))
    images = np.empty((batch, camera.height, camera.width, 3), np.uint8)

    def paint() -> int:
        for where in batches:
            camera.render(room, where, out=images[: len(where)])
        return VIEWS

    return paint


def on_one_core(camera: Camera) -> Figures:
    """Frames per second, and as a fraction of the rate at which memory copies the same images."""
    views = -(-COPIED // camera.render(ROOM, poses(1)).nbytes)
    images = np.ones((views, camera.height, camera.width, 3), np.uint8)
    into = np.ones_like(images)

    def copy() -> int:
        np.copyto(into, images)
        return views

    found = versus(painting(camera), copy)
    return {"frames_per_s": found["per_s"], "over_memory_copy": found["ratio"]}


def cost_of_surfaces(camera: Camera) -> float | int | str | Figures:
    """Time for a view of a room with 400 surfaces over one of the room with 24."""
    return versus(painting(camera), painting(camera, crowded()))["ratio"]


def crowded() -> Arena:
    """Furnish the room with 400 surfaces: its own walls and three of its boxes, and a dozen pillars."""
    x, y = np.meshgrid([-2.5, -0.9, 0.9, 2.5], [-2.1, 0.0, 2.1])
    pillars = [
        {"center": center, "radius": 0.15, "height": 0.6 + 0.05 * index, "material": "granite"}
        for index, center in enumerate(zip(x.ravel().tolist(), y.ravel().tolist(), strict=True))
    ]
    room = ROOM.model_dump(exclude_defaults=True)
    return Arena.create(**{**room, "boxes": ROOM.boxes[:3], "pillars": pillars, "sources": ()})


def two_threads() -> Figures:
    """Frames per second on two threads over those on one, in turn."""
    if numba.config.NUMBA_NUM_THREADS < 2:
        return {"not_measured": "numba has one thread here"}
    paint = painting(CAMERAS["perspective_320x240"], batch=VIEWS)

    def on(threads: int) -> int:
        numba.set_num_threads(threads)
        return paint()

    found = versus(lambda: on(2), lambda: on(1))
    return {key: found[key] for key in ("ratio", "ratio_median", "ratio_lowest", "ratio_highest")}


@contextmanager
def doom(folder: Path) -> Iterator[Callable[[], int]]:
    """Give work that turns a player on the spot and looks at each frame."""
    import vizdoom  # noqa: PLC0415  a peer that may be missing

    game = vizdoom.DoomGame()
    # Else it leaves its settings in the current folder.
    game.set_doom_config_path(str(folder / "settings.ini"))
    game.load_config(str(Path(vizdoom.scenarios_path) / "basic.cfg"))
    game.set_mode(vizdoom.Mode.PLAYER)
    game.set_screen_resolution(vizdoom.ScreenResolution.RES_320X240)
    game.set_screen_format(vizdoom.ScreenFormat.RGB24)
    for switch in ("window_visible", "render_hud", "render_weapon", "render_crosshair", "sound_enabled"):
        getattr(game, f"set_{switch}")(False)  # noqa: FBT003  ViZDoom takes it by position
    for buffer in ("depth", "labels", "automap"):
        getattr(game, f"set_{buffer}_buffer_enabled")(False)  # noqa: FBT003
    game.set_available_buttons([vizdoom.Button.TURN_LEFT_RIGHT_DELTA])
    game.set_available_game_variables([])
    game.set_episode_timeout(10**6)
    game.init()

    def play() -> int:
        total = 0
        for _ in range(VIEWS):
            if game.is_episode_finished():
                game.new_episode()
            total += int(game.get_state().screen_buffer[120, 160, 0])
            game.make_action([7.0])
        return VIEWS

    try:
        yield play
    finally:
        game.close()


def over_vizdoom() -> Figures:
    """Frames per second in turn with ViZDoom's, both on the same core."""
    if importlib.util.find_spec("vizdoom") is None:
        return missing("vizdoom")
    with tempfile.TemporaryDirectory() as folder, doom(Path(folder)) as play:
        return versus(painting(CAMERAS["perspective_320x240"]), play)


def over_pymunk() -> float:
    """Rays per second of `Camera.depth` over those of pymunk's segment queries."""
    camera, where = CAMERAS["panoramic_360x60"], poses(50)
    space = ROOM.space()
    angles = np.pi - (np.arange(camera.width) + 0.5) / camera.focal_length

    def ask() -> None:
        for x, y, heading in where:
            for angle in heading + angles:
                ends = (x + 10 * np.cos(angle), y + 10 * np.sin(angle))
                space.segment_query_first((x, y), ends, 0, pymunk.ShapeFilter())

    return seconds(ask) / seconds(lambda: camera.depth(ROOM, where))
