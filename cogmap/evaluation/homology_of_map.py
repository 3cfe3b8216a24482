"""Homology of everything that a map knows: its views, its fusion, its two populations."""

import numpy as np
from jaxtyping import Float

from cogmap.map.activity import Activity
from cogmap.shape.homology import Betti, betti


def homologies(
    codes: Float[np.ndarray, "views components"],
    activity: Activity,
    *,
    landmarks: tuple[int, int] = (400, 150),
    draws: int = 3,
    seed: int = 0,
) -> dict[str, Betti]:
    """Betti numbers of the view manifold, the fused map and both populations.

    The view manifold is the codes, the fused map (recalled log odour, cos φ, sin φ), a population the square
    roots of its rates, whose Poisson noise is the same at every rate. What a map without a compass does not
    know, because it is NaN, is left out.

    References
    ----------
    Bartlett (1936), The square root transformation in analysis of variance. J. R. Stat. Soc. Suppl. 3.
    """
    clouds = {
        "view_manifold": codes,
        "fused": np.column_stack([activity.odour, np.cos(activity.phase), np.sin(activity.phase)]),
        "place": np.sqrt(activity.place),
        "heading": np.sqrt(activity.heading),
    }
    clouds = {name: cloud for name, cloud in clouds.items() if np.isfinite(cloud).all()}
    return {name: betti(cloud, landmarks=landmarks, draws=draws, seed=seed) for name, cloud in clouds.items()}
