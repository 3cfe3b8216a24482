import shutil
from pathlib import Path

import numpy as np
import pytest

import arena
from arena import ArenaError, Recording
from arena.recordings import sharding
from arena.recordings.rescue import examine

VIEWS = 600


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    rng = np.random.default_rng(0)
    path = tmp_path_factory.mktemp("whole") / "rec.zarr"
    Recording(
        views=rng.integers(0, 256, (VIEWS, 3, 5, 3), dtype=np.uint8),
        times=np.arange(VIEWS) * 0.3,
        odours=rng.uniform(0.1, 1, (VIEWS, 2)).astype(np.float32),
        signals={"wifi": rng.normal(size=VIEWS)},
        attributes={"seed": 3},
    ).save(path)
    return path


@pytest.fixture
def hurt(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(whole, tmp_path / "rec.zarr"))


def shard(path: Path, number: int) -> Path:
    return path / "views" / "c" / str(number) / "0" / "0" / "0"


def spoil(file: Path, at: int) -> None:
    content = bytearray(file.read_bytes())
    content[at] ^= 1
    file.write_bytes(content)


def assert_rows(found: Recording, whole: Path, rows: np.ndarray) -> None:
    wanted = Recording.open(whole)
    np.testing.assert_array_equal(found.views[:], wanted.views[:][rows])
    np.testing.assert_array_equal(found.times, wanted.times[rows])
    np.testing.assert_array_equal(found.signals["wifi"], wanted.signals["wifi"][rows])


def test_of_what_is_whole_nothing_is_left_out(whole: Path) -> None:
    found = examine(whole)
    assert found.whole.all()
    assert (found.damage, found.unwritten) == ((), 0)
    rescued = arena.rescue(whole)
    assert_rows(rescued, whole, np.arange(VIEWS))
    assert rescued.attributes == {"seed": 3, "rescued": {"of": VIEWS, "lost": []}}


def test_all_but_the_damaged_view_is_rescued(hurt: Path, whole: Path, tmp_path: Path) -> None:
    spoil(shard(hurt, 1), 8 + 40)
    with pytest.raises(ArenaError, match=r"view 256 does not match its checksum.*arena.rescue"):
        Recording.open(hurt)[:]
    found = examine(hurt)
    assert np.flatnonzero(~found.whole).tolist() == [256]
    assert len(found.damage) == 1
    assert found.damage[0] == f"in {shard(hurt, 1)} 1 views cannot be read, the first is view 256"
    rescued = arena.rescue(hurt)
    rows = np.delete(np.arange(VIEWS), 256)
    assert_rows(rescued, whole, rows)
    assert rescued.attributes["rescued"] == {"of": VIEWS, "lost": [256]}
    np.testing.assert_array_equal(rescued.views[300:310], Recording.open(whole).views[301:311])
    rescued.save(tmp_path / "rest.zarr")
    assert_rows(Recording.open(tmp_path / "rest.zarr"), whole, rows)


def test_a_shard_without_its_index_is_left_out(hurt: Path, whole: Path) -> None:
    spoil(shard(hurt, 0), -5)
    with pytest.raises(ArenaError, match=r"damaged: 344 of its 600 views are there, and .*/c/0/0/0/0 is not"):
        Recording.open(hurt)
    assert_rows(arena.rescue(hurt), whole, np.arange(256, VIEWS))


def test_views_that_were_never_made_are_no_damage(hurt: Path, whole: Path) -> None:
    shard(hurt, 2).unlink()
    found = examine(hurt)
    assert (found.unwritten, found.damage) == (VIEWS - 512, ())
    assert_rows(arena.rescue(hurt), whole, np.arange(512))


def test_an_array_that_is_damaged_is_left_out(hurt: Path, whole: Path) -> None:
    spoil(hurt / "odours" / "c" / "0" / "0", 7)
    with pytest.raises(ArenaError, match=r"damaged .odours cannot be read: .*arena.rescue"):
        Recording.open(hurt)
    rescued = arena.rescue(hurt)
    assert rescued.odours is None
    assert_rows(rescued, whole, np.arange(VIEWS))


def test_attributes_that_are_damaged_are_left_out(hurt: Path, whole: Path) -> None:
    text = (hurt / "zarr.json").read_text()
    (hurt / "zarr.json").write_text(text.replace('"seed": 3', '"seed": 2'))
    with pytest.raises(ArenaError, match="attributes are not what was written"):
        Recording.open(hurt)
    rescued = arena.rescue(hurt)
    assert rescued.attributes == {"rescued": {"of": VIEWS, "lost": []}}
    assert_rows(rescued, whole, np.arange(VIEWS))


@pytest.mark.parametrize("lost", ["views/zarr.json", "times/c/0", "views/c"])
def test_nothing_can_be_rescued(hurt: Path, lost: str) -> None:
    gone = hurt / lost
    shutil.rmtree(gone) if gone.is_dir() else gone.unlink()
    with pytest.raises(ArenaError, match=r"nothing of .*rec.zarr can be rescued: ") as error:
        arena.rescue(hurt)
    assert len(str(error.value).splitlines()) == 1


def test_a_view_that_its_codec_cannot_read_is_one_sentence(
    hurt: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """Its checksum fits: it was written so."""
    file = shard(hurt, 2)
    content, size = bytearray(file.read_bytes()), 16 * 256 + 4
    length = int.from_bytes(content[-size + 8 : -size + 16], "little")
    content[8 : 8 + length - 4] = bytes(length - 4)
    content[8 + length - 4 : 8 + length] = sharding._checksum(bytes(length - 4))
    file.write_bytes(content)
    with pytest.raises(ArenaError, match="is damaged") as error:
        Recording.open(hurt)[:]
    assert len(str(error.value).splitlines()) == 1
    assert np.flatnonzero(~examine(hurt).whole).tolist() == [512]
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("path", ["nothing", "rec.zarr/views"])
def test_what_is_no_recording(hurt: Path, path: str) -> None:
    with pytest.raises(ArenaError, match=r"no recording at|is not a recording"):
        arena.rescue(hurt.parent / path)
