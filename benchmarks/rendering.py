"""How fast the eye paints, against ViZDoom, a memory copy and pymunk's segment queries."""

import importlib.util
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numba
import numpy as np
import pymunk

from arena import Arena, Camera
from benchmarks.timing import ROOM, Figures, missing, one_core, poses, versus

CAMERAS = {
    "perspective_320x240": Camera.perspective(),
    "panoramic_360x60": Camera.panoramic(),
    "strip_90x15": Camera.panoramic(90, 15),
}
COPIED = 64 * 10**6
"""Bytes of images that a plain copy moves, more than caches hold."""
VIEWS = 200
BATCH = 8
"""Views painted at a time, into the same images: what a core's cache holds."""


def rendering() -> Figures:
    """Paint views of `furnished`, frames per second of one core.

    Frames of 320×240 pixels stand beside ViZDoom's of its basic scenario, whose game steps once a frame, and
    frames of each camera beside a copy of as many bytes from memory to memory. The room of 400 surfaces is
    `furnished` with a dozen pillars. Depths are rays per second, beside segment queries of the same room.
    """
    with one_core():
        figures: Figures = {
            "perspective_320x240_over_vizdoom": over_vizdoom(),
            **{name: over_copy(camera) for name, camera in CAMERAS.items()},
            **{f"{name}_few_surfaces": over_crowded(camera) for name, camera in CAMERAS.items()},
            "depth": over_pymunk(),
        }
    return {"surfaces": len(ROOM.surfaces.start), **figures, "two_threads": two_threads()}


def painting(camera: Camera, room: Arena = ROOM, batch: int = BATCH) -> Callable[[], int]:
    """Give work that paints views, so many at a time, into the same images."""
    batches = np.split(poses(VIEWS, room), range(batch, VIEWS, batch))
    images = np.empty((batch, camera.height, camera.width, 3), np.uint8)

    def paint() -> int:
        for where in batches:
            camera.render(room, where, out=images[: len(where)])
        return VIEWS

    return paint


def over_copy(camera: Camera) -> Figures:
    """Frames per second in turn with those that memory copies."""
    views = -(-COPIED // camera.render(ROOM, poses(1)).nbytes)
    images = np.ones((views, camera.height, camera.width, 3), np.uint8)
    into = np.ones_like(images)

    def copy() -> int:
        np.copyto(into, images)
        return views

    return versus(painting(camera), copy, beside="a memory copy")


def over_crowded(camera: Camera) -> Figures:
    """Frames per second of the room with 24 surfaces in turn with one with 400."""
    return versus(painting(camera), painting(camera, crowded()), beside="400 surfaces")


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
        return {"peer": "one thread", "not_measured": "numba has one thread here"}
    paint = painting(CAMERAS["perspective_320x240"], batch=VIEWS)

    def on(threads: int) -> int:
        numba.set_num_threads(threads)
        return paint()

    return versus(lambda: on(2), lambda: on(1), beside="one thread")


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
        return missing("ViZDoom")
    with tempfile.TemporaryDirectory() as folder, doom(Path(folder)) as play:
        return versus(painting(CAMERAS["perspective_320x240"]), play, beside="ViZDoom")


def over_pymunk() -> Figures:
    """Rays per second of `Camera.depth` in turn with those of pymunk's segment queries."""
    camera, where = CAMERAS["panoramic_360x60"], poses(50)
    space = ROOM.space()
    angles = np.pi - (np.arange(camera.width) + 0.5) / camera.focal_length

    def look() -> int:
        return camera.depth(ROOM, where).size

    def ask() -> int:
        for x, y, heading in where:
            for angle in heading + angles:
                ends = (x + 10 * np.cos(angle), y + 10 * np.sin(angle))
                space.segment_query_first((x, y), ends, 0, pymunk.ShapeFilter())
        return len(where) * len(angles)

    return versus(look, ask, beside="pymunk's segment queries")
