"""Steering: the command for a motion that is wanted, by a motor model turned round."""

import numpy as np
from jaxtyping import Float

from cogmap.control.motor_model import MotorModel, carried
from cogmap.errors import CogmapError

CLOSE = 0.04
"""Share of a decision's way from the goal within which it counts as reached; of its turn a sixth of that."""
RESTS, SLOWEST = 0.01, 0.95
"""Share of its speed with which a coasting body counts as at rest; the most that is kept each decision."""
CLEAR = 2.0
"""Times its own noise by which a motion must answer to commands."""


class Steering:
    """Turns a motor model round: how to go and how to turn.

    Attributes
    ----------
    course
        Direction in which the body goes, rad from where the map says it looks.
    pace, turn
        How far it gets (the map's unit) and turns (rad) in a decision at most.
    coasting
        Decisions after which it rests when commands end.
    close, facing
        Distance (the map's unit) and turn (rad) from a goal within which it counts as reached.

    Raises
    ------
    CogmapError
        When commands neither turn the body nor move it, as far as babbling has shown.
    """

    def __init__(self, motor: MotorModel) -> None:
        self._motor = motor
        total = motor.total_
        along, strength, _ = np.linalg.svd(total[:2])
        turns = np.abs(total[2]).max() > CLEAR * motor.noise_[2]
        if not (turns and strength[0] > CLEAR * motor.noise_[:2].min()):
            raise CogmapError(
                "commands hardly move or turn this body, as far as its motor model knows; "
                "babble longer, with both numbers of the command"
            )
        along[:, 0] *= np.copysign(1.0, along[0, 0])  # rather where it looks than backwards
        self.course = float(np.arctan2(along[1, 0], along[0, 0]))
        inverse = np.linalg.pinv(total, rcond=1e-3)
        self._go = inverse[:, :2] @ along[:, 0]
        self._turn = inverse[:, 2]
        self.pace, self.turn = (float(1 / np.abs(gain).max()) for gain in (self._go, self._turn))
        # of first order what comes late takes one decision; a body that coasts rests after some
        lasting = min(float(np.abs(np.linalg.eigvals(motor.persistence_)).max()), SLOWEST)
        self.coasting = max(1, int(np.ceil(np.log(RESTS) / np.log(lasting)))) if lasting > 0 else 1
        self.close, self.facing = CLOSE * self.pace, CLOSE / 6 * self.turn

    def command(
        self, forward: Float[np.ndarray, "bodies"], turn: Float[np.ndarray, "bodies"]
    ) -> Float[np.ndarray, "bodies 2"]:
        """Give the command for going this far (the map's unit) and turning by this much (rad) in a decision.

        What exceeds the body is cut: the turn to what it can, and the way to what the turn leaves of it.
        """
        turning = np.clip(turn, -self.turn, self.turn)[:, None] * self._turn
        going = forward[:, None] * self._go
        left = np.where(going * turning < 0, 1 + np.abs(turning), 1 - np.abs(turning))
        share = (left / np.maximum(np.abs(going), 1e-12)).min(axis=1)
        commands: np.ndarray = turning + going * np.minimum(share, 1)[:, None]
        return commands

    def coming(
        self,
        position: Float[np.ndarray, "bodies 2"],
        phase: Float[np.ndarray, "bodies"],
        last: Float[np.ndarray, "bodies 2"],
        motion: Float[np.ndarray, "bodies 3"],
    ) -> tuple[Float[np.ndarray, "bodies 2"], Float[np.ndarray, "bodies"]]:
        """Foretell where bodies get by what is still to come of the last command, and by coasting."""
        nothing = np.zeros((self.coasting, *last.shape))
        for step in self._motor.roll_out(nothing, last, motion):
            position, phase = carried(position, phase, step)
        return position, phase

    def moves(
        self,
        command: Float[np.ndarray, "bodies 2"],
        before: Float[np.ndarray, "bodies 2"],
        motion: Float[np.ndarray, "bodies 3"],
    ) -> Float[np.ndarray, "bodies 3"]:
        """Foretell how bodies move by a command after another, and after a motion."""
        return self._motor.predict(command, before, motion)
