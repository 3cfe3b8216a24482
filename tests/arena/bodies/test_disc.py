import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import arena
from arena.bodies.disc import Disc, Drive
from arena.errors import ArenaError
from arena.rooms.arena import Arena

ELBOW = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]]


def room(platform: list[list[float]], **parts: object) -> Arena:
    far = [{"start": (-9.0, -9.0), "end": (9.0, -9.0), "material": "brick"}]
    return Arena.create(name="room", platform=[platform], **{"walls": far, **parts})


def square(half: float) -> list[list[float]]:
    return [[-half, -half], [half, -half], [half, half], [-half, half]]


def outside(arena: Arena, drive: Drive, radius: float) -> float:
    """How far the body is beyond its free space, m."""
    return float(shapely.distance(arena.free_space(radius), shapely.Point(drive.pose[:2])))


def test_straight_ahead() -> None:
    drive = Disc().place(room(square(5)), (0.0, 0.0, np.pi / 6))
    assert not any(drive.step(0.4, 0.0, 0.05) for _ in range(100))
    assert drive.pose == pytest.approx((2 * np.cos(np.pi / 6), 2 * np.sin(np.pi / 6), np.pi / 6))


def test_arc_is_a_circle_of_radius_speed_over_turn() -> None:
    drive = Disc().place(room(square(5)), (0.0, 0.0, 0.0))
    for _ in range(100):
        drive.step(0.5, 0.8, 0.05)
    angle = 0.8 * 5.0
    wanted = 0.5 / 0.8 * np.sin(angle), 0.5 / 0.8 * (1 - np.cos(angle))
    assert drive.pose[:2] == pytest.approx(wanted, abs=1e-3)
    assert drive.pose[2] == pytest.approx(angle - 2 * np.pi)


def test_spin_leaves_the_place_and_wraps_the_heading() -> None:
    drive = Disc().place(room(square(5)), (1.0, 2.0, 3.0))
    drive.step(0.0, 2.0, 0.5)
    assert drive.pose == pytest.approx((1.0, 2.0, 4.0 - 2 * np.pi))
    for heading in (np.pi, -np.pi, 7 * np.pi):
        assert Disc().place(room(square(5)), (0.0, 0.0, heading)).pose[2] == pytest.approx(np.pi)


def test_commands_are_cut_to_what_the_body_can_do() -> None:
    drive = Disc(max_speed=0.5, max_turn=1.0).place(room(square(5)), (0.0, 0.0, 0.0))
    drive.step(99.0, 0.0, 0.1)
    drive.step(0.0, -99.0, 0.1)
    assert drive.pose == pytest.approx((0.05, 0.0, -0.1))
    drive.step(-99.0, 0.0, 0.1)
    assert drive.pose[0] == pytest.approx(0.05 - 0.05 * np.cos(0.1))


def test_wall_stops_what_comes_straight_and_lets_the_rest_slide() -> None:
    arena = room(square(2))
    drive = Disc().place(arena, (0.0, 0.0, 0.0))
    touched = [drive.step(0.65, 0.0, 0.05) for _ in range(100)]
    # 1.82 m at 0.65 m/s take 56 steps exactly.
    assert touched == [False] * 56 + [True] * 44
    assert drive.pose == pytest.approx((1.82, 0.0, 0.0), abs=1e-5)
    assert drive.contact == pytest.approx(np.pi)
    drive.step(0.0, np.pi, 1 / 4)
    for _ in range(20):
        assert drive.step(0.5, 0.0, 0.05)
    assert drive.pose == pytest.approx((1.82, 0.5 * np.sin(np.pi / 4), np.pi / 4), abs=1e-5)
    drive.step(0.0, np.pi, 0.5)
    assert not drive.step(0.5, 0.0, 0.05)
    assert drive.contact is None


def test_hard_knock_does_not_throw_the_body_back() -> None:
    drive = Disc(radius=0.5, max_speed=10.0).place(room(square(2)), (1.4, 0.0, 0.0))
    assert drive.step(10.0, 0.0, 0.0249)
    for _ in range(5):
        drive.step(0.0, 0.0, 0.05)
        assert drive.pose == pytest.approx((1.5, 0.0, 0.0), abs=1e-6)


def test_no_wall_is_thin_enough_to_pass() -> None:
    wall = {"start": (0.5, -4.0), "end": (0.5, 4.0), "material": "brick"}
    drive = Disc(max_speed=50.0).place(room(square(4), walls=[wall]), (0.0, 0.0, 0.1))
    assert drive.step(50.0, 0.0, 2.0)
    assert drive.pose[0] == pytest.approx(0.32, abs=1e-5)


