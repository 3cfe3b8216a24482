from pathlib import Path

import cv2
import numpy as np
import pytest

from arena.errors import ArenaError
from arena.recordings.images import pictures_of
from arena.recordings.recording import Recording
from arena.recordings.video import frame_rate, frames

FRAMES = np.random.default_rng(0).integers(0, 256, (9, 32, 48, 3), dtype=np.uint8)


@pytest.fixture
def film(tmp_path: Path) -> Path:
    """Without loss, so that its frames are known."""
    path = tmp_path / "film.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"FFV1"), 12.5, (48, 32))
    for frame in FRAMES:
        writer.write(frame[..., ::-1])
    writer.release()
    return path


def test_every_frame_in_order(film: Path) -> None:
    np.testing.assert_array_equal(list(frames(film)), FRAMES)
    assert frame_rate(film) == 12.5
    found = pictures_of(film)
    assert (found.number, found.rate) == (None, 12.5)


def test_a_recording_of_it_has_its_times_unless_told(film: Path, tmp_path: Path) -> None:
    rec = Recording.from_images(film)
    np.testing.assert_array_equal(rec.views, FRAMES)
    np.testing.assert_allclose(rec.times, np.arange(9) / 12.5)
    assert rec.attributes["beside"]["times"] == "video"
    again = Recording.from_images(film, out=tmp_path / "film.zarr", rate=2)
    np.testing.assert_array_equal(again.views[:], FRAMES)
    np.testing.assert_array_equal(again.times, np.arange(9) / 2)


def test_no_video(tmp_path: Path) -> None:
    (tmp_path / "film.mp4").write_bytes(b"no film" * 100)
    with pytest.raises(ArenaError, match="is no video that can be read; give MP4, AVI or MKV"):
        frame_rate(tmp_path / "film.mp4")
    with pytest.raises(ArenaError, match="is no video that can be read"):
        Recording.from_images(tmp_path / "film.mp4")
