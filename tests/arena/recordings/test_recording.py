import json
import shutil
from pathlib import Path

import numpy as np
import pytest
import zarr
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from arena.errors import ArenaError
from arena.recordings.recording import Recording
from arena.recordings.sharding import SHARD


def recording(count: int = 600, seed: int = 0, **fields: object) -> Recording:
    rng = np.random.default_rng(seed)
    parts = {
        "views": rng.integers(0, 256, (count, 3, 5, 3), dtype=np.uint8),
        "odours": rng.uniform(0.1, 1, (count, 2)).astype(np.float32),
        "times": np.arange(count) * 0.3,
        "poses": rng.normal(size=(count, 3)),
        "attributes": {"seed": seed, "arena": 'name = "Ähre"\n', "camera": {"width": 5}},
    }
    return Recording(**{**parts, **fields})


def assert_equal(a: Recording, b: Recording) -> None:
    np.testing.assert_array_equal(a.views[:], b.views[:])
    np.testing.assert_array_equal(a.odours, b.odours)
    np.testing.assert_array_equal(a.times, b.times)
    assert (a.poses is None) == (b.poses is None)
    if a.poses is not None:
        np.testing.assert_array_equal(a.poses, b.poses)


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    recording().save(tmp_path / "rec.zarr")
    return tmp_path / "rec.zarr"


@pytest.mark.parametrize("count", [1, SHARD, SHARD + 1, 600])
def test_what_is_saved_is_opened(tmp_path: Path, count: int) -> None:
    rec = recording(count)
    rec.save(tmp_path / "rec.zarr")
    back = Recording.open(str(tmp_path / "rec.zarr"))
    assert isinstance(back.views, zarr.Array)
    assert len(back) == count
    assert back.attributes == {**rec.attributes, "version": 2}
    assert back.views.dtype == np.uint8
    assert (back.odours.dtype, back.times.dtype) == (np.float32, np.float64)
    assert_equal(rec, back)


def test_layout_on_disk(saved: Path) -> None:
    views = json.loads((saved / "views" / "zarr.json").read_text())
    sharding = views["codecs"][0]
    assert views["zarr_format"] == 3
    assert views["chunk_grid"]["configuration"]["chunk_shape"] == [256, 3, 5, 3]
    assert sharding["configuration"]["chunk_shape"] == [1, 3, 5, 3]
    blosc = sharding["configuration"]["codecs"][1]["configuration"]
    assert (blosc["cname"], blosc["clevel"], blosc["shuffle"]) == ("lz4", 9, "noshuffle")
    assert [p.name for p in saved.parent.iterdir()] == ["rec.zarr"]


def test_without_truth(tmp_path: Path) -> None:
    blind = recording().without_truth()
    assert blind.poses is None
    blind.save(tmp_path / "blind.zarr")
    assert not (tmp_path / "blind.zarr" / "poses").exists()
    assert Recording.open(tmp_path / "blind.zarr").poses is None
    assert blind[:3].poses is None


@pytest.mark.parametrize(
    "key",
    [
        slice(None),
        slice(100, 400),
        slice(None, None, -7),
        slice(5, 5),
        np.arange(600) % 3 == 0,
        np.zeros(600, dtype=bool),
        np.array([599, 0, 256, 255, -1, 0]),
    ],
    ids=["all", "slice", "backwards", "none", "mask", "no mask", "indices"],
)
def test_choosing_is_the_same_in_memory_and_on_disk(saved: Path, key: slice | np.ndarray) -> None:
    rec = recording()
    for chosen in (rec[key], Recording.open(saved)[key]):
        assert isinstance(chosen.views, np.ndarray)
        np.testing.assert_array_equal(chosen.views, rec.views[key])
        np.testing.assert_array_equal(chosen.poses, rec.poses[key])
        np.testing.assert_array_equal(chosen.odours, rec.odours[key])
        assert len(chosen) == len(rec.times[key])
        assert chosen.attributes["seed"] == 0


def test_black_views_are_not_missing_views(tmp_path: Path) -> None:
    recording(views=np.zeros((600, 3, 5, 3), dtype=np.uint8)).save(tmp_path / "night.zarr")
    assert not Recording.open(tmp_path / "night.zarr").views[:].any()


@pytest.mark.parametrize("kind", ["folder", "empty folder", "file", "dangling link"])
def test_nothing_is_overwritten(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "x"
    if kind == "file":
        path.write_text("mine")
    elif kind == "dangling link":
        path.symlink_to(tmp_path / "nowhere")
    else:
        path.mkdir()
        if kind == "folder":
            (path / "mine").write_text("mine")
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(ArenaError, match="exists already"):
        recording().save(path)
    assert sorted(tmp_path.rglob("*")) == before


def test_what_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ArenaError, match="cannot write"):
        recording().save(tmp_path / "file" / "rec.zarr")
    with pytest.raises(TypeError):
        recording(attributes={"not JSON": object()}).save(tmp_path / "rec.zarr")
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


def test_missing_recording(tmp_path: Path) -> None:
    with pytest.raises(ArenaError, match="no recording at"):
        Recording.open(tmp_path / "rec.zarr")


