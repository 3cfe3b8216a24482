import numpy as np
import pytest
from scipy.integrate import solve_ivp

from arena.bodies.heavy_disc import HeavyDisc
from arena.errors import ArenaError
from arena.rooms.arena import Arena

OPEN = Arena.load("open_field")
BODY = HeavyDisc(mass=4.0, damping=5.0, inertia=0.2, turn_damping=0.4, max_speed=0.5, max_turn=2.0)


def test_force_friction_and_mass_are_newtons() -> None:
    """Beside an integrator of the equations of the docstring, with turning and pushing at once."""

    def newton(_: float, state: np.ndarray, pushed: np.ndarray) -> list[float]:
        _, _, heading, speed, turn = state
        force, torque = (
            BODY.damping * BODY.max_speed * pushed[0],
            BODY.turn_damping * BODY.max_turn * pushed[1],
        )
        return [
            speed * np.cos(heading),
            speed * np.sin(heading),
            turn,
            (force - BODY.damping * speed) / BODY.mass,
            (torque - BODY.turn_damping * turn) / BODY.inertia,
        ]

    drive, state = BODY.place(OPEN, (-1.0, 0.0, 0.0)), np.array([-1.0, 0.0, 0.0, 0.0, 0.0])
    for command in np.random.default_rng(0).uniform((-0.5, -1), (1, 1), (12, 2)):
        assert not drive.step(*BODY.velocities(command).tolist(), 0.2)
        state = solve_ivp(newton, (0, 0.2), state, args=(command,), rtol=1e-9, atol=1e-12).y[:, -1]
        assert (drive.speed, drive.turn) == pytest.approx(tuple(state[3:]), abs=1e-8)
        assert drive.pose[2] == pytest.approx(state[2], abs=1e-8)
        assert drive.pose[:2] == pytest.approx(tuple(state[:2]), abs=2e-5)


def test_without_force_friction_takes_all_energy_over_a_known_way() -> None:
    drive = BODY.place(OPEN, (-1.5, 0.0, 0.0))
    for _ in range(20):
        drive.step(0.5, 0.0, 0.1)
    speed, x = drive.speed, drive.pose[0]
    assert speed == pytest.approx(0.5 * (1 - np.exp(-2.0 / 0.8)))
    drive.step(0.0, 0.0, 0.3)
    assert drive.speed**2 == pytest.approx(speed**2 * np.exp(-2 * 0.3 / 0.8))
    for _ in range(100):
        drive.step(0.0, 0.0, 0.3)
    assert drive.pose[0] == pytest.approx(x + 0.8 * speed)


def test_a_wall_takes_the_speed_against_it() -> None:
    drive = BODY.place(OPEN, (1.7, 0.0, 0.0))
    assert any(drive.step(0.5, 0.0, 0.2) for _ in range(10))
    assert drive.contact == pytest.approx(np.pi)
    assert drive.speed == pytest.approx(0.0, abs=1e-3)
    drive.step(-0.5, 0.0, 0.1)
    assert drive.speed == pytest.approx(-0.5 * (1 - np.exp(-0.1 / 0.8)), abs=1e-3)


def test_accelerations_are_told_by_mass() -> None:
    with pytest.raises(ArenaError, match="leave its accelerations out"):
        HeavyDisc(max_acceleration=1.0)