def test_looking_ahead_finds_what_is_straight_before_the_centre() -> None:
    arena = room(square(2), pillars=[{"center": (0.0, 1.0), "radius": 0.2, "material": "brick"}])
    drive = Disc().place(arena, (0.0, 0.0, 0.0))
    assert drive.ahead(1.99) is None
    assert abs(drive.ahead(2.01)) == pytest.approx(np.pi)
    drive.step(0.0, np.pi, 0.5)
    assert drive.ahead(0.79) is None
    assert drive.ahead(0.81) == pytest.approx(-np.pi / 2, abs=0.1)


def test_round_a_corner_of_the_platform() -> None:
    arena = room(ELBOW)
    drive = Disc(radius=0.2).place(arena, (0.8, 2.5, -np.pi / 2))
    reached = []
    for _ in range(2000):
        drive.step(0.6, 1.5 * np.sin(np.arctan2(-1, 1) - drive.pose[2]), 0.02)
        reached.append(np.hypot(*np.subtract(drive.pose[:2], 1.0)))
        assert outside(arena, drive, 0.2) < 1e-3
    assert min(reached) == pytest.approx(0.2, abs=1e-5)
    assert drive.pose[:2] == pytest.approx((2.8, 0.2), abs=1e-3)


def test_wedge_holds_the_body() -> None:
    arena = room([[0.0, 0.0], [4.0, -0.3], [4.0, 0.3]])
    drive = Disc(radius=0.1).place(arena, (3.0, 0.0, np.pi))
    for _ in range(400):
        drive.step(0.65, 0.0, 0.05)
        assert outside(arena, drive, 0.1) < 1e-5
    assert drive.pose[0] == pytest.approx(0.1 / np.sin(np.arctan2(0.3, 4)), abs=0.05)


@pytest.mark.parametrize("share", [0.95, 0.99, 1.01])
def test_a_gap_lets_through_what_fits(share: float) -> None:
    half = 0.18 * share
    arena = room(
        square(3),
        walls=[
            {"start": (0.0, sign * half), "end": (0.0, sign * 3.0), "material": "brick"} for sign in (-1, 1)
        ],
    )
    rng = np.random.default_rng(0)
    for top in 10 ** rng.uniform(-0.3, 1.3, 15):
        drive = Disc(max_speed=top).place(arena, (-rng.uniform(0.2, 0.5), 0.0, 0.0))
        for _ in range(100):
            drive.step(top * rng.random(), np.clip(-20 * drive.pose[2] - 40 * drive.pose[1], -3, 3), 0.05)
        assert (drive.pose[0] > 0) == (share > 1)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32), radius=st.floats(0.05, 0.3), top=st.floats(0.1, 100))
def test_no_speed_tunnels_through_walls_or_wedges(seed: int, radius: float, top: float) -> None:
    rng = np.random.default_rng(seed)
    ends = rng.uniform(-2, 2, (8, 2, 2)).round(3).tolist()
    walls = [{"start": tuple(a), "end": tuple(b), "material": "brick"} for a, b in ends]
    arena = room(square(2), walls=walls)
    assume(arena.free_space(radius).area > 1e-3)
    region = shapely.get_parts(arena.free_space(0.99 * radius))
    x, y = arena.sample_free(1, radius, rng)[0].tolist()
    mine = region[shapely.contains_xy(region, x, y)][0]
    drive = Disc(radius=radius, max_speed=top, max_turn=20.0).place(arena, (x, y, 0.0))
    places = []
    for dt in 10 ** rng.uniform(-3, -0.5, 60):
        drive.step(rng.uniform(-top, top), rng.normal(0, 5), dt)
        places.append(drive.pose[:2])
    assert shapely.distance(mine, shapely.points(places)).max() < 1e-4


@settings(max_examples=20, deadline=None)
@given(
    name=st.sampled_from(["pillar", "elbow"]),
    seed=st.integers(0, 2**32),
    turning=st.floats(0, 5),
    radius=st.floats(0.03, 0.3),
)
def test_never_leaves_free_space(name: str, seed: int, turning: float, radius: float) -> None:
    arena = room(ELBOW, pillars=[{"center": (0.5, 2.2), "radius": 0.1, "material": "brick"}])
    arena = Arena.load("pillar") if name == "pillar" else arena
    rng = np.random.default_rng(seed)
    x, y = arena.sample_free(1, radius, rng)[0].tolist()
    drive = Disc(radius=radius, max_speed=2.0, max_turn=10.0).place(arena, (x, y, 0.0))
    places = []
    for speed, turn in zip(rng.uniform(-0.5, 2, 400), turning * rng.standard_normal(400), strict=True):
        drive.step(speed, turn, 0.05)
        places.append(drive.pose[:2])
    free = arena.free_space(radius)
    assert shapely.distance(free, shapely.points(places)).max() < 1e-3


