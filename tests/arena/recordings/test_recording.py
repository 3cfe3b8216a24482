import json
import shutil
from pathlib import Path

import numpy as np
import pytest
import zarr
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from arena.errors import ArenaError
from arena.recordings import storage
from arena.recordings.recording import Recording, _check
from arena.recordings.sharding import SHARD
from arena.recordings.storage import StoredViews


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
    assert isinstance(back.views, StoredViews)
    assert len(back) == count
    assert back.attributes == rec.attributes
    assert back.views.dtype == np.uint8
    assert (back.odours.dtype, back.times.dtype) == (np.float32, np.float64)
    assert_equal(rec, back)


def test_layout_on_disk(saved: Path) -> None:
    views = json.loads((saved / "views" / "zarr.json").read_text())
    sharding = views["codecs"][0]
    assert views["zarr_format"] == 3
    assert views["chunk_grid"]["configuration"]["chunk_shape"] == [256, 3, 5, 3]
    assert sharding["configuration"]["chunk_shape"] == [1, 3, 5, 3]
    assert [codec["name"] for codec in sharding["configuration"]["codecs"]] == ["bytes", "blosc", "crc32c"]
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


def test_commands_are_no_truth_and_may_stop(tmp_path: Path) -> None:
    commands = np.full((600, 2), 0.5)
    commands[-1] = np.nan
    rec = recording(commands=commands).without_truth()
    rec.save(tmp_path / "rec.zarr")
    back = Recording.open(tmp_path / "rec.zarr")
    np.testing.assert_array_equal(back.require("commands"), commands)
    np.testing.assert_array_equal(back[590:].commands, commands[590:])
    with pytest.raises(ArenaError, match="commands has NaN or infinite"):
        recording(commands=np.full((600, 2), np.inf))
    with pytest.raises(ArenaError, match="commands is float64"):
        _check(rec.views, {"times": rec.times, "commands": commands[1:]})


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
    zarr.open_group(saved).attrs["version"] = 2
    with pytest.raises(ArenaError, match="version 2, not 4"):
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
    with pytest.raises(ArenaError, match=f"damaged .{name} does not match its checksum"):
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
    rec = Recording.open(saved)
    shutil.rmtree(saved / name)
    for description in saved.rglob("zarr.json"):
        description.unlink()
    storage.describe(saved, rec.views.shape, {**rec._columns, name: values}, rec.attributes)
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


def rich(count: int = 4) -> Recording:
    """A small recording with every kind of array."""
    rng = np.random.default_rng(1)
    signals = {"speed": rng.normal(size=count), "paws": rng.integers(0, 2, (count, 2, 2)).astype(bool)}
    return recording(count, joints=rng.normal(size=(count, 5)), signals=signals)


def test_arrays_are_named_and_optional(tmp_path: Path) -> None:
    rec = rich()
    rec.save(tmp_path / "rich.zarr")
    back = Recording.open(tmp_path / "rich.zarr")
    assert_equal(rec, back)
    assert list(back.signals) == ["speed", "paws"]
    for found in (back, rec[:], back[:]):
        np.testing.assert_array_equal(found.joints, rec.joints)
        for name, values in rec.signals.items():
            np.testing.assert_array_equal(found.signals[name], values)
            np.testing.assert_array_equal(found.require(f"signals/{name}"), values)
    np.testing.assert_array_equal(back[np.array([2])].signals["speed"], rec.signals["speed"][[2]])


def test_views_and_times_are_enough(tmp_path: Path) -> None:
    rec = Recording(views=np.zeros((3, 2, 2, 3), np.uint8), times=np.arange(3.0))
    rec.save(tmp_path / "bare.zarr")
    for bare in (rec, Recording.open(tmp_path / "bare.zarr"), rec[:2]):
        assert (bare.odours, bare.poses, bare.joints, bare.signals) == (None, None, None, {})
        with pytest.raises(ArenaError, match="has no odours, only views, times; use one that has"):
            bare.require("odours")
    assert sorted(path.name for path in (tmp_path / "bare.zarr").iterdir()) == ["times", "views", "zarr.json"]


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("speed", np.zeros(3)),
        ("speed", np.full(4, np.nan)),
        ("speed", np.array(0.0)),
        ("speed", np.array(list("abcd"))),
        ("../speed", np.zeros(4)),
        ("a/b", np.zeros(4)),
        ("", np.zeros(4)),
    ],
)
def test_signals_that_do_not_fit(name: str, values: np.ndarray) -> None:
    with pytest.raises(ArenaError, match=f"signals/{name} "):
        _check(np.zeros((4, 2, 2, 3), np.uint8), {"times": np.arange(4.0), f"signals/{name}": values})


@pytest.mark.parametrize("arrays", [[], ["odours", "times"], ["times", "../x"], ["times", 7], 7, None])
def test_list_of_arrays_that_is_damaged(saved: Path, arrays: object) -> None:
    zarr.open_group(saved).attrs["arrays"] = arrays
    with pytest.raises(ArenaError, match=r"damaged .its attributes are not what was written") as error:
        Recording.open(saved)
    assert "\n" not in str(error.value)


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("small") / "rich.zarr"
    rich().save(path)
    return path


def outcome(path: Path) -> str:
    """What opening and reading a recording ends in."""
    wanted = rich()
    try:
        found = Recording.open(path)[:]
    except ArenaError as error:
        return str(error)
    assert_equal(found, wanted)
    np.testing.assert_array_equal(found.joints, wanted.joints)
    assert found.signals.keys() == wanted.signals.keys()
    for name, values in wanted.signals.items():
        np.testing.assert_array_equal(found.signals[name], values)
        assert found.signals[name].dtype == values.dtype
    return "harmless"


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_a_flipped_bit_is_one_sentence(
    small: Path, capfd: pytest.CaptureFixture[str], data: st.DataObject
) -> None:
    """In the content of any array, and in what describes it."""
    files = [path for path in sorted(small.rglob("*")) if path.is_file() and path != small / "zarr.json"]
    file = data.draw(st.sampled_from(files))
    sound = file.read_bytes()
    bit = data.draw(st.integers(0, 8 * len(sound) - 1))
    damaged = bytearray(sound)
    damaged[bit // 8] ^= 1 << bit % 8
    file.write_bytes(damaged)
    try:
        said = outcome(small)
    finally:
        file.write_bytes(sound)
    assert len(said.splitlines()) == 1
    assert capfd.readouterr() == ("", "")
    if "c" in file.relative_to(small).parts:
        assert said != "harmless"


def test_many_damaged_views_are_one_sentence(saved: Path, capfd: pytest.CaptureFixture[str]) -> None:
    shard = saved / "views" / "c" / "1" / "0" / "0" / "0"
    content = bytearray(shard.read_bytes())
    for at in range(8, len(content) - 5000, 20):
        content[at] ^= 255
    shard.write_bytes(content)
    rec = Recording.open(saved)
    np.testing.assert_array_equal(rec.views[:256], recording().views[:256])
    with pytest.raises(ArenaError, match=r"views/c/1/0/0/0 is damaged .*checksum.*; remove it") as error:
        rec[:]
    assert len(str(error.value).splitlines()) == 1
    assert capfd.readouterr() == ("", "")


def test_views_that_are_lost_after_opening_are_not_black(saved: Path) -> None:
    rec = Recording.open(saved)
    shutil.rmtree(saved / "views" / "c" / "1")
    with pytest.raises(ArenaError, match="damaged"):
        rec.views[300]
    rec.views[0]
