"""The motor model: what a command does to where the map says one is."""

from __future__ import annotations

from pathlib import Path

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
"""Usual errors from which on a step counts less than half."""
FEWEST = 40
"""Steps from which a model is learnt."""
RANK = 1e-3
"""Of the strongest response: what is weaker is none."""


class MotorModel:
    r"""What commands do in a map's own unit and frame, learnt from what was seen before and after them.

    .. math:: \bigl(e^{-i (\theta + \Delta\theta / 2)} \Delta x, \Delta\theta\bigr) = M_0 u_t + M_1 u_{t-1}

    for position x, heading θ and command u; M₁ is what comes late. M is found by least squares in which steps
    that a wall or a slip spoilt count less (Cauchy weights), kept as sums, so that models merge and learn on.
    What a command does is not known before: neither which number turns and which goes, nor its sign or gain,
    nor whether the map is mirrored.

    Attributes
    ----------
    response_ : (2, 3, 2)
        M₀ and M₁: forward, left (the map's unit) and turn (rad) per decision and unit of command.
    noise_ : (3,)
        Usual error of a step (1.48 median absolute deviations of the last steps learnt).

    References
    ----------
    Demiris & Dearden (2005), From motor babbling to hierarchical learning by imitation.
    """

    def __init__(self) -> None:
        self._gram, self._cross = np.zeros((4, 4)), np.zeros((4, 3))
        self.noise_ = np.full(3, np.nan)

    def partial_fit(
        self,
        commands: Float[np.ndarray, "steps 2"],
        before: Activity,
        after: Activity,
        *,
        previous: Float[np.ndarray, "steps 2"] | None = None,
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
        moved = motion(before, after)
        if previous is None:
            commands, previous, moved = commands[1:], commands[:-1], moved[1:]
        check_array("previous", previous, (len(commands), 2))
        if len(commands) < FEWEST:
            raise CogmapError(f"{len(commands)} steps teach no motor model; babble for at least {FEWEST}")
        given = np.concatenate([commands, previous], axis=1).astype(np.float64)
        weights = np.ones(len(given))
        for _ in range(ROUNDS):
            gram = self._gram + (weights[:, None] * given).T @ given
            cross = self._cross + (weights[:, None] * given).T @ moved
            errors = np.abs(moved - given @ _solved(gram, cross))
            usual = np.maximum(1.48 * np.median(errors, axis=0), 1e-9)
            weights = 1 / (1 + np.square(errors / (TAIL * usual)).sum(axis=1))
        self._gram, self._cross, self.noise_ = gram, cross, usual
        return self

    def predict(
        self,
        commands: Float[np.ndarray, "steps 2"],
        previous: Float[np.ndarray, "steps 2"] | None = None,
    ) -> Float[np.ndarray, "steps 3"]:
        """Foretell forward, left (map's unit) and turn (rad) of steps; without `previous` commands last."""
        now, late = self.response_
        before = commands if previous is None else previous
        foretold: np.ndarray = commands @ now.T + before @ late.T
        return foretold

    def merge(self, other: MotorModel) -> MotorModel:
        """Add what another model has learnt with the same map and body; its noise is the larger of both."""
        self._gram, self._cross = self._gram + other._gram, self._cross + other._cross
        self.noise_ = np.fmax(self.noise_, other.noise_)
        return self

    @property
    def response_(self) -> Float[np.ndarray, "2 3 2"]:
        """M₀ and M₁."""
        if not self._gram.any():
            raise CogmapError("this motor model has learnt nothing yet; call partial_fit first")
        return _solved(self._gram, self._cross).T.reshape(3, 2, 2).transpose(1, 0, 2)

    def save(self, path: str | Path) -> None:
        """Write the model to a new folder: `weights.safetensors` and `motor.json`.

        Raises
        ------
        CogmapError
            When something is at the path already, or it cannot be written.
        """
        arrays = {"gram": self._gram, "cross": self._cross, "noise": self.noise_}
        weights = {name: torch.from_numpy(array) for name, array in arrays.items()}
        write_state(Path(path), weights, {}, {}, kind="motor")

    @classmethod
    def load(cls, path: str | Path) -> MotorModel:
        """Read a model that `save` wrote.

        Raises
        ------
        CogmapError
            When it is missing, damaged or of another version.
        """
        weights, _, _ = read_state(Path(path), kind="motor")
        loaded = cls()
        try:
            loaded._gram, loaded._cross = weights["gram"].numpy(), weights["cross"].numpy()
            loaded.noise_ = weights["noise"].numpy()
        except KeyError as error:
            raise CogmapError(f"{path} does not hold a whole motor model: {error}") from None
        return loaded


def motion(before: Activity, after: Activity) -> Float[np.ndarray, "steps 3"]:
    """Tell forward, left (the map's unit) and turn (rad) from one percept to the next."""
    turn = wrap_angle(after.phase.astype(np.float64) - before.phase)
    step = after.position.astype(np.float64) - before.position
    # along the chord of the arc: halfway between both headings
    moved = (step[:, 0] + 1j * step[:, 1]) * np.exp(-1j * (before.phase + turn / 2))
    return np.column_stack([moved.real, moved.imag, turn])


def _solved(gram: Float[np.ndarray, "4 4"], cross: Float[np.ndarray, "4 3"]) -> Float[np.ndarray, "4 3"]:
    return np.asarray(np.linalg.lstsq(gram, cross, rcond=RANK**2)[0])
