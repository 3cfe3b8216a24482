import errno
import os
import signal
import socket
import subprocess
import sys
import textwrap
import threading
import time
import tracemalloc
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest
import zarr

from arena.bodies.arm import Arm
from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.exploration import explore
from arena.eye.base import AnyEye
from arena.eye.camera import Camera
from arena.eye.overhead import Overhead
from arena.motions.babble import Babble
from arena.motions.base import Walk
from arena.motions.brownian import Brownian
from arena.motions.chemotaxis import Chemotaxis
from arena.motions.policy import Sensed
from arena.motions.replay import Replay
from arena.motions.track import Track
from arena.recordings import sharding
from arena.recordings.recording import Recording
from arena.recordings.sharding import file, is_complete
from arena.rooms.arena import Arena
from arena.smell.nose import Nose

VIEWS = 700


class Toy:
    """A camera whose pixels are a hash of the pose; it may be slow, or kill its process at some call."""

    height, width = 4, 6

    def __init__(self, gain: int = 1, kill_at: int | None = None, pause: float = 0.0) -> None:
        self.gain = gain
        self.pause = pause
        self.kill_at = kill_at
        self.calls: list[int] = []

    def model_dump(self) -> dict[str, object]:
        return {"gain": self.gain, "size": (self.height, self.width)}

    def render(self, arena: Arena, poses: np.ndarray, *, rng: np.random.Generator) -> np.ndarray:
        if len(self.calls) == self.kill_at:
            os.kill(os.getpid(), signal.SIGKILL)
        assert isinstance(arena, Arena)
        assert isinstance(rng, np.random.Generator)
        self.calls.append(len(poses))
        time.sleep(self.pause)
        bits = np.ascontiguousarray(poses).view(np.uint64).sum(axis=1) * np.uint64(self.gain)
        pixels = np.arange(4 * 6 * 3, dtype=np.uint64).reshape(4, 6, 3)
        return (bits[:, None, None, None] * (pixels + np.uint64(1)) >> np.uint64(20)).astype(np.uint8)


def go(camera: Toy | Camera | None = None, **fields: object) -> Recording:
    return explore(Arena.load("open_field"), Brownian(), camera or Toy(), **{"views": VIEWS, **fields})


