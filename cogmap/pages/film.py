"""Films: views as an MP4 or a folder of PNGs."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from jaxtyping import UInt8

from cogmap.atomic import atomic_write, user_path
from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, checked_views


def check_film(out: str | Path) -> Path:
    """Give the path of a film to write, or raise unless it is new and ends in .mp4, or is a folder."""
    out = user_path(out)
    if out.suffix not in {".mp4", ""}:
        raise CogmapError(f"a film is not written as {out.suffix}; let it end in .mp4, or give a folder")
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
        RGB images, (frames, height, width, 3) uint8. An MP4 shows each pixel as four, so that its frames are
        of even size whatever theirs is.
    out
        A new file that ends in .mp4, or a new folder for `0000.png` and so on.
    rate
        Frames per second.

    Raises
    ------
    CogmapError
        For another kind of file, one that is there, and an MP4 where OpenCV has no encoder.
    """
    frames, out = checked_views(views), check_film(out)
    with atomic_write(out, overwrite=False) as path:
        if out.suffix == ".mp4":
            _write_mp4(frames, path, rate)
        else:
            path.mkdir()
            for index, view in enumerate(frames):
                cv2.imwrite(str(path / f"{index:04d}.png"), cv2.cvtColor(view, cv2.COLOR_RGB2BGR))


def _write_mp4(views: UInt8[np.ndarray, "frames height width 3"], path: Path, rate: float) -> None:
    # encoders take even sizes only, and a pixel that is four of them bears their compression
    height, width = (2 * length for length in views.shape[1:3])
    film = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"mp4v"), rate, (width, height))
    if not film.isOpened():
        raise CogmapError("OpenCV has no encoder for MP4 here; write a folder instead")
    for view in views:
        large = cv2.resize(view, (width, height), interpolation=cv2.INTER_NEAREST)
        film.write(cv2.cvtColor(large, cv2.COLOR_RGB2BGR))
    film.release()
