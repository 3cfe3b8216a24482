from pathlib import Path

import cv2
import numpy as np
import pytest

from cogmap import CogmapError
from cogmap.pages.film import write_film

VIEWS = (
    np.repeat(np.arange(6, dtype=np.uint8)[:, None, None, None] * 40, 15, axis=1).repeat(91, 2).repeat(3, 3)
)


def test_an_mp4_has_all_frames(tmp_path: Path) -> None:
    write_film(VIEWS, tmp_path / "film.mp4", rate=10.0)
    film = cv2.VideoCapture(str(tmp_path / "film.mp4"))
    frames = [film.read() for _ in range(7)]
    assert [read for read, _ in frames] == [True] * 6 + [False]
    assert frames[0][1].shape == (30, 182, 3)
    assert [round(float(frame.mean()) / 40) for _, frame in frames[:6]] == list(range(6))


def test_a_folder_holds_the_very_views(tmp_path: Path) -> None:
    write_film(VIEWS, tmp_path / "frames")
    read = [cv2.imread(str(path)) for path in sorted((tmp_path / "frames").iterdir())]
    np.testing.assert_array_equal(np.stack(read), VIEWS)


def test_what_is_there_stays_and_other_kinds_are_refused(tmp_path: Path) -> None:
    (tmp_path / "film.mp4").write_text("mine")
    with pytest.raises(CogmapError, match="exists already"):
        write_film(VIEWS, tmp_path / "film.mp4")
    assert (tmp_path / "film.mp4").read_text() == "mine"
    with pytest.raises(CogmapError, match=r"not written as \.avi"):
        write_film(VIEWS, tmp_path / "film.avi")
    assert [path.name for path in tmp_path.iterdir()] == ["film.mp4"]


def test_frames_of_odd_sizes_and_a_tilde_are_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    write_film([view[:, :7] for view in VIEWS], "~/odd.mp4")
    assert cv2.VideoCapture(str(tmp_path / "odd.mp4")).read()[1].shape == (30, 14, 3)
