"""The visual Jacobian (interaction matrix): how what is seen changes by what motors do."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int
from sklearn.neighbors import NearestNeighbors
from sklearn.utils import gen_batches

from cogmap.errors import CogmapError
from cogmap.inputs import check_array

TRANSITIONS = 40
"""Nearest ones that a Jacobian is fitted to."""
BATCH = 512
"""Jacobians fitted together."""
HELD = 0.3
"""Share of the work asked for below which what was seen to be done tells that something held the body."""
RIDGE = 1e-3
"""Of the fit, and a thousandth of it of its inverse, as shares of the mean square along a motor."""

Jacobians = Float[np.ndarray, "queries motors features"]


class VisualJacobian:
    r"""Change of a code of views by the work of each motor, around any view, from transitions near it.

    .. math:: J(c) = \arg\min_J \sum_{t \in N(c)} \lVert c_{t + 1} - c_t - J^\top u_t \rVert^2
        + \lambda \lVert J \rVert^2

    for codes c of views that follow each other, the work u of the motors from one to the next (command times
    how long it held, s), and the 40 transitions that begin nearest to c. It knows neither joints nor links;
    that a motor is weak, turned round or slips is part of it.

    Parameters
    ----------
    codes
        Of views in the order in which they were taken.
    work
        Of the motors from each view to the next, command · s; one row less than there are codes.

    Raises
    ------
    CogmapError
        For codes and work that do not fit, and too few of them.

    References
    ----------
    Jägersand, Fuentes & Nelson (1997), Experimental evaluation of uncalibrated visual servoing for precision
    manipulation.
    """

    def __init__(
        self, codes: Float[np.ndarray, "views features"], work: Float[np.ndarray, "transitions motors"]
    ) -> None:
        check_array("work", work, (len(codes) - 1, None))
        if len(work) < TRANSITIONS:
            raise CogmapError(f"{len(work)} transitions teach no Jacobian; babble at least {TRANSITIONS}")
        self._codes, self._work = codes, work
        self._near = NearestNeighbors(n_neighbors=TRANSITIONS).fit(codes[:-1])
        self.pace_ = float(np.median(np.linalg.norm(work, axis=1)))
        self.held_ = np.zeros(len(work), bool)
        change = np.diff(codes, axis=0)
        done = (implied_work(self.at(codes[:-1]), change) + implied_work(self.at(codes[1:]), change)) / 2
        self.held_ = (done * work).sum(axis=1) < HELD * np.square(work).sum(axis=1)

    @property
    def held_codes(self) -> Float[np.ndarray, "held features"]:
        """Codes of views after which something held the body."""
        return self._codes[:-1][self.held_]

    def near(self, codes: Float[np.ndarray, "queries features"]) -> Int[np.ndarray, "queries transitions"]:
        """Find the transitions that begin nearest to each view."""
        found: np.ndarray = self._near.kneighbors(codes, return_distance=False)
        return found

    def at(self, codes: Float[np.ndarray, "queries features"]) -> Jacobians:
        """Give how each feature changes per command · s of each motor, around views."""
        near = self.near(codes)
        parts = [near[part] for part in gen_batches(len(near), BATCH)]
        return np.concatenate([self._fitted(part, self._work[part], self._codes) for part in parts])

    def bent(
        self, codes: Float[np.ndarray, "queries features"], finer: Float[np.ndarray, "views finer"]
    ) -> Float[np.ndarray, "queries motors finer"]:
        r"""Give how each finer feature of the views changes, around views, where Jacobians turn.

        .. math:: \Delta f_t = (J + \textstyle\sum_m s_{tm} H_m)^\top u_t

        is fitted, s the work that leads from the view to the middle of transition t. Where motors do almost
        the same, as where an arm is stretched, the nearest transitions spread widely along what hardly shows,
        and a Jacobian that is their mean takes a body for arrived that is not.
        """
        near = self.near(codes)
        around = (self._codes[near] + self._codes[near + 1]) / 2 - codes[:, None]
        here = np.repeat(self._fitted(near, self._work[near], self._codes), TRANSITIONS, axis=0)
        apart = implied_work(here, around.reshape(len(here), -1)).reshape(*near.shape, -1)
        work = self._work[near]
        turned = (apart[..., None] * work[..., None, :]).reshape(*near.shape, -1)
        terms = np.concatenate([work, turned], axis=2)
        # to the same size, as work times work is smaller than work by a pace
        size = np.sqrt(np.square(terms).mean(axis=1, keepdims=True)).clip(1e-12)
        fitted: np.ndarray = self._fitted(near, terms / size, finer) / size.swapaxes(1, 2)
        return fitted[:, : work.shape[2]]

    def _fitted(
        self,
        near: Int[np.ndarray, "queries transitions"],
        terms: Float[np.ndarray, "queries transitions terms"],
        features: Float[np.ndarray, "views features"],
    ) -> Float[np.ndarray, "queries terms features"]:
        """Regress the changes of features in transitions on what was done in them."""
        # what a held motor should have done tells nothing
        counted = np.swapaxes(np.where(self.held_[near][..., None], 0, terms), 1, 2)
        change = features[near + 1] - features[near]
        found: np.ndarray = np.linalg.solve(_ridged(counted @ terms, RIDGE), counted @ change)
        return found


def implied_work(
    jacobians: Jacobians, change: Float[np.ndarray, "queries features"]
) -> Float[np.ndarray, "queries motors"]:
    """Give the work of motors (command · s) that changes what is seen most nearly so: J⁺ Δc."""
    gram = np.einsum("vmf,vnf->vmn", jacobians, jacobians)
    asked = np.einsum("vmf,vf->vm", jacobians, change)
    found: np.ndarray = np.linalg.solve(_ridged(gram, 1e-3 * RIDGE), asked[..., None])[..., 0]
    return found


def _ridged(gram: np.ndarray, ridge: float) -> np.ndarray:
    motors = gram.shape[1]
    scale = np.trace(gram, axis1=1, axis2=2) / motors
    ridged: np.ndarray = gram + (ridge * scale)[:, None, None] * np.eye(motors)
    return ridged