def assert_equal(a: Recording, b: Recording) -> None:
    for name in ("odours", "times", "poses"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
    np.testing.assert_array_equal(a.views[:], b.views[:])
    assert a.attributes == b.attributes


def snapshot(path: Path) -> dict[str, bytes]:
    return {str(file): file.read_bytes() for file in sorted(path.rglob("*")) if file.is_file()}


def test_recording_holds_what_was_seen_and_smelt_on_the_way() -> None:
    rec = go(nose=Nose(noise=0.0))
    arena = Arena.load("open_field")
    assert rec.views.shape == (VIEWS, 4, 6, 3)
    np.testing.assert_array_equal(rec.views, Toy().render(arena, rec.poses, rng=np.random.default_rng(0)))
    wanted = arena.odours.concentration(rec.poses[:, :2])
    np.testing.assert_array_equal(rec.odours, wanted.astype(np.float32))
    assert (np.diff(rec.times) > 0).all()


def test_attributes_tell_how_to_do_it_again() -> None:
    rec = go(seed=3, nose=Nose(noise=0.2), body=Disc(radius=0.2))
    told = rec.attributes
    assert Arena.parse(told["arena"]) == Arena.load("open_field")
    assert told["camera"] == {"kind": "Toy", "gain": 1, "size": [4, 6]}
    parts = [told[part] for part in ("motion", "nose", "body")]
    motion, nose, body = (
        kind(**{name: value for name, value in part.items() if name != "kind"})
        for kind, part in zip((Brownian, Nose, Disc), parts, strict=True)
    )
    again = explore(
        Arena.parse(told["arena"]),
        motion,
        Toy(),
        nose=nose,
        body=body,
        views=told["views"],
        seed=told["seed"],
    )
    assert_equal(rec, again)


def test_without_a_number_the_motion_says_how_many(tmp_path: Path) -> None:
    arena = Arena.load("open_field")
    assert len(explore(arena, Track(), Toy())) == Track.default_views
    np.savez(tmp_path / "path.npz", t=np.arange(300) / 50, x=np.linspace(-1, 1, 300), y=np.zeros(300))
    rat = Replay(path=tmp_path / "path.npz")
    once = explore(arena, rat, Toy(), out=tmp_path / "rec.zarr")
    assert len(once) == 300
    camera = Toy()
    assert_equal(explore(arena, rat, camera, out=tmp_path / "rec.zarr"), once)
    assert camera.calls == []
    assert once.attributes["motion"]["path"] == str(tmp_path / "path.npz")
    assert len(explore(arena, rat, Toy(), views=20)) == 20


@pytest.mark.parametrize("where", ["memory", "disk"])
def test_notes_of_the_walk_are_kept(tmp_path: Path, where: str) -> None:
    arena, out = Arena.load("open_field"), tmp_path / "rec.zarr" if where == "disk" else None
    rec = explore(arena, Chemotaxis(), Toy(), views=VIEWS, out=out)
    walk_rng = np.random.default_rng(np.random.SeedSequence(0).spawn(2)[0])
    walk = Chemotaxis().walk(arena, Disc(), VIEWS, walk_rng)
    np.testing.assert_array_equal(rec.poses, walk.poses)
    assert rec.attributes["walk"] == walk.notes
    assert len(walk.notes["at_maximum"]) > 3
    assert go().attributes["walk"] == {}


def test_seed_varies_walk_and_noise() -> None:
    first, other = go(), go(seed=1)
    assert_equal(first, go())
    assert not np.array_equal(first.poses, other.poses)
    noise = [
        np.log(rec.odours / go(seed=seed, nose=Nose(noise=0.0)).odours)
        for seed, rec in enumerate((first, other))
    ]
    assert np.abs(np.mean(noise[0] * noise[1])) < 0.001
    np.testing.assert_allclose(np.std(noise, axis=(1, 2)), 0.1, atol=0.01)
    nose_rng = np.random.default_rng(np.random.SeedSequence(0).spawn(2)[1])
    clean = Arena.load("open_field").odours.concentration(first.poses[:, :2])
    np.testing.assert_array_equal(first.odours, Nose().smell(clean, first.times, nose_rng))


def test_nose_and_camera_leave_the_walk_alone() -> None:
    np.testing.assert_array_equal(go().poses, go(Toy(gain=3), nose=Nose(noise=0.5, fluctuation=0.3)).poses)


def test_on_disk_it_is_the_same(tmp_path: Path) -> None:
    camera = Toy()
    rec = go(camera, out=tmp_path / "deep" / "rec.zarr")
    assert camera.calls == [256, 256, 188]
    assert_equal(rec, go())
    assert_equal(Recording.open(tmp_path / "deep" / "rec.zarr"), go())


def test_whole_recording_is_only_opened(tmp_path: Path) -> None:
    go(out=tmp_path / "rec.zarr")
    before, camera = snapshot(tmp_path), Toy()
    assert_equal(go(camera, out=tmp_path / "rec.zarr"), go())
    assert camera.calls == []
    assert snapshot(tmp_path) == before


def started(work: str) -> subprocess.Popen[bytes]:
    script = f"""
        import importlib.util
        spec = importlib.util.spec_from_file_location("toys", {str(Path(__file__))!r})
        toys = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(toys)
        {work}
    """
    command = [sys.executable, "-c", textwrap.dedent(script)]
    return subprocess.Popen(command, cwd=Path(__file__).parents[2])


def killed_at(path: Path, call: int) -> int:
    with started(f"toys.go(toys.Toy(kill_at={call}), out={str(path)!r})") as process:
        process.wait(60)
    assert process.returncode == -signal.SIGKILL
    return process.pid


def test_killed_exploration_goes_on_and_ends_with_the_same_bits(tmp_path: Path) -> None:
    path, whole = tmp_path / "rec.zarr", tmp_path / "whole.zarr"
    go(out=whole)
    killed_at(path, 0)
    with pytest.raises(ArenaError, match="0 of its 700 views"):
        Recording.open(path)
    # Two shards are whole before the third is painted.
    dead = killed_at(path, 2)
    (path / "views" / "c" / "1" / "0" / "0" / "0").unlink()
    with pytest.raises(ArenaError, match="256 of its 700 views"):
        Recording.open(path)
    stray = path / "views" / "c" / "1" / "0" / "0" / f".0.{socket.gethostname()}-{dead}-0123abcd.partial"
    stray.write_bytes(b"cut short")
    camera = Toy()
    go(camera, out=path)
    assert camera.calls == [256, 188]
    relative = [
        {name.removeprefix(str(root)): data for name, data in snapshot(root).items()}
        for root in (path, whole)
    ]
    assert relative[0] == relative[1]


def test_killed_at_any_moment_nothing_whole_is_done_again(tmp_path: Path) -> None:
    views, rng = 20 * 256, np.random.default_rng()
    go(out=tmp_path / "whole.zarr", views=views)
    (tmp_path / "0").mkdir()
    paths = [tmp_path / name / "rec.zarr" for name in "012"]
    for path in paths:
        with started(f"toys.go(toys.Toy(pause=0.02), views={views}, out={str(path)!r})") as process:
            while not path.exists():
                assert process.poll() is None
                time.sleep(0.005)
            time.sleep(rng.uniform(0, 20 * 0.02))
            process.kill()
        shards = [slice(first, first + 256) for first in range(0, views, 256)]
        whole = [file(path / "views", rows) for rows in shards if is_complete(path / "views", rows)]
        before = [(shard.stat().st_ino, shard.stat().st_mtime_ns) for shard in whole]
        camera = Toy()
        go(camera, out=path, views=views)
        assert sum(camera.calls) == views - 256 * len(whole)
        assert [(shard.stat().st_ino, shard.stat().st_mtime_ns) for shard in whole] == before
        wanted = snapshot(tmp_path / "whole.zarr").values()
        assert list(snapshot(path).values()) == list(wanted)


def test_disk_that_fills_up_loses_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, real = tmp_path / "rec.zarr", sharding._write

    def full(file: Path, head: bytes, images: np.ndarray) -> None:
        if "1" in file.parts:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        real(file, head, images)

    monkeypatch.setattr(sharding, "_write", full)
    with pytest.raises(ArenaError, match="No space left on device; what is written is kept") as error:
        go(out=path)
    assert len(str(error.value).splitlines()) == 1
    monkeypatch.undo()
    camera = Toy()
    assert_equal(go(camera, out=path), go())
    assert camera.calls == [256, 188]


def test_disk_that_is_full_from_the_start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(zarr, "create_group", full)
    with pytest.raises(ArenaError, match=r"cannot write .*: No space left on device$"):
        go(out=tmp_path / "rec.zarr")
    assert list(tmp_path.iterdir()) == []


def test_shard_cut_short_is_rendered_again(tmp_path: Path) -> None:
    path = tmp_path / "rec.zarr"
    go(out=path)
    shard = path / "views" / "c" / "1" / "0" / "0" / "0"
    shard.write_bytes(shard.read_bytes()[:1000])
    camera = Toy()
    assert_equal(go(camera, out=path), go())
    assert camera.calls == [256]


@pytest.mark.parametrize("state", ["whole", "half"])
@pytest.mark.parametrize(
    ("fields", "what"),
    [
        ({"seed": 1}, "seed"),
        ({"views": 701}, "views"),
        ({"nose": Nose(noise=0.2)}, "nose"),
        ({"camera": Toy(gain=2)}, "camera"),
    ],
)
def test_another_recording_is_not_touched(
    tmp_path: Path, state: str, fields: dict[str, object], what: str
) -> None:
    path = tmp_path / "rec.zarr"
    go(out=path)
    if state == "half":
        (path / "views" / "c" / "2" / "0" / "0" / "0").unlink()
    before = snapshot(tmp_path)
    with pytest.raises(ArenaError, match=f"another recording, of a different {what};"):
        go(out=path, **fields)
    assert snapshot(tmp_path) == before


def test_half_written_by_a_program_that_walked_otherwise(tmp_path: Path) -> None:
    rec = go()
    for name, there, reason in [
        ("same", {}, "another version of this program"),
        ("older", {"pymunk": "6.0"}, f"pymunk 6.0 .here {version('pymunk')}.;"),
    ]:
        path = tmp_path / f"{name}.zarr"
        attributes = {**rec.attributes, "origin": {**rec.attributes["origin"], **there}}
        Recording(
            views=rec.views, odours=rec.odours, times=rec.times + 1, poses=rec.poses, attributes=attributes
        ).save(path)
        (path / "views" / "c" / "2" / "0" / "0" / "0").unlink()
        before = snapshot(tmp_path)
        with pytest.raises(ArenaError, match=f"walks or smells otherwise: {reason}"):
            go(out=path)
        assert snapshot(tmp_path) == before


def test_junk_in_the_way_is_not_touched(tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("all of it")
    for path in (tmp_path, tmp_path / "thesis.txt"):
        with pytest.raises(ArenaError, match="not a recording"):
            go(out=path)
    assert snapshot(tmp_path) == {str(tmp_path / "thesis.txt"): b"all of it"}


@pytest.mark.parametrize("fields", [{"views": 0}, {"views": -5}, {"seed": -1}])
def test_counts_out_of_range_touch_nothing(tmp_path: Path, fields: dict[str, int]) -> None:
    with pytest.raises(ArenaError, match="give a whole number of at least"):
        go(out=tmp_path / "rec.zarr", **fields)
    assert list(tmp_path.iterdir()) == []


def test_start_inside_a_pillar_touches_nothing(tmp_path: Path) -> None:
    with pytest.raises(ArenaError, match="start"):
        explore(
            Arena.load("pillar"), Brownian(start=(0.0, 0.0, 0.0)), Toy(), views=9, out=tmp_path / "rec.zarr"
        )
    assert list(tmp_path.iterdir()) == []


def test_in_memory_the_images_are_held_once() -> None:
    class Large(Toy):
        height, width = 100, 100

        def render(self, arena: Arena, poses: np.ndarray, *, rng: np.random.Generator) -> np.ndarray:
            assert isinstance(arena, Arena)
            assert isinstance(rng, np.random.Generator)
            return np.ones((len(poses), 100, 100, 3), np.uint8)

    go(views=10)
    tracemalloc.start()
    rec = go(Large(), views=2000)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < rec.views.nbytes + 2.5 * 256 * 30_000


def test_on_disk_no_more_than_a_shard_is_held(tmp_path: Path) -> None:
    class Large(Toy):
        height, width = 100, 100

        def render(self, arena: Arena, poses: np.ndarray, *, rng: np.random.Generator) -> np.ndarray:
            assert isinstance(arena, Arena)
            return rng.integers(0, 256, (len(poses), 100, 100, 3), np.uint8)

    go(views=10, out=tmp_path / "small.zarr")
    tracemalloc.start()
    go(Large(), views=2000, out=tmp_path / "rec.zarr")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 2.5 * 256 * 30_000


@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_threads_change_nothing(tmp_path: Path, noise: float) -> None:
    camera, before = Camera.panoramic(16, 4, noise=noise), numba.get_num_threads()
    try:
        for threads in (1, min(2, before)):
            numba.set_num_threads(threads)
            go(camera, out=tmp_path / f"{threads}.zarr")
            assert_equal(go(camera), Recording.open(tmp_path / f"{threads}.zarr"))
    finally:
        numba.set_num_threads(before)
    one, *other = (list(snapshot(folder).values()) for folder in sorted(tmp_path.iterdir()))
    assert other in ([], [one])
    rec = go(camera)
    rng = np.random.default_rng(np.random.SeedSequence(0, spawn_key=(2, 256)))
    alone = camera.render(Arena.load("open_field"), rec.poses[256:512], rng=rng)
    np.testing.assert_array_equal(rec.views[256:512], alone)


def test_views_are_painted_while_the_body_walks_on() -> None:
    painted = threading.Event()

    class Watched(Toy):
        def render(self, arena: Arena, poses: np.ndarray, *, rng: np.random.Generator) -> np.ndarray:
            painted.set()
            return super().render(arena, poses, rng=rng)

    class Patient(Brownian):
        def strides(self, *told: Any) -> Iterator[Walk]:
            for stride in super().strides(*told):
                yield stride
                assert painted.wait(60)

    np.testing.assert_array_equal(
        explore(Arena.load("open_field"), Patient(), Watched(), views=VIEWS).views, go().views
    )


def test_after_a_failure_nothing_more_is_painted(tmp_path: Path) -> None:
    class Failing(Toy):
        def render(self, arena: Arena, poses: np.ndarray, *, rng: np.random.Generator) -> np.ndarray:
            if len(self.calls) == 1:
                self.calls.append(0)
                raise ArenaError("blind")
            return super().render(arena, poses, rng=rng)

    for out in (None, tmp_path / "rec.zarr"):
        camera = Failing()
        with pytest.raises(ArenaError, match="blind"):
            go(camera, out=out)
        assert camera.calls == [256, 0]


def test_progress_is_shown_on_stderr_only(capsys: pytest.CaptureFixture[str]) -> None:
    go(progress=True)
    shown = capsys.readouterr()
    assert shown.out == ""
    assert f"{VIEWS}/{VIEWS}" in shown.err
    go()
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("eye", [Camera.panoramic(24, 8, noise=0.02), Overhead(16, 12, noise=0.02)])
def test_joints_are_recorded_in_memory_as_on_disk(tmp_path: Path, eye: AnyEye) -> None:
    arm, room, nose = Arm(slip=0.05), Arena.load("furnished"), Nose(noise=0.0)
    rec = explore(room, Babble(), eye, nose=nose, body=arm, views=300, seed=4)
    np.testing.assert_array_equal(rec.poses, arm.camera_poses(rec.joints))
    np.testing.assert_array_equal(rec.odours, room.odours.concentration(rec.poses[:, :2]).astype("f4"))
    assert rec.without_truth().joints is None
    stored = explore(room, Babble(), eye, nose=nose, body=arm, views=300, seed=4, out=tmp_path / "rec.zarr")
    for name in ("views", "poses", "joints", "commands", "times"):
        np.testing.assert_array_equal(getattr(stored, name)[:], getattr(rec, name))
    kept = {"kind": "Arm", **arm.model_dump(mode="json")}
    assert stored.attributes["body"] == kept


def test_what_steers_a_disc_alone_says_so() -> None:
    with pytest.raises(ArenaError, match="Brownian steers a disc, and this body is of kind Arm"):
        explore(Arena.load("furnished"), Brownian(), Camera.panoramic(8, 2), body=Arm(), views=3)


def test_a_policy_moves_joints_and_stops() -> None:
    def policy(sensed: Sensed) -> np.ndarray | None:
        return None if sensed["view"][0, 0, 0] == 255 else np.array([0.5, -0.5])

    arm = Arm()
    rec = explore(
        Arena.load("furnished"), policy, Overhead(16, 16), body=arm, views=5, start=(0.0, 1.0), dt=0.1
    )
    wanted = [0.0, 1.0] + 0.1 * 0.5 * arm.max_turn * np.arange(5)[:, None] * [1, -1]
    np.testing.assert_allclose(rec.joints, wanted, atol=1e-12)
