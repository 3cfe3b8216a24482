from pathlib import Path

import numpy as np
import pytest

from arena.bodies.arm import Arm
from arena.bodies.disc import Disc
from arena.errors import ArenaError, TrackWarning
from arena.motions.base import Walk
from arena.motions.replay import Replay
from arena.rooms.arena import Arena

SMALL = Disc(radius=0.01)


def replay(motion: Replay, views: int | None = None, arena: str = "open_field", body: Disc = SMALL) -> Walk:
    return motion.walk(Arena.load(arena), body, views, np.random.default_rng(0))


def circle(count: int = 500, radius: float = 1.0, rate: float = 50.0) -> dict[str, np.ndarray]:
    """Once round, counter-clockwise, at a steady speed."""
    angle = np.linspace(0, 2 * np.pi, count)
    return {
        "t": 7 + np.arange(count) / rate,
        "pos": radius * np.stack([np.cos(angle), np.sin(angle)], axis=1),
    }


def zigzag(count: int = 401) -> dict[str, np.ndarray]:
    """Straight pieces of 40 samples each."""
    t = 0.1 * np.arange(count)
    pos = np.stack([np.linspace(-1.5, 1.5, count), 0.3 * np.abs((t / 4 + 1) % 2 - 1)], axis=1)
    return {"t": t, "pos": pos}


@pytest.fixture
def save(tmp_path: Path):
    def to_file(**arrays: np.ndarray) -> Path:
        np.savez(tmp_path / "path.npz", **arrays)
        return tmp_path / "path.npz"

    return to_file


def test_every_sample_is_a_view(save) -> None:
    path, heading = circle(), np.linspace(-3, 9, 500)
    times, poses, notes, _ = replay(Replay(path=save(**path, heading=heading)))
    np.testing.assert_allclose(times, path["t"] - 7)
    np.testing.assert_array_equal(poses[:, :2], path["pos"])
    np.testing.assert_allclose(np.exp(1j * poses[:, 2]), np.exp(1j * heading))
    assert (np.abs(poses[:, 2]) <= np.pi).all()
    told = {"samples": 500, "trimmed": 0, "gaps": 0, "longest_gap_s": 0.0, "interpolated": 0, "clipped": 0}
    assert notes == told


@pytest.mark.parametrize("how", ["nan", "missing"])
def test_gaps_are_interpolated_exactly_and_told(save, how: str) -> None:
    path = zigzag()
    full = replay(Replay(path=save(**path, heading=path["t"])))
    lost = np.zeros(401, dtype=bool)
    lost[[5, 100, 101, 102, *range(201, 231), 0, 399, 400]] = True
    heading = np.where(lost, np.nan, path["t"])
    if how == "nan":
        pos = path["pos"].copy()
        pos[lost, np.arange(lost.sum()) % 2] = np.nan
        walk = replay(Replay(path=save(t=path["t"], pos=pos, heading=heading)))
    else:
        kept = {name: values[~lost] for name, values in path.items()}
        walk = replay(Replay(path=save(**kept, heading=heading[~lost])))
    np.testing.assert_allclose(walk.times, full.times[1:399] - 0.1, atol=1e-9)
    np.testing.assert_allclose(walk.poses, full.poses[1:399], atol=1e-9)
    assert walk.notes["gaps"] == 3
    assert walk.notes["longest_gap_s"] == pytest.approx(3.1)
    assert walk.notes["interpolated"] == 34
    assert walk.notes["trimmed"] == (3 if how == "nan" else 0)
    assert walk.notes["samples"] == (401 if how == "nan" else 364)


def test_without_headings_it_looks_where_it_goes(save) -> None:
    path = circle(2000)
    poses = replay(Replay(path=save(**path))).poses
    tangent = 1j * (path["pos"] @ [1, 1j])
    off = np.angle(np.exp(1j * poses[:, 2]) / tangent)
    np.testing.assert_allclose(off[10:-10], 0, atol=1e-6)
    assert np.abs(off).max() < 0.05


