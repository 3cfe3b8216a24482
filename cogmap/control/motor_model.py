"""The motor model: what a command does to where the map says one is."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
import torch
from jaxtyping import Float

from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.inputs import check_array
from cogmap.map.activity import Activity
from cogmap.map.storage import read_state, write_state

ROUNDS = 20
"""Of weights that count outliers less."""
TAIL = 3.0
"""Usual errors from which on a step counts less than a quarter."""
FEWEST = 40
"""Steps from which a model is learnt."""
RANK = 1e-3
"""Of the strongest response: what is weaker is none."""


class MotorModel:
    r"""What commands do in a map's own unit and frame, learnt from what was seen before and after them.

    .. math:: d_t = \bigl(e^{-i (\theta + \Delta\theta / 2)} \Delta x, \Delta\theta\bigr)
        = M_0 u_t + M_1 u_{t-1} + A d_{t-1}

    for position x, heading θ and command u; M₁ is what comes late, and A what goes on by itself: with it, of
    second order, the model holds for bodies with mass and friction, whatever these and the gain of commands
    are; without, A is 0. All is found by least squares in which steps that a wall or a slip spoilt count
    less (Geman–McClure weights), kept as sums, so that models merge and learn on. What a command does is not
    known before: neither which number turns and which goes, nor its sign or gain, nor whether the map is
    mirrored.

    Parameters
    ----------
    order
        1, or 2 for a body that coasts.

    Attributes
    ----------
    response_ : (2, 3, 2)
        M₀ and M₁: forward, left (the map's unit) and turn (rad) per decision and unit of command.
    persistence_ : (3, 3)
        A.
    total_ : (3, 2)
        What a command that goes on brings about per decision in the end, and one that does not in all.
    noise_ : (3,)
        Usual error of a step (1.48 median absolute deviations of the last steps learnt).

    References
    ----------
    Demiris & Dearden (2005), From motor babbling to hierarchical learning by imitation.
    """

    def __init__(self, order: Literal[1, 2] = 1) -> None:
        if order not in {1, 2}:
            raise CogmapError(f"a motor model is of order 1 or 2, not {order}")
        self.order = order
        causes = 4 if order == 1 else 7
        self._gram, self._cross = np.zeros((causes, causes)), np.zeros((causes, 3))
        self.noise_ = np.full(3, np.nan)

    def partial_fit(
        self,
        commands: Float[np.ndarray, "steps 2"],
        before: Activity,
        after: Activity,
        *,
        previous: Float[np.ndarray, "steps 2"] | None = None,
        motion: Float[np.ndarray, "steps 3"] | None = None,
    ) -> MotorModel:
        """Learn what some commands did.

        Parameters
        ----------
        commands
            One a step, in [−1, 1].
        before, after
            What the map perceived before and after each, with a metric map and a compass.
        previous
            The command before each; when None the steps follow each other, and the first, before which
            nothing is known, is left out.
        motion
            What `body_motion` tells of the step before each, where `previous` is given and the order is 2.

        Raises
        ------
        CogmapError
            For a map that tells no positions or headings, arrays that do not fit, and too few steps.
        """
        check_array("commands", commands, (None, 2))
        steps = len(commands)
        for name, seen in (("before", before), ("after", after)):
            if len(seen) != steps:
                raise CogmapError(f"there are {steps} commands but {len(seen)} views {name} them")
            if np.isnan(seen.position).any() or np.isnan(seen.phase).any():
                raise CogmapError("this map tells no positions or no headings, so no motor model is learnt")
        moved = body_motion(before.position, before.phase, after.position, after.phase)
        if previous is None:
            commands, previous, motion, moved = commands[1:], commands[:-1], moved[:-1], moved[1:]
        check_array("previous", previous, (len(commands), 2))
        if len(commands) < FEWEST:
            raise CogmapError(f"{len(commands)} steps teach no motor model; babble for at least {FEWEST}")
        given = np.concatenate([commands, previous], axis=1).astype(np.float64)
        if self.order == 2:
            check_array("motion", motion, (len(commands), 3))
            given = np.concatenate([given, motion], axis=1)
        weights = np.ones(len(given))
        for _ in range(ROUNDS):
            gram = self._gram + (weights[:, None] * given).T @ given
            cross = self._cross + (weights[:, None] * given).T @ moved
            errors = np.abs(moved - given @ _solved(gram, cross))
            usual = np.maximum(1.48 * np.median(errors, axis=0), 1e-9)
            weights = 1 / np.square(1 + np.square(errors / (TAIL * usual)).sum(axis=1))
        self._gram, self._cross, self.noise_ = gram, cross, usual
        return self

    def predict(
        self,
        commands: Float[np.ndarray, "bodies 2"],
        previous: Float[np.ndarray, "bodies 2"] | None = None,
        motion: Float[np.ndarray, "bodies 3"] | None = None,
    ) -> Float[np.ndarray, "bodies 3"]:
        """Foretell forward, left (the map's unit) and turn (rad) of a decision.

        Commands go on when none came before, and where no motion is told it is what `previous` brings about
        in the end.
        """
        now, late = self.response_
        before = commands if previous is None else previous
        foretold: np.ndarray = commands @ now.T + before @ late.T
        if self.order == 2:
            foretold += (before @ self.total_.T if motion is None else motion) @ self.persistence_.T
        return foretold

    def roll_out(
        self,
        commands: Float[np.ndarray, "decisions bodies 2"],
        previous: Float[np.ndarray, "bodies 2"],
        motion: Float[np.ndarray, "bodies 3"],
    ) -> Float[np.ndarray, "decisions bodies 3"]:
        """Foretell decisions on end, from the command and the motion before; `carried` makes poses of it."""
        foretold = []
        for now in commands:
            motion = self.predict(now, previous, motion)
            foretold.append(motion)
            previous = now
        return np.array(foretold)

    def merge(self, other: MotorModel) -> MotorModel:
        """Add what another model has learnt with the same map and body; its noise is the larger of both."""
        self._gram, self._cross = self._gram + other._gram, self._cross + other._cross
        self.noise_ = np.fmax(self.noise_, other.noise_)
        return self

    @property
    def response_(self) -> Float[np.ndarray, "2 3 2"]:
        """M₀ and M₁."""
        return self._solution[:, :4].reshape(3, 2, 2).transpose(1, 0, 2)

    @property
    def persistence_(self) -> Float[np.ndarray, "3 3"]:
        """A."""
        return self._solution[:, 4:] if self.order == 2 else np.zeros((3, 3))

    @property
    def total_(self) -> Float[np.ndarray, "3 2"]:
        """(1 − A)⁻¹ (M₀ + M₁)."""
        total = self.response_.sum(axis=0)
        return np.linalg.solve(np.eye(3) - self.persistence_, total) if self.order == 2 else total

    @property
    def _solution(self) -> Float[np.ndarray, "3 causes"]:
        if not self._gram.any():
            raise CogmapError("this motor model has learnt nothing yet; call partial_fit first")
        return _solved(self._gram, self._cross).T

    def save(self, path: str | Path) -> None:
        """Write the model to a new folder: `weights.safetensors` and `motor.json`.

        Raises
        ------
        CogmapError
            When something is at the path already, or it cannot be written.
        """
        arrays = {"gram": self._gram, "cross": self._cross, "noise": self.noise_}
        weights = {name: torch.from_numpy(array) for name, array in arrays.items()}
        write_state(path, weights, {}, {}, kind="motor")

    @classmethod
    def load(cls, path: str | Path) -> MotorModel:
        """Read a model that `save` wrote.

        Raises
        ------
        CogmapError
            When it is missing, damaged or of another version.
        """
        weights, _, _ = read_state(path, kind="motor")
        try:
            loaded = cls(2 if len(weights["gram"]) > 4 else 1)
            loaded._gram, loaded._cross = weights["gram"].numpy(), weights["cross"].numpy()
            loaded.noise_ = weights["noise"].numpy()
        except KeyError as error:
            raise CogmapError(f"{path} does not hold a whole motor model: {error}") from None
        return loaded


def body_motion(
    position: Float[np.ndarray, "steps 2"],
    phase: Float[np.ndarray, "steps"],
    then: Float[np.ndarray, "steps 2"],
    facing: Float[np.ndarray, "steps"],
) -> Float[np.ndarray, "steps 3"]:
    """Tell forward, left (the map's unit) and turn (rad) from one position and heading to the next."""
    turn = wrap_angle(facing.astype(np.float64) - phase)
    step = then.astype(np.float64) - position
    # along the chord of the arc: halfway between both headings
    moved = (step[:, 0] + 1j * step[:, 1]) * np.exp(-1j * (phase + turn / 2))
    return np.column_stack([moved.real, moved.imag, turn])


def carried(
    position: Float[np.ndarray, "bodies 2"],
    phase: Float[np.ndarray, "bodies"],
    motion: Float[np.ndarray, "bodies 3"],
) -> tuple[Float[np.ndarray, "bodies 2"], Float[np.ndarray, "bodies"]]:
    """Give the position and heading that a motion leads to: `body_motion` turned round."""
    forward, left, turn = motion.T
    step = (forward + 1j * left) * np.exp(1j * (phase + turn / 2))
    return position + np.column_stack([step.real, step.imag]), wrap_angle(phase + turn)


def _solved(
    gram: Float[np.ndarray, "causes causes"], cross: Float[np.ndarray, "causes 3"]
) -> Float[np.ndarray, "causes 3"]:
    return np.asarray(np.linalg.lstsq(gram, cross, rcond=RANK**2)[0])