def test_speeds_up_and_brakes_within_its_accelerations() -> None:
    body = Disc(max_acceleration=0.5, max_turn_acceleration=2.0)
    drive = body.place(room(square(5)), (0.0, 0.0, 0.0))
    for _ in range(10):
        drive.step(0.4, 0.0, 0.1)
    # 0.8 s at 0.5 m/s² take it to 0.4 m/s.
    assert (drive.speed, drive.pose[0]) == pytest.approx((0.4, 0.4**2 / (2 * 0.5) + 0.2 * 0.4))
    start = drive.pose[0]
    for _ in range(40):
        drive.step(0.0, 0.0, 0.03)
    assert (drive.speed, drive.pose[0] - start) == pytest.approx((0.0, 0.4**2 / (2 * 0.5)))
    for _ in range(7):
        drive.step(0.0, -1.0, 0.1)
    assert (drive.turn, drive.pose[2]) == pytest.approx((-1.0, -(1.0**2 / (2 * 2.0) + 0.2 * 1.0)))
    drive.step(0.0, 1.0, 0.25)
    assert drive.turn == pytest.approx(-0.5)


@given(steps=st.lists(st.floats(0.001, 0.2), min_size=1, max_size=40), command=st.floats(-2, 2))
@settings(max_examples=30, deadline=None)
def test_how_time_is_divided_does_not_matter(steps: list[float], command: float) -> None:
    body = Disc(max_speed=1.0, max_acceleration=0.7)
    drives = [body.place(room(square(20)), (0.0, 0.0, 0.0)) for _ in range(2)]
    for dt in steps:
        drives[0].step(command, 0.0, dt)
    drives[1].step(command, 0.0, sum(steps))
    assert drives[0].pose == pytest.approx(drives[1].pose)
    assert drives[0].speed == pytest.approx(drives[1].speed)


def test_without_limits_it_obeys_at_once() -> None:
    at_once, soon = (
        Disc(max_acceleration=limit, max_turn_acceleration=limit).place(room(square(5)), (0.0, 0.0, 0.0))
        for limit in (None, 1e6)
    )
    rng = np.random.default_rng(0)
    for speed, turn in rng.uniform(-1, 1, (50, 2)).tolist():
        at_once.step(speed, turn, 0.05)
        soon.step(speed, turn, 0.05)
        assert (at_once.speed, at_once.turn) == (max(-0.65, min(0.65, speed)), turn)
    assert soon.pose == pytest.approx(at_once.pose, abs=1e-4)


def test_wheels_drive_round_a_circle() -> None:
    body = Disc(wheel_base=0.3)
    assert body.from_wheels(0.2, 0.2) == (0.2, 0.0)
    assert body.from_wheels(-0.15, 0.15) == pytest.approx((0.0, 1.0))
    drive = body.place(room(square(5)), (0.0, 0.0, 0.0))
    left, right = 0.3, 0.5
    places = []
    for _ in range(400):
        drive.step(*body.from_wheels(left, right), 0.05)
        places.append(drive.pose[:2])
    radius = 0.5 * 0.3 * (right + left) / (right - left)
    np.testing.assert_allclose(np.hypot(*(np.array(places) - [0, radius]).T), radius, rtol=1e-3)


def test_wheels_slip_at_a_wall() -> None:
    drive = Disc(max_acceleration=1.0).place(room(square(2)), (1.7, 0.0, 0.0))
    for _ in range(20):
        drive.step(0.5, 0.0, 0.05)
    assert drive.pose[0] == pytest.approx(1.82, abs=1e-5)
    assert drive.speed == 0.5


@pytest.mark.parametrize(
    "pose", [(0.1, 0.0, 0.0), (1.9, 0.0, 0.0), (9.0, 0.0, 0.0), (1.0, np.nan, 0.0), (1.0, 1.0, np.inf)]
)
def test_start_must_be_free(pose: tuple[float, float, float]) -> None:
    with pytest.raises(ArenaError, match="start"):
        Disc().place(Arena.load("pillar"), pose)


def test_where_a_body_came_to_a_body_can_start() -> None:
    arena = room(square(2))
    drive = Disc().place(arena, (0.0, 0.0, 0.3))
    while not drive.step(0.65, 0.0, 0.05):
        pass
    assert Disc().place(arena, drive.pose).pose == drive.pose


@pytest.mark.parametrize(
    "command", [(np.nan, 0.0, 0.1), (0.1, np.inf, 0.1), (0.1, 0.0, 0.0), (0.1, 0.0, -1.0)]
)
def test_bad_commands_are_refused(command: tuple[float, float, float]) -> None:
    drive = Disc().place(room(square(2)), (0.0, 0.0, 0.0))
    with pytest.raises(ArenaError, match="step"):
        drive.step(*command)


@pytest.mark.parametrize(
    "name", ["radius", "max_speed", "max_turn", "max_acceleration", "max_turn_acceleration", "wheel_base"]
)
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_bad_parameters_are_refused(name: str, value: float) -> None:
    with pytest.raises(ArenaError, match=name):
        Disc(**{name: value})


def test_it_is_a_body() -> None:
    assert isinstance(Disc(), arena.Body)
