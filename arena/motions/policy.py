"""The contract of a policy: it is told what is sensed and gives a command, so that a loop can close."""

from collections.abc import Mapping
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

Sensed = Mapping[str, np.ndarray]
"""{"view": (height, width, 3) uint8, "odour": (odorants,) float32}, or with a leading axis of explorers."""


@runtime_checkable
class Policy(Protocol):
    """Steers by what is sensed, and is told nothing else: no pose, no contact, no time.

    A policy may remember: it is asked once a step, in order, and serves one journey, or one batch of them.
    For a batch it is asked about all explorers every step, and rows stay in place: of one that has stopped it
    is shown what that one sensed last, and what it says of it is not heard.
    """

    def __call__(
        self, sensed: Sensed
    ) -> Float[np.ndarray, " motors"] | Float[np.ndarray, "explorers motors"] | None:
        """Give the next command.

        Parameters
        ----------
        sensed
            `{"view": (height, width, 3) uint8, "odour": (odorants,) float32}`, with a leading axis of
            explorers for a batch. Concentrations are as the nose smells them, > 0.

        Returns
        -------
        command
            A number in [−1, 1] for each motor, `(motors,)` or `(explorers, motors)`: of a disc speed over
            its `max_speed` and turn rate over its `max_turn`, of an arm a share of what each joint can do;
            what is too much the body cuts. None, or a row of NaN in a batch, has stopped for good.
        """
