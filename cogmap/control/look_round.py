"""Looking round: turning the head a little until it is clear which of places that look alike this is."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from arena.motions.policy import Sensed
from cogmap.errors import CogmapError
from cogmap.features.image_codes import image_codes
from cogmap.navigation.hypotheses import Hypotheses, SceneMemory

STANDS = 10.0
"""Log-likelihood ratio to every hypothesis of elsewhere from which on one stands."""
UNCLEAR = "places that are apart look alike from here as far as the head turned; look from elsewhere"


class LookRound:
    """A policy (`arena.Policy`) that turns its head until one hypothesis of where it is stands, or gives up.

    It turns to one side, look by look, then to the other. Then `resolved_` says whether one stands; where
    none does what looks alike is alike, as far as it may turn, and the most likely is a guess.

    Parameters
    ----------
    memory
        Views and smells that are remembered; what is smelt now is not used.
    turn
        The command of a small turn, as of `Steering.command`.
    looks
        To either side. The head turns by no more than so many small turns from where it looked at first.

    Attributes
    ----------
    resolved_ : (explorers,)
        Whether one hypothesis stands.
    views_ : (explorers,)
        Which remembered view the last look is most like, of those where it is most likely.
    first_views_ : (explorers,)
        The same after the first look.
    looks_ : (explorers,)
        How often it looked.
    """

    def __init__(self, memory: SceneMemory, turn: Float[np.ndarray, "2"], *, looks: int = 5) -> None:
        back = np.clip(-(looks + 1) * turn, -1, 1)
        self._turns = [turn] * looks + [back] + [-turn] * (looks - 1)
        self._memory = memory
        self._hypotheses: list[Hypotheses] = []
        self._going = np.zeros(0, bool)

    def __call__(self, sensed: Sensed) -> Float[np.ndarray, "2"] | Float[np.ndarray, "explorers 2"] | None:
        """Weigh what is seen, and turn on where it is not clear yet."""
        single = sensed["view"].ndim == 3
        codes = self._memory.looks(image_codes(sensed["view"][None] if single else sensed["view"]))
        if not self._hypotheses:
            self._hypotheses = [Hypotheses(self._memory, code) for code in codes]
            self.looks_, self.first_views_ = np.ones(len(codes), int), self.views_
        elif len(codes) != len(self._hypotheses):
            raise CogmapError(f"there are {len(codes)} explorers now but {len(self._hypotheses)} before")
        else:
            for explorer in np.flatnonzero(self._going):
                self._hypotheses[explorer].weigh(codes[explorer])
                self.looks_[explorer] += 1
        self._going = ~self.resolved_ & (self.looks_ <= len(self._turns))
        commands = np.full((len(codes), 2), np.nan)
        for explorer in np.flatnonzero(self._going):
            commands[explorer] = self._turns[self.looks_[explorer] - 1]
        if not single:
            return commands
        return commands[0] if self._going[0] else None

    @property
    def resolved_(self) -> np.ndarray:
        """Whether one hypothesis stands."""
        return np.array([each.lead_ > STANDS for each in self._hypotheses])

    @property
    def views_(self) -> np.ndarray:
        """Which remembered view the last look is most like."""
        return np.array([each.view_ for each in self._hypotheses])

    @property
    def reasons_(self) -> list[str]:
        """Why no hypothesis stands, in words; empty where one does."""
        return ["" if resolved else UNCLEAR for resolved in self.resolved_]
