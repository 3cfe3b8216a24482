"""The pose graph: places and headings on which neighbours, and the steps of a walk, agree."""

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Complex128, Float, Int
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse.linalg import LinearOperator, cg

from arena.angles import wrap_angle
from cogmap.graph.neighbour_graph import edge_differences

STRAIGHT = 0.2
"""Largest turn (rad) of a step whose direction is taken for that in which the body looks."""
WALKS = 0.5
"""Mean cosine between steps and headings from which on the views come in the order of a walk."""
LEVEL = 2000.0
"""How much a heading counts that its neighbours contradict, beside a step of the same angle."""
LENGTH = 0.1
"""How much the length of a step counts beside its direction: bodies keep to a direction, not to a pace."""
ROUNDS = 3
"""Of weights that count outliers less."""
FEW = 200
"""Places that bend with the whole map."""
MOST_ITERATIONS = 60
"""Of conjugate gradients in a round; what is left then is a bend of the whole map below a millimetre."""


class PoseGraph(NamedTuple):
    """Where views were taken and where the body looked, in one frame."""

    places: Complex128[np.ndarray, "views"]
    """x + iy."""
    headings: Float[np.ndarray, "views"]
    """rad."""


def relax_walk(start: PoseGraph, affine: sp.csr_array) -> PoseGraph:
    r"""Relax the poses of a walk: neighbours lie as their views say, and a body goes where it looks.

    With W the affine weights of each view's neighbours, ℓ the usual step and f what is added to the headings
    θ, it takes the places z and the f of least

    .. math:: \sum_t \left(\kappa_t\,\mathrm{Im}(s_t)^2 + \kappa'_t\,(\mathrm{Re}(s_t) - 1)^2\right)
              + \lVert z - W z \rVert^2 / \ell^2 + \lambda \lVert f - W f \rVert^2,
              \qquad s_t = e^{-i(\bar\theta_t + \bar f_t)} (z_{t+1} - z_t) / \ell,

    over the steps t in which the body turned little, bars being means over their two ends. Places alone could
    bend with the headings, as a conformal map does; that all steps are about as long forbids it. Steps aside,
    backwards or too long count less (Cauchy weights): a slide along a wall, a slip, another walk that begins.

    Parameters
    ----------
    start
        Poses to begin with, of all views in the order of the walk; headings good between near views.
    affine
        W, (views, views), rows sum to one.

    Returns
    -------
    PoseGraph
        The poses; those it began with where fewer than two in three steps lead where the body looks, as among
        shuffled views.

    References
    ----------
    Grisetti, Kümmerle, Stachniss & Burgard (2010), A tutorial on graph-based SLAM.
    Roweis & Saul (2000), Nonlinear dimensionality reduction by locally linear embedding.
    """
    turned = wrap_angle(np.diff(start.headings))
    first = np.flatnonzero(np.abs(turned) < STRAIGHT)
    steps = _Steps(first, start.headings[first] + 0.5 * turned[first], len(start.places))
    if not steps.follow(start.places):
        return start
    bend = sp.csr_array(sp.eye_array(len(start.places)) - affine)
    places, added, wide = start.places, np.zeros(len(start.places)), _spread(start.places)
    for _ in range(ROUNDS):
        places, added = _round(steps, bend, wide, places, added)
    return PoseGraph(places, wrap_angle(start.headings + added))


class _Steps:
    """Steps of a walk in which the body turned little, and the matrices of their ends."""

    def __init__(
        self, first: Int[np.ndarray, "steps"], headings: Float[np.ndarray, "steps"], views: int
    ) -> None:
        self.headings = headings
        self.differences = edge_differences(first, first + 1, views)
        self.means = sp.csr_array(0.5 * abs(self.differences))

    def follow(self, places: Complex128[np.ndarray, "views"]) -> bool:
        """Tell whether the body goes where it looks."""
        along = np.exp(-1j * self.headings) * (self.differences @ places)
        gone = np.abs(along)
        return bool(len(gone) and (along.real[gone > 0] / gone[gone > 0]).mean() > WALKS)


