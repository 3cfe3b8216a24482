"""Films: views as an MP4, a GIF or a folder of PNGs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain, islice
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import UInt8
from PIL import Image

from cogmap.atomic import atomic_write, user_path
from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, checked_views

Frame = UInt8[np.ndarray, "height width 3"]
KINDS = (".mp4", ".gif", "")
SMALL = 640
"""Width (pixels) below which an MP4 shows each pixel as four: they bear its compression."""
FIRST = 12
"""Frames that the palette of a GIF is made of."""


def check_film(out: str | Path) -> Path:
    """Give the path of a film to write; raise unless it is new, and an .mp4, a .gif or a folder."""
    out = user_path(out)
    if out.suffix not in KINDS:
        raise CogmapError(
            f"a film is not written as {out.suffix}; let it end in .mp4 or .gif, or give a folder"
        )
    if out.exists() or out.is_symlink():
        raise CogmapError(
            f"{out} exists already and is left as it is; choose another path or remove it first"
        )
    return out


def write_film(views: AnyArray, out: str | Path, *, rate: float = 15.0) -> None:
    """Write views one after the other, whole or not at all.

    Parameters
    ----------
    views
        RGB images, (frames, height, width, 3) uint8. An MP4 shows each pixel of small ones as four.
    out
        A new file that ends in .mp4 or .gif, or a new folder for `0000.png` and so on.
    rate
        Frames per second; a GIF has whole hundredths of a second a frame.

    Raises
    ------
    CogmapError
        For another kind of file, one that is there, and an MP4 where OpenCV has no encoder.
    """
    write_frames(iter(checked_views(views)), out, rate=rate)


def write_frames(frames: Iterable[Frame], out: str | Path, *, rate: float = 15.0) -> None:
    """Write frames as they come, as `write_film` does; no more than a dozen are held."""
    out = check_film(out)
    with atomic_write(out, overwrite=False) as path:
        if out.suffix == ".mp4":
            _write_mp4(iter(frames), path, rate)
        elif out.suffix == ".gif":
            _write_gif(iter(frames), path, rate)
        else:
            path.mkdir()
            for index, view in enumerate(frames):
                cv2.imwrite(str(path / f"{index:04d}.png"), cv2.cvtColor(view, cv2.COLOR_RGB2BGR))


def _write_mp4(frames: Iterator[Frame], path: Path, rate: float) -> None:
    first = next(frames)
    # encoders take even sizes only, and a pixel that is four of them bears their compression
    times = 2 if first.shape[1] < SMALL or first.shape[0] % 2 or first.shape[1] % 2 else 1
    height, width = (times * length for length in first.shape[:2])
    film = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"mp4v"), rate, (width, height))
    if not film.isOpened():
        raise CogmapError("OpenCV has no encoder for MP4 here; write a folder or a GIF instead")
    for view in chain([first], frames):
        large = cv2.resize(view, (width, height), interpolation=cv2.INTER_NEAREST)
        film.write(cv2.cvtColor(large, cv2.COLOR_RGB2BGR))
    film.release()


def _write_gif(frames: Iterator[Frame], path: Path, rate: float) -> None:
    begun = list(islice(frames, FIRST))
    # one palette for all: a palette a frame flickers; of several frames, as more comes into sight
    shown = Image.fromarray(np.concatenate([view[::3, ::3] for view in begun]))
    palette = shown.quantize(256, dither=Image.Dither.NONE)
    drawn = (
        Image.fromarray(view).quantize(palette=palette, dither=Image.Dither.NONE)
        for view in chain(begun, frames)
    )
    next(drawn).save(path, "GIF", save_all=True, append_images=drawn, duration=round(100 / rate) * 10, loop=0)
