import numpy as np

from cogmap import Activity
from cogmap.evaluation.homology_of_map import homologies


def test_ideal_populations_have_the_shape_of_what_they_code() -> None:
    rng = np.random.default_rng(0)
    xy, heading = rng.uniform(-1, 1, (4000, 2)), rng.uniform(-np.pi, np.pi, 4000)
    centres = rng.uniform(-1.2, 1.2, (80, 2))
    preferred = np.linspace(-np.pi, np.pi, 30, endpoint=False)
    activity = Activity(
        place=20 * np.exp(-((xy[:, None] - centres) ** 2).sum(axis=2) / 0.18),
        heading=20 * np.exp(4 * np.cos(heading[:, None] - preferred) - 4),
        phase=heading,
        odour=xy,
        position=xy,
    )
    codes = np.column_stack([xy, 0.8 * np.cos(heading), 0.8 * np.sin(heading)])
    found = homologies(codes, activity, landmarks=(150, 80), draws=2)
    assert {name: bars.numbers for name, bars in found.items()} == {
        "view_manifold": (1, 1, 0),
        "fused": (1, 1, 0),
        "place": (1, 0, 0),
        "heading": (1, 1, 0),
    }
    assert {bars.draws for bars in found.values()} == {2}