@pytest.mark.parametrize(("first", "then"), [(0.0, 1.5), (1.0, -1.0), (2.5, -2.5)])
def test_standing_still_it_turns_the_short_way_from_one_move_to_the_next(
    save, first: float, then: float
) -> None:
    t = np.arange(0, 12, 0.02)
    way = np.clip(t, 0, 4) / 4 * np.exp(1j * first) + np.clip(t - 8, 0, 4) / 4 * np.exp(1j * then)
    heading = replay(Replay(path=save(t=t, x=way.real, y=way.imag), fit=True)).poses[:, 2]
    np.testing.assert_allclose(heading[t < 3.8], first, atol=1e-9)
    np.testing.assert_allclose(heading[t > 8.2], then, atol=1e-9)
    still = np.unwrap(heading[(t > 3.8) & (t < 8.2)])
    assert np.ptp(still) == pytest.approx(abs(np.angle(np.exp(1j * (then - first)))))
    step = np.diff(still)[25:-25]
    np.testing.assert_allclose(step, step.mean(), atol=1e-9)


def test_headings_turn_the_short_way_over_a_gap(save) -> None:
    heading = np.array([3.0, np.nan, np.nan, -3.0, -2.9])
    poses = replay(Replay(path=save(t=np.arange(5), x=np.zeros(5), y=np.zeros(5), heading=heading))).poses
    step = (2 * np.pi - 6) / 3
    np.testing.assert_allclose(poses[:, 2], [3.0, 3.0 + step, -3.0 - step, -3.0, -2.9])


def test_views_by_time(save) -> None:
    path = circle(500)
    times, poses, *_ = replay(Replay(path=save(**path), interval=0.1))
    np.testing.assert_allclose(times, 0.1 * np.arange(100), atol=1e-9)
    np.testing.assert_array_equal(poses[:, :2], path["pos"][::5])


def test_views_by_distance(save) -> None:
    # It stops for five seconds halfway.
    x = np.concatenate([np.linspace(-1, 0, 201), np.zeros(250), np.linspace(0, 1, 101)])
    path = {"t": 0.02 * np.arange(len(x)), "x": x, "y": 0.1 * np.ones(len(x))}
    poses = replay(Replay(path=save(**path), view_every_m=0.05)).poses
    np.testing.assert_allclose(poses[:, 0], np.linspace(-1, 1, 41), atol=1e-9)


def test_fewer_views_are_the_first(save) -> None:
    motion = Replay(path=save(**circle()))
    np.testing.assert_array_equal(replay(motion, 30).poses, replay(motion).poses[:30])
    with pytest.raises(ArenaError, match="gives 500 views, not 501"):
        replay(motion, 501)


def test_scaled_and_moved(save) -> None:
    path = circle()
    centimetres = save(t=path["t"], pos=100 * path["pos"])
    poses = replay(Replay(path=centimetres, scale=0.01, offset=(0.5, -0.25))).poses
    np.testing.assert_allclose(poses[:, :2], path["pos"] + [0.5, -0.25])


@pytest.mark.parametrize("stretch", [(3.0, 1.0), (0.1, 7.0), (2.0, 0.0), (0.0, 0.0)])
def test_fitted_into_the_room(save, stretch: tuple[float, float]) -> None:
    path = circle(2000)
    pos = path["pos"] * stretch + [40.0, -9.0]
    poses = replay(Replay(path=save(t=path["t"], pos=pos, heading=path["t"]), fit=True), body=Disc()).poses
    # The body's centre has 3.64 by 2.64 m.
    scale = min((side / (2 * s) for side, s in zip((3.64, 2.64), stretch, strict=True) if s), default=1)
    np.testing.assert_allclose(poses[:, :2], scale * (path["pos"] * stretch), atol=1e-4)


def test_leaving_the_room_is_told_where(save) -> None:
    path = save(**circle(radius=1.6))
    with pytest.raises(ArenaError, match=r"first at \(0\.\d+, 1\.49\d\) m and 8\.\d+ s, in \d+ of 500"):
        replay(Replay(path=path))
    assert replay(Replay(path=path, offset=(-0.3, 0.0), scale=0.5)).notes["clipped"] == 0


