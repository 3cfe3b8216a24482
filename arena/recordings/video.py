"""Videos, frame by frame."""

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np

from arena.errors import ArenaError
from arena.recordings.colours import Picture


def frame_rate(path: Path) -> float | None:
    """Tell how many frames a second a video shows (Hz), as far as it says.

    Raises
    ------
    ArenaError
        When it is no video that can be read.
    """
    capture = _opened(path)
    rate = float(capture.get(cv2.CAP_PROP_FPS))
    capture.release()
    return rate if np.isfinite(rate) and rate > 0 else None


def frames(path: Path) -> Iterator[Picture]:
    """Give the frames of a video, to the last that can be read: how many they are, no video knows.

    Raises
    ------
    ArenaError
        When it is no video that can be read.
    """
    capture = _opened(path)
    try:
        while True:
            there, frame = capture.read()
            if not there:
                return
            yield np.asarray(cv2.cvtColor(frame, cv2.COLOR_BGR2RGB))
    finally:
        capture.release()


def _opened(path: Path) -> cv2.VideoCapture:
    capture = cv2.VideoCapture(str(path))
    if not capture.isOpened():
        raise ArenaError(
            f"{path} is no video that can be read; give MP4, AVI or MKV, or a folder of its frames as PNG"
        )
    return capture
