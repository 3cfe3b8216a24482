"""The heavy body: a disc with mass, which commands push and which coasts."""

from typing import Annotated

from pydantic import Field, model_validator

from arena.bodies.disc import Disc

_Mass = Annotated[float, Field(gt=0, le=1e6)]


class HeavyDisc(Disc):
    r"""A disc with mass and friction: a command is a share u, u' ∈ [−1, 1] of its largest force and torque.

    .. math:: m \dot v = f u - c v, \qquad I \dot \omega = \tau u' - \gamma \omega

    Solved exactly while a command lasts: v approaches `max_speed` u = f u / c with time constant m / c. So
    a motion steers it like any body, but it speeds up and stops late. A wall takes from its speed what does
    not go along the wall.

    Parameters
    ----------
    mass, inertia
        m (kg) and I (kg m²).
    damping, turn_damping
        c (kg/s) and γ (kg m²/s).

    All else is as of a `Disc`, but that it has no `max_acceleration`: force and mass tell. The gain of a
    command, f = c `max_speed` and τ = γ `max_turn`, is set by these.

    Raises
    ------
    ArenaError
        For parameters that are not positive and finite, and accelerations.
    """

    mass: _Mass = 6.0
    inertia: _Mass = 0.1
    damping: _Mass = 10.0
    turn_damping: _Mass = 0.5

    @model_validator(mode="after")
    def _agree(self) -> "HeavyDisc":
        if self.max_acceleration is not None or self.max_turn_acceleration is not None:
            raise ValueError("a heavy body accelerates by force and mass; leave its accelerations out")
        return self

    @property
    def lags(self) -> tuple[float, float]:
        """Time constants of speed and turn rate, s."""
        return self.mass / self.damping, self.inertia / self.turn_damping
