import numpy as np
import pymunk
import pytest
import shapely

from arena.bodies.linkage import are_clear, bend_all, turn_all

LENGTHS = np.array([1.0, 0.8, 0.5])
ARM = (0.2, -0.1, 0.3, np.zeros(3, bool), LENGTHS)
RNG = np.random.default_rng


def bent(joints: np.ndarray, chain: tuple = ARM) -> np.ndarray:
    links = np.empty((*joints.shape, 2, 2))
    bend_all(joints, chain, links)
    return links


def clear(joints: np.ndarray, edges: np.ndarray, radius: float = 0.08) -> np.ndarray:
    found = np.empty(len(joints), bool)
    are_clear(joints, ARM, radius, edges, found)
    return found


def test_links_hang_on_each_other() -> None:
    joints = RNG(0).uniform(-np.pi, np.pi, (50, 3))
    steps = LENGTHS * np.exp(1j * (0.3 + np.cumsum(joints, axis=1)))
    wanted = 0.2 - 0.1j + np.cumsum(steps, axis=1)
    links = bent(joints)
    np.testing.assert_allclose(links[:, :, 1] @ [1, 1j], wanted, atol=1e-12)
    np.testing.assert_array_equal(links[:, 1:, 0], links[:, :-1, 1])


def test_a_joint_that_slides_carries_what_turns_on_it() -> None:
    chain = (0.0, 0.0, np.pi / 2, np.array([True, False]), np.array([0.0, 0.5]))
    links = bent(np.array([[2.0, np.pi / 2]]), chain)
    np.testing.assert_allclose(links[0], [[[0, 2], [0, 2]], [[0, 2], [-0.5, 2]]], atol=1e-12)


def test_what_touches_is_what_touches_in_pymunk_and_shapely() -> None:
    joints = RNG(1).uniform(-np.pi, np.pi, (300, 3))
    edges = RNG(2).uniform(-2, 2, (15, 1, 2)) + RNG(3).uniform(-0.2, 0.2, (15, 2, 2))
    links, found = bent(joints), clear(joints, edges)
    near = shapely.distance(
        shapely.multilinestrings(shapely.linestrings(links.reshape(-1, 2, 2)), indices=np.arange(900) // 3),
        shapely.multilinestrings(shapely.linestrings(edges)),
    )
    np.testing.assert_array_equal(found, near >= 0.08)
    assert 0.2 < found.mean() < 0.8
    space = pymunk.Space()
    for a, b in edges.tolist():
        space.add(pymunk.Segment(space.static_body, a, b, 0.0))
    for k in range(50):
        body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        arms = [pymunk.Segment(body, *ends, 0.08) for ends in links[k].tolist()]
        assert found[k] == (not any(space.shape_query(arm) for arm in arms))


def turned(
    start: list[float], velocities: list[float], edges: np.ndarray, ranges: float = np.inf, steps: int = 1
) -> tuple[np.ndarray, bool]:
    joints, touched = np.array([start]), np.zeros(1, bool)
    ends = np.tile([-ranges, ranges], (3, 1))
    for _ in range(steps):
        turn_all(joints, ARM, ends, 0.08, edges, np.array([velocities]), 0.1, touched)
    return joints[0], bool(touched[0])


def test_joints_obey_exactly_and_stop_at_the_ends_of_their_ranges() -> None:
    nothing = np.empty((0, 2, 2))
    joints, touched = turned([0.0, 1.0, -1.0], [1.0, -2.0, 0.5], nothing, steps=100)
    np.testing.assert_allclose(joints, [10.0, -19.0, 4.0], atol=1e-12)
    assert not touched
    joints, touched = turned([0.0, 1.0, -1.0], [1.0, -2.0, 0.5], nothing, ranges=1.5, steps=100)
    np.testing.assert_array_equal(joints, [1.5, -1.5, 1.5])
    assert touched


@pytest.mark.parametrize("speed", [0.5, 5.0, 100.0])
def test_no_edge_is_passed_and_joints_slide_along_it(speed: float) -> None:
    # A wall beside the outstretched arm: the shoulder comes as far as the wall lets it.
    wall = np.array([[[-3.0, 1.2], [3.0, 1.2]]])
    joints, touched = turned([-0.3, 0.0, 0.0], [speed, 0.0, 0.0], wall, steps=max(1, int(60 / speed)))
    assert touched
    tip = bent(joints[None])[0, -1, 1]
    assert 1.2 - 0.08 - 0.03 < tip[1] <= 1.2 - 0.08
    # The elbow folds away from it: the shoulder goes on.
    further, _ = turned(joints.tolist(), [0.4 * speed, -speed, 0.0], wall, steps=max(1, int(5 / speed)))
    assert further[0] > joints[0]
    assert further[1] < joints[1]


def test_what_reaches_into_an_edge_by_a_hair_can_leave_but_not_go_on() -> None:
    wall = np.array([[[-3.0, 0.0799], [3.0, 0.0799]]])
    chain_start = [-0.3, 0.0, 0.0]
    inside = np.array([chain_start])
    touched, ends = np.zeros(1, bool), np.tile([-np.inf, np.inf], (3, 1))
    level = (0.2, 0.0, 0.3, *ARM[3:])
    turn_all(inside, level, ends, 0.08, wall, np.array([[1.0, 0.0, 0.0]]), 0.1, touched)
    assert touched[0]
    np.testing.assert_array_equal(inside[0], chain_start)
    turn_all(inside, level, ends, 0.08, wall, np.array([[-1.0, 0.0, 0.0]]), 0.1, touched)
    assert inside[0, 0] == pytest.approx(-0.4)
