"""The split of a torus by a sense that feels only some of what moves: what is felt, and what is not."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.graph.knn import nearest_points
from cogmap.inputs import check_array

NEIGHBOURS = 40
"""Of a view, among which its sense is regressed on phases."""
CHANCE = 2.0
"""How many times what shuffled senses come to a direction must be felt."""
FAINT = 0.1
"""Of what is felt most: a direction that is felt less is in the null space."""


SHUFFLES = 5
_CLASSES = tuple(np.array(c) for c in ((1, 0), (0, 1), (1, 1), (1, -1)))
"""Combinations of the phases that are looked at: their basis is short already."""


class Split(NamedTuple):
    """Phases by what a sense feels of them."""

    rank: int
    """Directions that are felt."""
    strengths: Float[np.ndarray, "loops"]
    """How much each principal direction is felt, over the most that shuffled senses come to; medians."""
    felt: Float[np.ndarray, "views"] | None
    """The phase that the sense tells, rad; None unless one of two directions is felt."""
    unfelt: Float[np.ndarray, "views"] | None
    """The shortest phase beside it."""


def split_torus(
    codes: Float[np.ndarray, "views components"],
    phases: Float[np.ndarray, "views loops"],
    senses: Float[np.ndarray, "views senses"],
    *,
    seed: int = 0,
) -> Split:
    r"""Find which of two phases a second sense feels, as smell feels place and not heading.

    The sense is regressed on the phases in two halves of each neighbourhood, and the products of both
    Jacobians are pooled there, so that noise cancels: :math:`M = \langle J_1^\top J_2 \rangle`. Directions
    that stand out from those of shuffled senses are felt, and the others are the null space of the Jacobian.
    With one of each the torus is a product of circles: of the phases and their sum and difference, one is
    told best by views that feel alike, and one more makes a basis with it.

    Parameters
    ----------
    codes
        By which views are near each other.
    phases
        rad, as `GeneralisedCoordinates.coordinates_` has them; two.
    senses
        Whatever else was sensed with each view.
    seed
        Shuffles the senses.

    Raises
    ------
    CogmapError
        For arrays that do not fit each other, and for more or fewer than two phases.
    """
    check_array("senses", senses, (len(codes), None))
    if phases.shape[1] != 2:
        raise CogmapError(f"there are {phases.shape[1]} phases; a torus that splits in two has 2")
    near = nearest_points(codes, NEIGHBOURS).indices
    turns = wrap_angle(phases[near] - phases[:, None])
    rng = np.random.default_rng(seed)
    moments = _moments(near, turns, senses)
    chance = max(
        float(
            np.median(np.linalg.eigvalsh(_moments(near, turns, senses[rng.permutation(len(senses))]))[:, 1])
        )
        for _ in range(SHUFFLES)
    )
    strengths = np.median(np.linalg.eigvalsh(moments), axis=0)[::-1] / chance
    rank = int(np.count_nonzero(strengths > FAINT * strengths[0])) if strengths[0] > CHANCE else 0
    if rank != 1:
        return Split(rank, strengths, None, None)
    alike = nearest_points(senses, NEIGHBOURS).indices
    felt = max(_CLASSES, key=lambda m: float(np.abs(np.exp(1j * (phases @ m)[alike]).mean(axis=1)).mean()))
    beside = [m for m in _CLASSES if abs(m[0] * felt[1] - m[1] * felt[0]) == 1]
    unfelt = min(beside, key=lambda m: float(np.square(wrap_angle(turns[:, 0] @ m)).sum()))
    return Split(rank, strengths, wrap_angle(phases @ felt), wrap_angle(phases @ unfelt))


def _moments(
    near: Int[np.ndarray, "views neighbours"],
    turns: Float[np.ndarray, "views neighbours 2"],
    senses: Float[np.ndarray, "views senses"],
) -> Float[np.ndarray, "views 2 2"]:
    """Give ⟨J₁ᵀ J₂⟩ around each view, each J of every other neighbour."""
    changes = senses[near] / senses.std(axis=0)
    halves = []
    for start in (0, 1):
        x, y = turns[:, start::2], changes[:, start::2]
        x, y = x - x.mean(axis=1, keepdims=True), y - y.mean(axis=1, keepdims=True)
        gram = np.einsum("vki,vkj->vij", x, x)
        gram += 1e-3 * np.trace(gram, axis1=1, axis2=2)[:, None, None] * np.eye(2)
        halves.append(np.linalg.solve(gram, np.einsum("vki,vks->vis", x, y)))
    products = np.einsum("vis,vjs->vij", *halves)
    pooled = products[near].mean(axis=1)
    return np.asarray((pooled + pooled.transpose(0, 2, 1)) / 2)
