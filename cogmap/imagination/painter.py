"""Painting: views from between remembered places, made of those around them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from cogmap.imagination.places import RememberedPlaces, Sources
from cogmap.imagination.turning import Painted, blended, columns_turned
from cogmap.imagination.warp import warped
from cogmap.threads import in_order, one_thread

Turned = Literal["turned", "blend", "warp"]
"""How a view is made of others that are turned, from one of them alone or from all."""


@dataclass(frozen=True)
class Painter:
    """Makes views of their sources, each turned to where the target looks."""

    places: RememberedPlaces
    sense: int
    """Whether phase grows to the left (1) or to the right (−1)."""

    def paint(
        self, sources: Sources, phase: Float[np.ndarray, "targets"], method: Turned = "warp"
    ) -> Iterator[Painted]:
        """Make views, one after the other, in threads."""
        with one_thread():
            yield from in_order(self.painted(sources, phase, method), range(len(phase)))

    def painted(
        self, sources: Sources, phase: Float[np.ndarray, "targets"], method: Turned = "warp"
    ) -> Callable[[int], Painted]:
        """Give what makes the view of a target."""
        turn = self.sense * (phase[:, None] - self.places.phase[sources.indices])
        shifts = columns_turned(turn, self.places.views.shape[2])
        paint = warped if method == "warp" else blended

        def painted(target: int) -> Painted:
            views = np.stack([self.places.views[view] for view in sources.indices[target]])
            return paint(views, shifts[target], sources.affine[target], sources.near[target])

        return painted
