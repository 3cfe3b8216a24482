"""The connection: what walking turns a compass by where little is seen, learnt until loops close."""

from dataclasses import dataclass, replace

import numpy as np
import torch
from jaxtyping import Float
from scipy.special import softmax
from torch import Tensor

from neurons.atlas.atlas import Atlas
from neurons.atlas.synchronisation import Compass, Overlaps


@dataclass(frozen=True)
class LearntConnection:
    """Synchronisation with a connection that is learnt.

    Where little is seen, walking moves a view along the heading axis too, and what it adds around a loop does
    not cancel. Walking changes the smell, so the turning of a chart is taken to be

        t_k = c n_k + G_k B(a_k),        ω_kj = ½ (C_j − C_k)·(t_k + t_j),

    G_k = U_kᵀ J_k the gradient of log odour in code, B(a) = Σ_p w_p(a) b_p on a few soft places in odour
    space. In turn b is fitted to wrap(φ_j − φ_k − ω_kj), by ridge regression, and the phases φ are
    synchronised anew, overlaps with residual r weighing 1 / (1 + (r / 3 median)²). The scale c is that of the
    compass and stays: were it free, c = 0 and a B of nothing but noise would agree perfectly.

    Parameters
    ----------
    places
        Soft places: few, as the connection varies slowly over a room.
    rounds
        Fits and synchronisations, in turn.
    ridge
        Prior on b, as a fraction of the mean square of a feature.

    References
    ----------
    Singer & Wu (2012), Vector diffusion maps and the connection Laplacian. CPAM 65.
    """

    places: int = 24
    rounds: int = 12
    ridge: float = 1e-3

    def refine(
        self,
        plain: Compass,
        centres: Float[Tensor, "charts components"],
        gradients: Float[Tensor, "charts components odorants"],
        smells: Float[Tensor, "charts odorants"],
        atlas: Atlas,
    ) -> Compass:
        """Give the compass that a connection makes of a plain one.

        Its agreement is told of all overlaps alike: weights that forgive what does not fit would make any
        compass agree.
        """
        edges = atlas.edges.cpu().numpy()
        k, j = edges.T
        odour = smells.double().cpu().numpy()
        centre, gradient = centres.double().cpu().numpy(), gradients.double().cpu().numpy()
        share = self._shares(odour)
        across = centre[j] - centre[k]
        # by how much smell changes across an overlap, as told from either end, shared out among places
        ends = (
            np.einsum("ec,eco->eo", across, gradient[end])[:, None] * share[end][..., None] for end in (k, j)
        )
        features = 0.5 * sum(ends).reshape(len(edges), -1)
        b, phases, eigenvalue = self._fit(plain, across, features, Overlaps(edges, len(odour)))
        walking = np.einsum("kco,ko->kc", gradient, share @ b.reshape(self.places, -1))
        return replace(
            plain,
            phases=torch.from_numpy(phases).to(plain.axes),
            eigenvalue=eigenvalue,
            walking=torch.from_numpy(walking).to(plain.axes),
        )

    def _shares(self, odour: Float[np.ndarray, "charts odorants"]) -> Float[np.ndarray, "charts places"]:
        """Share every chart out among the soft places."""
        # charts are born in random order: so many of them lie anywhere, the same ones every time
        middles = odour[np.linspace(0, len(odour) - 1, self.places).astype(int)]
        squared = np.square(odour[:, None] - middles).sum(axis=2)
        between = np.square(middles[:, None] - middles).sum(axis=2)
        exponent = -0.5 * squared / np.sort(between, axis=1)[:, 1].mean()
        # softmax takes the largest exponent away: far from all places shares would else be 0 / 0
        share: np.ndarray = softmax(exponent, axis=1)
        return share

    def _fit(
        self,
        plain: Compass,
        across: Float[np.ndarray, "edges components"],
        features: Float[np.ndarray, "edges features"],
        overlaps: Overlaps,
    ) -> tuple[Float[np.ndarray, "features"], Float[np.ndarray, "charts"], float]:
        """Learn b; give it, the phases, and their eigenvalue over all overlaps alike."""
        k, j = overlaps.edges.T
        n, phases = plain.axes.double().cpu().numpy(), plain.phases.double().cpu().numpy()
        turning = 0.5 * plain.scale * np.einsum("ec,ec->e", across, n[k] + n[j])
        b = np.zeros(features.shape[1])
        for _ in range(self.rounds):
            left = np.angle(np.exp(1j * (phases[j] - phases[k] - turning - features @ b)))
            strength = 1 / (1 + (left / (3 * np.median(np.abs(left)))) ** 2)
            weighted = features * strength[:, None]
            gram = weighted.T @ features
            gram += self.ridge * gram.diagonal().mean() * np.eye(len(gram))
            b = np.linalg.solve(gram, weighted.T @ (left + features @ b))
            step = np.exp(-1j * (turning + features @ b))
            phases = np.angle(overlaps.top(step, strength)[1])
        eigenvalue, vector = overlaps.top(step)
        return b, np.angle(vector), eigenvalue
