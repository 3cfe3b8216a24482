import numpy as np
import pytest

from arena.bodies.arm import Arm
from arena.bodies.base import Body, check_starts, joints_of, wrapped
from arena.bodies.catalogue import bodies
from arena.bodies.disc import Disc
from arena.bodies.neck import Neck
from arena.errors import ArenaError
from arena.rooms.arena import Arena

ROOM = Arena.load("furnished")
RNG = np.random.default_rng


@pytest.mark.parametrize("name", sorted(bodies()))
def test_every_body_keeps_the_contract(name: str) -> None:
    body = bodies()[name]()
    assert isinstance(body, Body)
    starts = body.sample_free(ROOM, 20, RNG(0))
    assert starts.shape == (20, len(body.axes))
    check_starts(body, ROOM, starts)
    at_large, which = body.at_large(ROOM, 20), np.arange(0, 20, 2)
    at_large.begin(np.arange(20), starts)
    np.testing.assert_allclose(at_large.configurations, starts, atol=1e-12)
    velocities = body.velocities(RNG(1).uniform(-1, 1, (10, len(body.motors))))
    for _ in range(8):
        at_large.step(which, velocities, 0.5, [])
        assert body.is_free(ROOM, at_large.configurations).all()
    there = at_large.configurations
    np.testing.assert_array_equal(there[1::2], wrapped(body, starts[1::2]))
    assert (there[::2] != starts[::2]).all(axis=1).any()
    assert not at_large.touched[1::2].any()
    poses, segments = body.camera_poses(there), body.segments(there)
    assert poses.shape == (20, 3)
    assert (segments.shape[0], segments.shape[2:]) == (20, (2, 2))
    # The eye is on the body.
    assert (np.hypot(*(segments - poses[:, None, None, :2]).T).min(axis=(0, 1)) < 1e-9).all()


@pytest.mark.parametrize("name", sorted(bodies()))
def test_bodies_at_large_go_as_alone(name: str) -> None:
    body = bodies()[name]()
    starts = body.sample_free(ROOM, 5, RNG(0))
    commands = RNG(1).uniform(-1, 1, (6, 5, len(body.motors)))

    def gone(which: slice) -> np.ndarray:
        at_large = body.at_large(ROOM, len(starts[which]))
        everyone = np.arange(len(starts[which]))
        at_large.begin(everyone, starts[which])
        for command in commands:
            at_large.step(everyone, body.velocities(command[which]), 0.2, [])
        return at_large.configurations

    np.testing.assert_array_equal(gone(slice(None))[3:4], gone(slice(3, 4)))


@pytest.mark.parametrize("name", sorted(bodies()))
def test_one_alone_goes_as_one_of_many(name: str) -> None:
    body = bodies()[name]()
    (start,) = body.sample_free(ROOM, 1, RNG(0))
    placed, at_large, one = body.place(ROOM, tuple(start)), body.at_large(ROOM, 1), np.zeros(1, int)
    at_large.begin(one, start[None])
    for command in RNG(1).uniform(-1, 1, (20, len(body.motors))):
        touched = placed.go(body.velocities(command).tolist(), 0.2)
        at_large.step(one, body.velocities(command[None]), 0.2, [])
        np.testing.assert_array_equal(placed.configuration, at_large.configurations[0])
        assert touched == at_large.touched[0]
    with pytest.raises(ArenaError, match="finite"):
        placed.go([np.nan] * len(body.motors), 0.2)
    with pytest.raises(ArenaError, match="dt > 0"):
        placed.go([0.1] * len(body.motors), 0.0)


@pytest.mark.parametrize("body", [Disc(slip=0.1), Arm(slip=0.1), Neck(base=Disc(slip=0.1))])
def test_who_slips_needs_a_generator(body: Body) -> None:
    with pytest.raises(ArenaError, match=r"slip by 0\.1; give `rng`"):
        body.place(ROOM, tuple(body.sample_free(ROOM, 1, RNG(0))[0]))


def test_circles_alone_are_wrapped_and_a_disc_has_no_joints() -> None:
    far = np.array([[9.0, -9.0, 4.0]])
    np.testing.assert_allclose(wrapped(Disc(), far), [[9.0, -9.0, 4.0 - 2 * np.pi]])
    assert joints_of(Disc(), far) is None
    assert joints_of(bodies()["arm"](), far[:, :2]) is not None


@pytest.mark.parametrize(
    ("starts", "message"),
    [
        (np.zeros((1, 2)), "give x .m., y .m., heading .rad. of the Disc a row"),
        (np.array([[0.0, np.nan, 0.0]]), "not finite"),
        (np.array([[0.0, 0.0, 0.0], [9.0, 0.0, 0.0]]), "cannot start at .* = 9, 0, 0"),
    ],
)
def test_starts_that_cannot_be_are_one_sentence(starts: np.ndarray, message: str) -> None:
    with pytest.raises(ArenaError, match=message):
        check_starts(Disc(), ROOM, starts)
