"""Principal axes of what turning leaves alone in panoramas."""

import numpy as np
from jaxtyping import Float32
from sklearn.decomposition import PCA

from cogmap.errors import CogmapError

SAMPLE = 4000
"""Views that are enough for principal components; of more, so many evenly spread ones are taken."""


def turn_invariant_axes(turn_invariant: Float32[np.ndarray, "views features"], components: int) -> PCA:
    """Find the principal axes of magnitudes that no turn changes (`strips`), fewer when there are fewer.

    Raises
    ------
    CogmapError
        For views that are all alike.
    """
    if not np.ptp(turn_invariant, axis=0).any():
        raise CogmapError(f"{len(turn_invariant)} panoramas are all alike; explore more than one place")
    sample = turn_invariant[:: -(-len(turn_invariant) // SAMPLE)]
    return PCA(min(components, *sample.shape), svd_solver="covariance_eigh").fit(sample)
