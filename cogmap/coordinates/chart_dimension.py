"""The dimension of a manifold as charts tell it: Hebbian neurons that know the tangents of what they win."""

from __future__ import annotations

import numpy as np
import torch
from jaxtyping import Float

from cogmap.errors import CogmapError
from cogmap.inputs import check_array, checked_count
from cogmap.shape.dimension import LocalDimension
from cogmap.threads import one_thread
from neurons.layers.charts import Charts
from neurons.layers.dimension import dimension_votes
from neurons.stages import ChartStage

BATCH = 256
"""Views learnt together; fixed, so that the same seed gives the same charts."""
VIEWS_PER_CHART = 12
"""Of an epoch: a chart of fewer knows noise for tangents, one of many more is curved."""


def chart_dimension(
    codes: Float[np.ndarray, "views components"], *, charts: int | None = None, seed: int = 0
) -> LocalDimension:
    """Find the dimension of the manifold that codes lie on, by charts that compete for them by sight alone.

    As in the critical period of a map's charts (`neurons.stages.ChartStage`), each learns tangents by
    Sanger's rule, and tells how many of them lie along the manifold by the modal gap of their variances.
    Where views are so dense that noise is wider than a chart it tells too many: `local_dimension` of an even
    memory is surer.

    Parameters
    ----------
    codes
        Of views, two dozen at least.
    charts
        How many, one for a dozen views unless told.
    seed
        Of initial tangents and the order of views.

    Raises
    ------
    CogmapError
        For codes that are not finite numbers or all the same, and for fewer of them than charts.
    """
    check_array("codes", codes, (None, None))
    count = checked_count("charts", len(codes) // VIEWS_PER_CHART if charts is None else charts)
    if len(codes) < count:
        raise CogmapError(f"there are {len(codes)} codes for {count} charts; give more, or use fewer charts")
    stage, order = ChartStage(), np.random.default_rng(seed)
    rows, nothing = torch.from_numpy(np.asarray(codes, np.float32)), torch.zeros(BATCH, 1)
    with one_thread():
        layer = Charts(count, rows.shape[1], 1, generator=torch.Generator().manual_seed(seed), smell=0.0)
        seen = 0
        while seen < stage.epochs * len(rows):
            for batch in torch.from_numpy(order.permutation(len(rows))).split(BATCH):
                seen += len(batch)
                progress = seen / (stage.epochs * len(rows))
                if progress > stage.widened:
                    layer.widen()
                winners, window = stage.winners_at(progress), float(len(rows))
                layer.partial_fit(rows[batch], nothing[: len(batch)], winners=winners, window=window)
        spectra = layer.spectra
    if not len(spectra):
        raise CogmapError("all codes are the same; give those of views that differ")
    votes, spectrum = dimension_votes(spectra).numpy(), spectra.quantile(0.5, dim=0).numpy()
    return LocalDimension(int(votes.argmax()) + 1, float(votes.max()), spectrum)
