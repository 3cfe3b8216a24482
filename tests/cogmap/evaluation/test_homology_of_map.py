import numpy as np
import pytest

from cogmap import Activity
from cogmap.evaluation import homology_of_map
from cogmap.evaluation.homology_of_map import SMELL, homologies, seen_and_smelt
from cogmap.graph import nearest_points
from tests.cogmap.shape.numbers import betti_of


def test_smell_counts_by_its_noise_whatever_the_order() -> None:
    rng = np.random.default_rng(0)
    codes = rng.uniform(size=(900, 3))
    smells = rng.normal(codes[:, :2], 0.2)
    joint = seen_and_smelt(codes, smells)
    np.testing.assert_array_equal(joint[:, :3], codes)
    radius = np.median(nearest_points(codes, 15).distances[:, -1])
    np.testing.assert_allclose(joint[:, 3:] / smells, SMELL * radius / 0.2, rtol=0.1)
    order = rng.permutation(900)
    np.testing.assert_allclose(seen_and_smelt(codes[order], smells[order]), joint[order], rtol=1e-9)


@pytest.mark.parametrize(
    ("fused", "joint", "aliased"),
    [
        ((1, 1, 0), (1, 1, 0), set()),
        ((1, 2, 1), (1, 2, 1), {"view_manifold", "place"}),
        # what the fused map counts otherwise is not sure of both senses either
        ((1, 2, 1), (1, 1, 0), {"view_manifold", "fused", "place", "seen_and_smelt"}),
        ((1, 2, 1), None, set()),
    ],
)
def test_clouds_that_sight_makes_are_judged_by_both_senses(
    fused: tuple[int, ...],
    joint: tuple[int, ...] | None,
    aliased: set[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # In the order of the clouds.
    told = iter([(1, 1, 0), fused, (1, 0, 0), (1, 1, 0), joint])
    monkeypatch.setattr(homology_of_map, "betti", lambda *_, **__: betti_of(next(told)))
    activity = Activity(
        place=np.ones((40, 3)),
        heading=np.ones((40, 3)),
        phase=np.ones(40),
        odour=np.ones((40, 2)),
        position=np.ones((40, 2)),
    )
    rng = np.random.default_rng(1)
    found = homologies(
        rng.normal(size=(40, 2)), activity, None if joint is None else rng.normal(size=(40, 2))
    )
    assert ("seen_and_smelt" in found) == (joint is not None)
    assert {name for name, cloud in found.items() if not all(cloud.resolved)} == aliased


def test_voids_of_a_map_are_resolved_only_where_its_loops_are(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(homology_of_map, "betti", lambda *_, **__: betti_of((1, 1, 0), ("", "close", "")))
    blind = np.full(40, np.nan)
    activity = Activity(np.ones((40, 3)), np.ones((40, 3)), blind, np.ones((40, 2)), np.ones((40, 2)))
    found = homologies(np.ones((40, 2)), activity)
    assert "fused" not in found
    assert {cloud.resolved for cloud in found.values()} == {(True, False, False)}


def test_ideal_populations_have_the_shape_of_what_they_code() -> None:
    rng = np.random.default_rng(0)
    xy, heading = rng.uniform(-1, 1, (3000, 2)), rng.uniform(-np.pi, np.pi, 3000)
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
    smells = rng.normal(xy, 0.05)
    found = homologies(codes, activity, smells, landmarks=(150, 80), draws=1)
    assert {name: bars.numbers for name, bars in found.items()} == {
        "view_manifold": (1, 1, 0),
        "seen_and_smelt": (1, 1, 0),
        "fused": (1, 1, 0),
        "place": (1, 0, 0),
        "heading": (1, 1, 0),
    }
    assert {bars.draws for bars in found.values()} == {1}