@pytest.mark.parametrize("kind", ["file", "folder", "array", "group"])
def test_junk_is_not_a_recording(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "junk"
    match kind:
        case "file":
            path.write_bytes(b"\x00\xff" * 99)
        case "folder":
            path.mkdir()
        case "array":
            zarr.create_array(path, data=np.arange(9))
        case "group":
            zarr.create_group(path)
    with pytest.raises(ArenaError, match="is not a recording"):
        Recording.open(path)


def test_other_version(saved: Path) -> None:
    zarr.open_group(saved).attrs["version"] = 1
    with pytest.raises(ArenaError, match="version 1, not 2"):
        Recording.open(saved)


def test_half_written(saved: Path) -> None:
    shutil.rmtree(saved / "views" / "c" / "2")
    with pytest.raises(
        ArenaError, match="512 of its 600 views are there; the same `explore` command"
    ) as error:
        Recording.open(saved)
    assert "\n" not in str(error.value)


def test_shard_that_was_cut_short_is_missing(saved: Path) -> None:
    shard = saved / "views" / "c" / "1" / "0" / "0" / "0"
    shard.write_bytes(shard.read_bytes()[:-100])
    with pytest.raises(ArenaError, match="344 of its 600 views"):
        Recording.open(saved)


@pytest.mark.parametrize("name", ["odours", "times", "poses"])
def test_column_that_has_lost_its_values(saved: Path, name: str) -> None:
    shutil.rmtree(saved / name / "c")
    with pytest.raises(ArenaError, match=f"damaged .a part of {name} is missing"):
        Recording.open(saved)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('"uint8"', '"int8"'),
        ('"uint8"', '"uint16"'),
        ('"fill_value": 0', '"fill_value": 7'),
        ("600", "500"),
        ("600", "512"),
        ("600", "700"),
        ("256", "512"),
        ("1,", "2,"),
        ('"lz4"', '"zstd"'),
        ('"end"', '"start"'),
        ('"/"', '"."'),
    ],
)
def test_views_that_are_described_otherwise(saved: Path, before: str, after: str) -> None:
    description = saved / "views" / "zarr.json"
    text = description.read_text()
    assert before in text
    description.write_text(text.replace(before, after))
    with pytest.raises(ArenaError, match="damaged") as error:
        Recording.open(saved)
    assert "\n" not in str(error.value)


def test_black_views_at_time_zero_where_nothing_smells(tmp_path: Path) -> None:
    rec = recording(
        3,
        views=np.zeros((3, 3, 5, 3), np.uint8),
        odours=np.ones((3, 0), np.float32),
        times=np.zeros(3),
        poses=np.zeros((3, 3)),
    )
    rec.save(tmp_path / "black.zarr")
    assert_equal(rec, Recording.open(tmp_path / "black.zarr"))


@pytest.mark.parametrize("name", ["odours", "times", "views"])
def test_column_that_is_gone(saved: Path, name: str) -> None:
    shutil.rmtree(saved / name)
    with pytest.raises(ArenaError, match="damaged"):
        Recording.open(saved)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("odours", np.ones((599, 2), np.float32)),
        ("odours", np.ones((600, 2), np.float64)),
        ("odours", np.full((600, 2), np.nan, np.float32)),
        ("odours", np.zeros((600, 2), np.float32)),
        ("times", np.zeros((600, 1))),
        ("times", np.full(600, np.inf)),
        ("poses", np.zeros((600, 2))),
        ("poses", np.full((600, 3), np.nan)),
    ],
)
def test_arrays_that_do_not_fit(saved: Path, name: str, values: np.ndarray) -> None:
    shutil.rmtree(saved / name)
    with zarr.config.set({"array.write_empty_chunks": True}):
        zarr.open_group(saved).create_array(name, data=values)
    with pytest.raises(ArenaError, match=f"damaged: {name} ") as error:
        Recording.open(saved)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "fields",
    [
        {"odours": np.full((600, 2), np.nan, np.float32)},
        {"poses": np.full((600, 3), np.inf)},
        {"times": np.full(600, np.nan)},
    ],
    ids=lambda fields: next(iter(fields)),
)
def test_nan_in_memory(fields: dict[str, np.ndarray]) -> None:
    with pytest.raises(ArenaError, match="NaN"):
        recording(**fields)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damaged_metadata_never_ends_in_a_traceback(saved: Path, data: st.DataObject) -> None:
    file = saved / data.draw(st.sampled_from(["zarr.json", "views/zarr.json", "odours/zarr.json"]))
    sound = file.read_bytes()
    cut = data.draw(st.integers(0, len(sound)))
    junk = data.draw(st.sampled_from([b"", b"}", b"7", b"null", b"\xff", b'"x"']))
    skip = data.draw(st.integers(0, 12))
    file.write_bytes(sound[:cut] + junk + sound[cut + skip :])
    try:
        Recording.open(saved)
    except ArenaError as error:
        message = str(error)
    else:
        message = "sound after all"
    file.write_bytes(sound)
    assert len(message.splitlines()) == 1
