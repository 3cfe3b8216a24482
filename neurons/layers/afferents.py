"""Afferent weights from charts to cells, learnt while the cells are instructed to fire."""

import torch
from jaxtyping import Float
from torch import Tensor, nn

from neurons.layers.charts import rows_of
from neurons.layers.readout import ChartActivity


class Afferents(nn.Module):
    """Hebbian association of chart activity a_k with instructed rates r_i, kept as sums.

    The weight is the mean rate while the chart was active, W_ki = Σ a_k r_i / Σ a_k, the fixed point of the
    presynaptically gated rule ΔW_ki = η a_k (r_i − W_ki). Afterwards a cell fires from sight alone,
    r_i = Σ_k a_k W_ki.

    References
    ----------
    Grossberg (1976), Adaptive pattern classification and universal recoding I. Biological Cybernetics 23
    (outstar rule).
    """

    def __init__(self, charts: int, cells: int) -> None:
        super().__init__()
        # float32 will do: a sum of like terms stands still only after some 2^24 of them
        self.association: Tensor = nn.Buffer(torch.zeros(charts, cells))
        self.activity: Tensor = nn.Buffer(torch.zeros(charts))

    @property
    def weights(self) -> Float[Tensor, "charts cells"]:
        """W in Hz; zero for charts that were never active."""
        # 0 / 1e-12 is 0 where 0 / 0 would be NaN; a chart that was hardly active is taken for silent
        return self.association / self.activity.clamp(min=1e-12)[:, None]

    def partial_fit(self, excited: ChartActivity, rates: Float[Tensor, "views cells"]) -> None:
        """Associate a batch of views with the rates (Hz) that an instructor demands."""
        chart, weight = excited
        self.activity.index_add_(0, chart.flatten(), weight.flatten())
        # sums, not a running mean: what maps have learnt apart can be added up
        pairs = (weight[:, :, None] * rates[:, None]).flatten(0, 1)
        self.association.index_add_(0, chart.flatten(), pairs)

    def forward(self, excited: ChartActivity) -> Float[Tensor, "views cells"]:
        """Rates in Hz from chart activity alone."""
        chart, weight = excited
        # the few active rows are divided, not the whole matrix of weights
        norm = self.activity.clamp(min=1e-12)[chart]
        return torch.einsum("nw,nwc->nc", weight / norm, rows_of(self.association, chart))
