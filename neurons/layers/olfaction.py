"""Olfaction, what each chart knows of smell: an affine map from chart coordinates to log odour."""

import torch
from jaxtyping import Float, Int
from torch import Tensor, nn


class Olfaction(nn.Module):
    """Per chart, the regression of log odour on f = [1, U_k (z − C_k)], kept as sums.

    Each view adds h f fᵀ and h f oᵀ to the charts it excites; `solve` gives the intercepts a_k and Jacobians
    J_k. Sums can be added to by a stream and merged between maps grown from the same charts; in double
    precision, so that it hardly matters in which order.

    Parameters
    ----------
    charts, odorants, tangents
        Sizes.
    ridge
        Prior on the slopes, as a fraction of the variance of the coordinates: a chart whose views lie on a
        line has no slope across it.
    """

    def __init__(self, charts: int, odorants: int, tangents: int, *, ridge: float = 1e-3) -> None:
        super().__init__()
        self.ridge = ridge
        # sums of thousands of views, whose small differences are the slopes: seven digits are few
        self.gram: Tensor = nn.Buffer(torch.zeros(charts, tangents + 1, tangents + 1, dtype=torch.double))
        self.cross: Tensor = nn.Buffer(torch.zeros(charts, tangents + 1, odorants, dtype=torch.double))

    def partial_fit(
        self,
        chart: Int[Tensor, "views winners"],
        weight: Float[Tensor, "views winners"],
        coordinates: Float[Tensor, "views winners d"],
        log_odour: Float[Tensor, "views odorants"],
    ) -> None:
        """Add a batch of views to the charts they excite with the given weights."""
        f = torch.cat([torch.ones_like(weight)[:, :, None], coordinates], dim=2)
        weighted = weight[:, :, None] * f
        gram = (weighted[:, :, :, None] * f[:, :, None]).flatten(0, 1)
        cross = (weighted[:, :, :, None] * log_odour[:, None, None]).flatten(0, 1)
        # products in float32, sums in double: only the rounding of sums adds up
        self.gram.index_add_(0, chart.flatten(), gram.double())
        self.cross.index_add_(0, chart.flatten(), cross.double())

    def carry(self, change: Float[Tensor, "charts f f"]) -> None:
        """Take the sums along with charts that have moved: f becomes `change` f (`Charts.since`)."""
        self.gram.copy_(change @ self.gram @ change.mT)
        self.cross.copy_(change @ self.cross)

    def solve(self) -> tuple[Float[Tensor, "charts odorants"], Float[Tensor, "charts d odorants"]]:
        """Give intercepts (log concentration at the centre) and Jacobians (per unit of chart coordinate)."""
        # of the chart's own sums: a prior that weighs alike after any number of views
        slopes = torch.diagonal(self.gram, dim1=1, dim2=2)[:, 1:].mean(dim=1)
        prior = torch.zeros_like(self.gram)
        for d in range(1, prior.shape[1]):
            # a chart that no view excited has nothing but the 1e-9, and smells of nothing
            prior[:, d, d] = self.ridge * slopes + 1e-9
        # the intercept is not drawn to 0: log concentration has no natural zero
        prior[:, 0, 0] = 1e-9
        solution = torch.linalg.solve(self.gram + prior, self.cross).float()
        return solution[:, 0], solution[:, 1:]
