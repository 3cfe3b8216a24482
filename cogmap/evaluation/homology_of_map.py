"""Homology of everything that a map knows: its views, its fusion, its two populations."""

import numpy as np
from jaxtyping import Float

from cogmap.graph import nearest_points
from cogmap.map.activity import Activity
from cogmap.shape.agreement import unless_aliased, unless_contradicted, unless_lower_is_unresolved
from cogmap.shape.homology import Betti, betti

SMELL = 0.2
"""Radii of a neighbourhood of codes that one σ of the nose counts: at .1 places that look alike are still
joined in a room of four equal walls and one card."""
NEAREST = 15
"""Codes of a neighbourhood, as many as `betti` joins, in which a smell is expected to be the same."""


def homologies(
    codes: Float[np.ndarray, "views components"],
    activity: Activity,
    smells: Float[np.ndarray, "views odorants"] | None = None,
    *,
    landmarks: tuple[int, int] = (400, 150),
    draws: int = 3,
    seed: int = 0,
) -> dict[str, Betti]:
    """Betti numbers of the view manifold, with smell beside it, of the fused map and both populations.

    The view manifold is the codes, the fused map (recalled log odour, cos φ, sin φ), a population the square
    roots of its rates, whose Poisson noise is the same at every rate. What a map without a compass does not
    know, because it is NaN, is left out.

    Places that look alike are one to sight, and no look at its codes can tell (`betti`). So where `smells`
    are given, log odours as the nose smelt them, what sight and smell tell together (`seen_and_smelt`) is a
    cloud of its own, and numbers are resolved only where they agree with its: those of the view manifold and
    of the fused map as they are, those of place cells times the circle of headings (Künneth). Its own are
    resolved where the fused map counts as many: where little is seen codes bulge between near walls, and the
    fused map, in which nothing does, tells a loop that is none.

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
    if smells is not None:
        clouds["seen_and_smelt"] = seen_and_smelt(codes, smells)
    clouds = {name: cloud for name, cloud in clouds.items() if np.isfinite(cloud).all()}
    found = {
        name: betti(cloud, landmarks=landmarks, draws=draws, seed=seed) for name, cloud in clouds.items()
    }
    if smells is not None:
        both = found["seen_and_smelt"]
        if "fused" in found:
            both = found["seen_and_smelt"] = unless_contradicted(both, found["fused"], "the fused map")
        for name in found.keys() & {"view_manifold", "fused", "place"}:
            found[name] = unless_aliased(found[name], both, turning=name == "place")
    return {name: unless_lower_is_unresolved(cloud) for name, cloud in found.items()}


def seen_and_smelt(
    codes: Float[np.ndarray, "views components"], smells: Float[np.ndarray, "views odorants"]
) -> Float[np.ndarray, "views features"]:
    """Put smell beside sight, [z, λ o] with λ = `SMELL` × radius of a neighbourhood of codes / nose's noise.

    What smells otherwise by more than the nose errs is then no longer among the neighbours, in a manifold of
    any dimension. The noise is taken from smells among the nearest codes, so that the order of views does not
    matter.
    """
    nearest = nearest_points(codes, NEAREST)
    residual = smells - smells[nearest.indices].mean(axis=1)
    # The deviation of a normal variable over the median of its size; the mean of the others has noise too.
    noise = 1.4826 * np.median(abs(residual)) / np.sqrt(1 + 1 / NEAREST)
    return np.hstack([codes, SMELL * np.median(nearest.distances[:, -1]) / noise * smells])