def test_clipped_to_the_nearest_free_place(save) -> None:
    path = circle(radius=1.6)
    _, poses, notes, _ = replay(Replay(path=save(**path), clip=True))
    np.testing.assert_allclose(poses[:, :2], np.clip(path["pos"], [-1.99, -1.49], [1.99, 1.49]), atol=2e-3)
    assert notes["clipped"] == (np.abs(path["pos"][:, 1]) > 1.491).sum()
    assert Arena.load("open_field").is_free(poses[:, :2], 0.009).all()
    around = replay(Replay(path=save(**circle(radius=0.3)), clip=True), arena="pillar").poses
    np.testing.assert_allclose(np.hypot(*around[:, :2].T), 0.51, atol=0.003)


def pixels(lost: dict[int, tuple[float, float]], count: int = 1500) -> dict[str, np.ndarray]:
    t = np.arange(count) / 25
    pos = np.stack([250 + 150 * np.sin(t), 220 + 150 * np.sin(1.37 * t)], axis=1)
    for at, place in lost.items():
        pos[at] = place
    return {"t": t, "pos": pos}


@pytest.mark.parametrize("told", [False, True])
def test_what_a_tracker_writes_where_it_lost_the_animal_does_not_decide_the_fit(save, told: bool) -> None:  # noqa: FBT001
    true = replay(Replay(path=save(**pixels({})), fit=True))
    heading = np.arange(1500) / 125
    heading[7::100] += 1.5
    path = save(**pixels(dict.fromkeys(range(7, 1500, 100), (1023, 1023))), heading=heading)
    if told:
        walk = replay(Replay(path=path, fit=True, missing=1023))
        assert walk.notes["missing"] == 15
    else:
        with pytest.warns(TrackWarning) as said:
            walk = replay(Replay(path=path, fit=True))
        assert "15 of 1500 samples are exactly (1023, 1023)" in str(said[0].message)
        assert "fit leaves 15 of 1500 samples out" in str(said[1].message)
        assert (walk.notes["doubtful"], walk.notes["left_out"]) == (15, 15)
    assert walk.notes["fitted_scale"] == pytest.approx(true.notes["fitted_scale"])
    assert (walk.notes["gaps"], walk.notes["interpolated"], walk.notes["clipped"]) == (15, 15, 0)
    # A chord of two samples, in a curve.
    bend = np.hypot(150, 150 * 1.37**2) * true.notes["fitted_scale"] * 0.04**2 / 2
    assert np.hypot(*(walk.poses - true.poses).T[:2]).max() < bend
    np.testing.assert_allclose(np.exp(1j * walk.poses[:, 2]), np.exp(1j * walk.times / 5), atol=1e-9)


def test_without_fit_doubtful_samples_are_kept_and_told(save) -> None:
    path = save(**pixels({70: (1023, 1023), 900: (1023, 1023)}))
    room = {"scale": (0.005, 0.004), "offset": (-1.25, -0.9)}
    with (
        pytest.warns(TrackWarning, match=r"pass missing=1023 if so"),
        pytest.raises(ArenaError, match=r"in 2 of 1500 samples, and covers .* give scale or calibration"),
    ):
        replay(Replay(path=path, **room))
    walk = replay(Replay(path=path, missing=[0, 1023], fastest=5, **room))
    wanted = np.delete(pixels({})["pos"], [70, 900], axis=0) * (0.005, 0.004) + (-1.25, -0.9)
    np.testing.assert_allclose(np.delete(walk.poses[:, :2], [70, 900], axis=0), wanted)
    told = {"missing": 2, "too_fast": 0, "metres_per_unit": [0.005, 0.004], "gaps": 2, "interpolated": 2}
    assert walk.notes.items() >= told.items()


