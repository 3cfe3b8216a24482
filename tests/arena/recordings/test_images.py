from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pytest

from arena.errors import ArenaError
from arena.recordings.images import Item, natural, pictures_of

FRAMES = np.random.default_rng(0).integers(0, 256, (12, 4, 6, 3), dtype=np.uint8)


def write(path: Path, picture: np.ndarray) -> Path:
    swapped = picture if picture.ndim == 2 else picture[..., [2, 1, 0, 3][: picture.shape[2]]]
    path.write_bytes(cv2.imencode(path.suffix, swapped)[1].tobytes())
    return path


def read(source: object) -> list[np.ndarray]:
    return [item.read()[1] for item in pictures_of(source).items()]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for number, frame in enumerate(FRAMES):
        write(tmp_path / f"img{number}.png", frame)
    (tmp_path / "notes.txt").write_text("not a picture")
    (tmp_path / "._img3.png").write_bytes(b"\x00\x05\x16\x07")
    (tmp_path / "more.png").mkdir()
    return tmp_path


def test_a_folder_in_natural_order(folder: Path) -> None:
    assert pictures_of(folder).number == 12
    np.testing.assert_array_equal(read(folder), FRAMES)
    np.testing.assert_array_equal(read(str(folder)), FRAMES)


def test_natural_order() -> None:
    names = [
        "b1",
        "IMG_10.jpg",
        "img_9.jpg",
        "img_010.jpg",
        "img_2b.jpg",
        "img_2a10.jpg",
        "img_2a9.jpg",
        "7",
        "x",
    ]
    assert sorted(names, key=natural) == [
        "7", "b1", "img_2a9.jpg", "img_2a10.jpg", "img_2b.jpg", "img_9.jpg", "IMG_10.jpg", "img_010.jpg", "x",
    ]  # fmt: skip


def test_the_home_folder_is_written_out(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(folder.parent))
    assert pictures_of(f"~/{folder.name}").number == 12
    assert len(read([f"~/{folder.name}/img0.png"])) == 1


@pytest.mark.parametrize(
    "picture",
    [
        FRAMES[0][..., 0],
        FRAMES[0][..., 0].astype(np.uint16) * 257,
        np.dstack([FRAMES[0][..., [0, 0, 0]], np.full((4, 6), 9, np.uint8)]),
        FRAMES[0][..., [0, 0, 0]],
    ],
    ids=["grey", "16 bit", "RGBA", "RGB"],
)
def test_files_of_every_depth(tmp_path: Path, picture: np.ndarray) -> None:
    (made,) = read(write(tmp_path / "it.PNG".lower(), picture))
    np.testing.assert_array_equal(made, FRAMES[0][..., [0, 0, 0]])


def test_a_jpeg_is_what_another_decoder_makes_of_it(tmp_path: Path) -> None:
    smooth = cv2.GaussianBlur(np.repeat(np.repeat(FRAMES[0], 9, 0), 9, 1), (0, 0), 4)
    (made,) = read([write(tmp_path / "it.JPG".replace("JPG", "jpg"), smooth)])
    assert np.abs(made.astype(int) - smooth).mean() < 2


def test_arrays_lists_and_iterators(folder: Path) -> None:
    paths = [folder / f"img{number}.png" for number in range(12)]
    for source in (
        FRAMES,
        list(FRAMES),
        tuple(paths),
        pd.Series([str(path) for path in paths]),
        iter(FRAMES),
    ):
        np.testing.assert_array_equal(read(source), FRAMES)
    np.testing.assert_array_equal(read(FRAMES[..., 0]), FRAMES[..., [0, 0, 0]])
    np.testing.assert_array_equal(read(path for path in paths), FRAMES)
    assert pictures_of(list(FRAMES)).number == pictures_of(FRAMES).number == 12
    assert pictures_of(iter(FRAMES)).number is None


def test_one_memory_for_all_pictures() -> None:
    """As a camera that writes each picture to the same place."""

    def camera() -> Iterator[np.ndarray]:
        memory = np.empty_like(FRAMES[0])
        for frame in FRAMES:
            memory[:] = frame
            yield memory

    items = list(pictures_of(camera()).items())
    np.testing.assert_array_equal([item.read()[1] for item in items], FRAMES)


def test_checksums_tell_contents_apart(folder: Path) -> None:
    item, other = (Item(name, folder / name) for name in ("img0.png", "img1.png"))
    assert item.checksum() == item.read()[0] != other.checksum()
    array, shaped = Item("a", FRAMES[0]), Item("b", FRAMES[0].reshape(6, 4, 3))
    assert array.checksum() == array.read()[0] != shaped.checksum()
    assert Item("c", np.zeros((2, 2), np.uint8)).checksum() != Item("d", np.zeros((2, 2), bool)).checksum()


def test_a_folder_that_has_changed_is_described_otherwise(folder: Path) -> None:
    before = pictures_of(folder).described
    assert pictures_of(folder).described == before
    (folder / "img11.png").rename(folder / "img12.png")
    assert pictures_of(folder).described != before


@pytest.mark.parametrize("content", [b"", b"no picture", cv2.imencode(".jpg", FRAMES[0])[1].tobytes()[:-40]])
def test_a_picture_that_cannot_be_read_is_named(folder: Path, content: bytes) -> None:
    (folder / "img7.png").write_bytes(content)
    with pytest.raises(
        ArenaError, match=r"img7\.png is no picture that can be read; mend it, or leave it out"
    ):
        read(folder)


def test_sources_without_pictures(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "other" / "inside").mkdir(parents=True)
    (tmp_path / "other" / "a.txt").write_text("")
    for source, words in {
        tmp_path / "empty": "has no pictures .it is empty.; give a folder of .bmp, .jpeg",
        tmp_path / "other": "has no pictures .only .txt, folders.",
        tmp_path / "nowhere": "there is nothing at .*nowhere; give a folder of pictures or a video",
        (): "the list of pictures is empty",
        7: "7 has no pictures",
    }.items():
        with pytest.raises(ArenaError, match=words):
            pictures_of(source)
    with pytest.raises(ArenaError, match=r"cannot read gone\.png: No such file"):
        read(["gone.png"])


@pytest.mark.parametrize("shape", [(4, 6, 3), (4, 6, 4), (0, 4, 6, 3), (1, 2, 3, 4, 5)])
def test_arrays_that_may_be_one_picture(shape: tuple[int, ...]) -> None:
    with pytest.raises(ArenaError, match=r"give \(views, height, width, 3\)"):
        pictures_of(np.zeros(shape, np.uint8))
