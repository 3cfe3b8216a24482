"""The shape of everything that a map knows: its views, its fusion, its two populations."""

import numpy as np
from joblib import Parallel, delayed
from jaxtyping import Float

from cogmap.activity import Activity
from cogmap.manifold.homology import Betti, betti

JOBS = 2


def homologies(
    codes: Float[np.ndarray, "views components"], activity: Activity, *, seed: int = 0
) -> dict[str, Betti]:
    """Betti numbers of the view manifold, the fused map and both populations.

    The fused map is (recalled log odour, cos φ, sin φ). Computed side by side in `JOBS` processes.
    """
    clouds = {
        "view_manifold": codes,
        "fused": np.column_stack([activity.odour, np.cos(activity.phase), np.sin(activity.phase)]),
        "place": activity.place,
        "heading": activity.heading,
    }
    found = Parallel(n_jobs=JOBS)(delayed(betti)(cloud, seed=seed) for cloud in clouds.values())
    return dict(zip(clouds, found, strict=True))
