import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from arena.arena import Arena
from arena.body import Body, Drive
from arena.errors import ArenaError

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
    drive = Body().place(room(square(5)), (0.0, 0.0, np.pi / 6))
    assert not any(drive.step(0.4, 0.0, 0.05) for _ in range(100))
    assert drive.pose == pytest.approx((2 * np.cos(np.pi / 6), 2 * np.sin(np.pi / 6), np.pi / 6))


def test_arc_is_a_circle_of_radius_speed_over_turn() -> None:
    drive = Body().place(room(square(5)), (0.0, 0.0, 0.0))
    for _ in range(100):
        drive.step(0.5, 0.8, 0.05)
    angle = 0.8 * 5.0
    wanted = 0.5 / 0.8 * np.sin(angle), 0.5 / 0.8 * (1 - np.cos(angle))
    assert drive.pose[:2] == pytest.approx(wanted, abs=1e-3)
    assert drive.pose[2] == pytest.approx(angle - 2 * np.pi)


def test_spin_leaves_the_place_and_wraps_the_heading() -> None:
    drive = Body().place(room(square(5)), (1.0, 2.0, 3.0))
    drive.step(0.0, 2.0, 0.5)
    assert drive.pose == pytest.approx((1.0, 2.0, 4.0 - 2 * np.pi))
    for heading in (np.pi, -np.pi, 7 * np.pi):
        assert Body().place(room(square(5)), (0.0, 0.0, heading)).pose[2] == pytest.approx(np.pi)


def test_commands_are_cut_to_what_the_body_can_do() -> None:
    drive = Body(max_speed=0.5, max_turn=1.0).place(room(square(5)), (0.0, 0.0, 0.0))
    drive.step(99.0, 0.0, 0.1)
    drive.step(0.0, -99.0, 0.1)
    assert drive.pose == pytest.approx((0.05, 0.0, -0.1))
    drive.step(-99.0, 0.0, 0.1)
    assert drive.pose[0] == pytest.approx(0.05 - 0.05 * np.cos(0.1))


def test_wall_stops_what_comes_straight_and_lets_the_rest_slide() -> None:
    arena = room(square(2))
    drive = Body().place(arena, (0.0, 0.0, 0.0))
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
    drive = Body(radius=0.5, max_speed=10.0).place(room(square(2)), (1.4, 0.0, 0.0))
    assert drive.step(10.0, 0.0, 0.0249)
    for _ in range(5):
        drive.step(0.0, 0.0, 0.05)
        assert drive.pose == pytest.approx((1.5, 0.0, 0.0), abs=1e-6)


def test_no_wall_is_thin_enough_to_pass() -> None:
    wall = {"start": (0.5, -4.0), "end": (0.5, 4.0), "material": "brick"}
    drive = Body(max_speed=50.0).place(room(square(4), walls=[wall]), (0.0, 0.0, 0.1))
    assert drive.step(50.0, 0.0, 2.0)
    assert drive.pose[0] == pytest.approx(0.32, abs=1e-5)


def test_looking_ahead_finds_what_is_straight_before_the_centre() -> None:
    arena = room(square(2), pillars=[{"center": (0.0, 1.0), "radius": 0.2, "material": "brick"}])
    drive = Body().place(arena, (0.0, 0.0, 0.0))
    assert drive.ahead(1.99) is None
    assert abs(drive.ahead(2.01)) == pytest.approx(np.pi)
    drive.step(0.0, np.pi, 0.5)
    assert drive.ahead(0.79) is None
    assert drive.ahead(0.81) == pytest.approx(-np.pi / 2, abs=0.1)


def test_round_a_corner_of_the_platform() -> None:
    arena = room(ELBOW)
    drive = Body(radius=0.2).place(arena, (0.8, 2.5, -np.pi / 2))
    reached = []
    for _ in range(2000):
        drive.step(0.6, 1.5 * np.sin(np.arctan2(-1, 1) - drive.pose[2]), 0.02)
        reached.append(np.hypot(*np.subtract(drive.pose[:2], 1.0)))
        assert outside(arena, drive, 0.2) < 1e-3
    assert min(reached) == pytest.approx(0.2, abs=1e-5)
    assert drive.pose[:2] == pytest.approx((2.8, 0.2), abs=1e-3)


def test_wedge_holds_the_body() -> None:
    arena = room([[0.0, 0.0], [4.0, -0.3], [4.0, 0.3]])
    drive = Body(radius=0.1).place(arena, (3.0, 0.0, np.pi))
    for _ in range(400):
        drive.step(0.65, 0.0, 0.05)
        assert outside(arena, drive, 0.1) < 1e-5
    assert drive.pose[0] == pytest.approx(0.1 / np.sin(np.arctan2(0.3, 4)), abs=0.05)


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
    drive = Body(radius=radius, max_speed=2.0, max_turn=10.0).place(arena, (x, y, 0.0))
    places = []
    for speed, turn in zip(rng.uniform(-0.5, 2, 400), turning * rng.standard_normal(400), strict=True):
        drive.step(speed, turn, 0.05)
        places.append(drive.pose[:2])
    free = arena.free_space(radius)
    assert shapely.distance(free, shapely.points(places)).max() < 1e-3


@pytest.mark.parametrize(
    "pose", [(0.1, 0.0, 0.0), (1.9, 0.0, 0.0), (9.0, 0.0, 0.0), (1.0, np.nan, 0.0), (1.0, 1.0, np.inf)]
)
def test_start_must_be_free(pose: tuple[float, float, float]) -> None:
    with pytest.raises(ArenaError, match="start"):
        Body().place(Arena.load("pillar"), pose)


def test_where_a_body_came_to_a_body_can_start() -> None:
    arena = room(square(2))
    drive = Body().place(arena, (0.0, 0.0, 0.3))
    while not drive.step(0.65, 0.0, 0.05):
        pass
    assert Body().place(arena, drive.pose).pose == drive.pose


@pytest.mark.parametrize(
    "command", [(np.nan, 0.0, 0.1), (0.1, np.inf, 0.1), (0.1, 0.0, 0.0), (0.1, 0.0, -1.0)]
)
def test_bad_commands_are_refused(command: tuple[float, float, float]) -> None:
    drive = Body().place(room(square(2)), (0.0, 0.0, 0.0))
    with pytest.raises(ArenaError, match="step"):
        drive.step(*command)


@pytest.mark.parametrize("name", ["radius", "max_speed", "max_turn"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_bad_parameters_are_refused(name: str, value: float) -> None:
    with pytest.raises(ArenaError, match=name):
        Body(**{name: value})