def _round(
    steps: _Steps,
    bend: sp.csr_array,
    wide: Float[np.ndarray, "views few"],
    places: Complex128[np.ndarray, "views"],
    added: Float[np.ndarray, "views"],
) -> tuple[Complex128[np.ndarray, "views"], Float[np.ndarray, "views"]]:
    """Solve for places and headings at once, linearised, with the weights that the present ones give."""
    views, differences, means = len(places), steps.differences, steps.means
    ahead = np.exp(1j * (steps.headings + means @ added))
    step = ahead.conj() * (differences @ places)
    length = float(np.median(step.real))
    step /= length  # from here on in steps, as the places are in `solve`
    aside, long = np.abs(step.imag), np.abs(step.real - 1)
    counted = _cauchy(aside) * (step.real > 0.2)
    paced = LENGTH * _cauchy(long)
    back, forth, bend_back = (sp.csr_array(part.T) for part in (differences, means, bend))

    def gradient(
        moved: Float[np.ndarray, "views 3"],
        along: Float[np.ndarray, "steps"],
        across: Float[np.ndarray, "steps"],
    ) -> Float[np.ndarray, "views 3"]:
        pull = ahead * (paced * along + 1j * counted * across)
        slope = bend_back @ (bend @ moved)
        slope[:, 2] *= LEVEL
        slope[:, :2] += back @ np.column_stack([pull.real, pull.imag])
        slope[:, 2] -= forth @ (counted * step.real * across)
        return np.asarray(slope)

    def normal(flat: Float[np.ndarray, "_"]) -> Float[np.ndarray, "_"]:
        moved = flat.reshape(views, 3)
        change = ahead.conj() * (differences @ (moved[:, 0] + 1j * moved[:, 1]))
        across = change.imag - step.real * (means @ moved[:, 2])
        # a trace of ridge: nothing else holds a place without steps in its plane
        return (gradient(moved, change.real, across) + 1e-8 * moved).ravel()

    now = np.column_stack([places.real / length, places.imag / length, added])
    downhill = -gradient(now, step.real - 1, step.imag).ravel()
    stiff = np.asarray(bend.power(2).sum(axis=0))
    held = stiff + back.power(2) @ (0.5 * (paced + counted))
    scale = np.column_stack([held, held, LEVEL * stiff + forth.power(2) @ counted])
    # What bends the whole map is hardly seen from view to view, and is solved for a few places beforehand.
    edges, ends, bent = (part @ wide for part in (differences, step.real[:, None] * means, bend))
    turns, still = (ahead.real[:, None], ahead.imag[:, None]), np.zeros_like(edges)
    along = np.hstack([turns[0] * edges, turns[1] * edges, still])
    across = np.hstack([-turns[1] * edges, turns[0] * edges, -ends])
    coarse = along.T @ (paced[:, None] * along) + across.T @ (counted[:, None] * across)
    coarse += np.kron(np.diag([1.0, 1.0, LEVEL]), bent.T @ bent) + 1e-8 * np.eye(len(coarse))
    factor = cho_factor(coarse)

    def precondition(flat: Float[np.ndarray, "_"]) -> Float[np.ndarray, "_"]:
        slope = flat.reshape(views, 3)
        few = cho_solve(factor, (wide.T @ slope).T.ravel()).reshape(3, -1).T
        return np.asarray((slope / scale + wide @ few).ravel())

    shape = (3 * views, 3 * views)
    system, inverse = (LinearOperator(shape, matvec=each, dtype=float) for each in (normal, precondition))
    found = cg(system, downhill, rtol=1e-4, maxiter=MOST_ITERATIONS, M=inverse)[0]
    right, up, turned = found.reshape(views, 3).T
    return places + length * (right + 1j * up), added + turned


def _spread(places: Complex128[np.ndarray, "views"]) -> Float[np.ndarray, "views few"]:
    """Share views among a few places that are far apart, smoothly; rows sum to one."""
    nearest, chosen = np.abs(places - places[0]), [0]
    while len(chosen) < min(FEW, len(places)):
        chosen.append(int(nearest.argmax()))
        nearest = np.minimum(nearest, np.abs(places - places[chosen[-1]]))
    width = max(float(nearest.max()), 1e-12)
    distances = np.abs(places[:, None] - places[chosen])
    # nearest first, so that a view far from all still belongs to one
    shares = np.exp(-0.5 * (np.square(distances) - np.square(nearest)[:, None]) / width**2)
    return np.asarray(shares / shares.sum(axis=1, keepdims=True))


def _cauchy(residuals: Float[np.ndarray, "steps"]) -> Float[np.ndarray, "steps"]:
    """Weigh residuals, the less the farther they are beyond the usual one."""
    usual = 1.5 * np.median(residuals) + 1e-12
    return np.asarray(1 / (1 + np.square(residuals / usual)))