def test_with_fit_the_speed_is_of_the_room(save) -> None:
    wild = {at: (250 + 220 * np.cos(at), 220 + 220 * np.sin(at)) for at in range(7, 1500, 90)}
    path = save(**pixels(wild), heading=np.arange(1500) / 25)
    walk = replay(Replay(path=path, fit=True, fastest=3))
    assert (walk.notes["too_fast"], walk.notes["gaps"], walk.notes["doubtful"]) == (17, 17, 0)
    assert "left_out" not in walk.notes
    assert (np.hypot(*np.diff(walk.poses[:, :2], axis=0).T) <= 3 * np.diff(walk.times) + 1e-9).all()
    np.testing.assert_allclose(np.ptp(walk.poses[:, 1]), 2.98, atol=1e-6)
    np.testing.assert_allclose(np.exp(1j * walk.poses[:, 2]), np.exp(1j * walk.times), atol=1e-9)


def test_the_random_numbers_do_not_matter(save) -> None:
    motion, arena = Replay(path=save(**circle())), Arena.load("open_field")
    first, other = (motion.walk(arena, SMALL, None, np.random.default_rng(seed)) for seed in (0, 1))
    np.testing.assert_array_equal(first.poses, other.poses)


def test_a_path_without_direction_is_refused(save) -> None:
    with pytest.raises(ArenaError, match="no direction"):
        replay(Replay(path=save(t=np.arange(9), x=np.zeros(9), y=np.ones(9))))


def test_an_endless_gap_is_refused(save) -> None:
    with pytest.raises(ArenaError, match=r"a gap of 1e\+09 s after 1 s"):
        replay(Replay(path=save(t=[0, 0.1, 0.2, 1, 1e9], x=np.zeros(5), y=np.arange(5))))


def test_body_that_fits_nowhere_is_refused(save) -> None:
    with pytest.raises(ArenaError, match="no free space"):
        replay(Replay(path=save(**circle())), body=Disc(radius=1.6))


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"interval": 0.1, "view_every_m": 0.1}, "choose one"),
        ({"fit": True, "scale": 2.0}, "leave them out"),
        ({"fit": True, "offset": (1.0, 0.0)}, "leave them out"),
        ({"fit": True, "calibration": ((0, 0), (1, 0), 2.0)}, "leave them out"),
        ({"missing": "lost"}, "missing"),
        ({"scale": 0.0}, "scale"),
        ({"interval": np.nan}, "interval"),
        ({"offset": (np.inf, 0.0)}, "offset"),
        ({"path": None}, "path"),
    ],
)
def test_bad_parameters_are_refused(wrong: dict[str, object], said: str) -> None:
    with pytest.raises(ArenaError, match=said):
        Replay(**{"path": "path.csv", **wrong})


def test_joints_go_through_their_recorded_configurations(tmp_path: Path) -> None:
    path, room, arm = tmp_path / "arm.csv", Arena.load("furnished"), Arm(limits="one")
    path.write_text("t,joint_1,joint_2\n" + "".join(f"{k / 10},{k},{-k / 5}\n" for k in range(9)), "utf-8")
    walk = Replay(path=path, interval=0.2).walk(room, arm, None, np.random.default_rng(0))
    np.testing.assert_allclose(walk.times, [0, 0.2, 0.4, 0.6, 0.8])
    wanted = np.angle(np.exp(1j * np.arange(0, 9, 2)))
    np.testing.assert_allclose(walk.poses, np.column_stack([wanted, -np.arange(0, 9, 2) / 5]), atol=1e-12)
    for fields, body, message in (
        ({}, Arm(links=(0.5, 0.5, 0.5)), "no column joint_3"),
        ({"clip": True}, arm, "are of a disc's path"),
        ({"rate": 30, "scale": 2}, arm, "rate, scale, offset, fit and clip are of a disc's path"),
        ({}, Arm(limits=(None, (-1.0, 1.0))), "cannot start"),
    ):
        with pytest.raises(ArenaError, match=message):
            Replay(path=path, **fields).walk(room, body, None, np.random.default_rng(0))
