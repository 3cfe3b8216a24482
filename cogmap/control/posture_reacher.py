"""Reaching with any body: bringing joints that nobody has described to where an image was taken."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import Any

import numpy as np
from jaxtyping import Float

from cogmap.control.posture_reaching import PostureReaching
from cogmap.control.posture_ways import PostureWays
from cogmap.control.visual_jacobian import VisualJacobian
from cogmap.features.image_codes import sharp_codes
from cogmap.inputs import check_array, checked_views
from cogmap.map.even_memory import EvenMemory

KEPT = 4
"""Of as many babbled views one is a place of the roadmap."""


@dataclass(eq=False)
class PostureReacher:
    """Reaches postures that are given by images, from what a body saw while its motors babbled.

    Parameters
    ----------
    encode
        Gives the code of views, as `GeneralisedCoordinates.encode`.
    views
        That were taken while the motors babbled, in their order, (views, height, width, 3) uint8.
    commands
        Those that held from each view to the next, in [−1, 1]; the last is not used.
    times
        When each view was taken, s.
    dt
        For how long each command of the policy will hold, s.
    seed
        Of the kicks that free a body which no longer comes nearer.

    Raises
    ------
    CogmapError
        At first use: for arrays that do not fit, and too few views.
    """

    encode: Callable[[Any], Float[np.ndarray, "views features"]]
    views: Any
    commands: Float[np.ndarray, "views motors"]
    times: Float[np.ndarray, " views"]
    _: KW_ONLY
    dt: float = 0.2
    seed: int = 0

    def towards(self, goal: Any) -> PostureReaching:
        """Make a policy that moves the joints until what is seen is this image.

        Parameters
        ----------
        goal
            (height, width, 3) uint8, or (explorers, height, width, 3), one for each explorer of a batch.

        Raises
        ------
        CogmapError
            For a goal of another eye.
        """
        goal = np.asarray(goal)
        views = goal[None] if goal.ndim == 3 else goal
        views = checked_views(views, self.views.shape[1:])
        return PostureReaching(self, views, single=goal.ndim == 3)

    @cached_property
    def jacobian(self) -> VisualJacobian:
        """What motors do to codes."""
        check_array("times", self.times, (len(self.views),))
        check_array("commands", self.commands, (len(self.views), None))
        return VisualJacobian(self._codes, self.commands[:-1] * np.diff(self.times)[:, None])

    @cached_property
    def ways(self) -> PostureWays:
        """What plans ways over an even memory of the views."""
        memory = EvenMemory(len(self._codes) // KEPT).partial_fit(np.arange(len(self._codes)), self._codes)
        return PostureWays(memory.codes_.astype(np.float64), self.jacobian)

    @cached_property
    def sharp(self) -> Float[np.ndarray, "views pixels"]:
        """Finer codes of the views, which tell the last small steps."""
        return sharp_codes(self.views)

    @cached_property
    def _codes(self) -> Float[np.ndarray, "views features"]:
        return self.encode(self.views).astype(np.float64)
