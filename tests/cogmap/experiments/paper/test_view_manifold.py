import numpy as np
import pytest

from arena import Arena, Camera, Rotation
from cogmap.experiments import Conditions
from cogmap.experiments.paper.view_manifold import ViewManifold, view_manifold


@pytest.fixture(scope="module")
def spin(few_words: None) -> tuple[ViewManifold, np.ndarray]:  # noqa: ARG001
    conditions = Conditions(Arena.load("furnished"), 500)
    walk = conditions.explore(Rotation(), Camera.perspective(160, 120))
    return view_manifold(walk.views, conditions), walk.require("poses")


def test_a_spin_is_a_ring_with_one_degree_of_freedom(spin: tuple[ViewManifold, np.ndarray]) -> None:
    found, poses = spin
    metrics = found.metrics(poses)
    assert metrics["betti"] == [1, 1, 0]
    assert metrics["betti_margin"] > 1.5
    assert metrics["betti_rejected"] < 1
    assert round(metrics["dimension"]) == 1
    assert metrics["heading_resultant"] > 0.99
    assert metrics["loop_error_median_deg"] < 5


def test_its_table_holds_every_view(spin: tuple[ViewManifold, np.ndarray]) -> None:
    found, poses = spin
    table = found.table(poses)
    assert len(table) == len(poses)
    assert sum(name.startswith("coordinate_") for name in table) == 10
    turn = np.angle(np.exp(1j * (table["loop_rad"] - table["heading_rad"])))
    np.testing.assert_allclose(
        np.rad2deg(np.median(np.abs(turn))), found.metrics(poses)["loop_error_median_deg"], rtol=1e-6
    )


def test_views_outside_the_largest_piece_have_no_phase(spin: tuple[ViewManifold, np.ndarray]) -> None:
    found, poses = spin
    phase = found.phase.copy()
    phase[:40] = np.nan
    table = found._replace(phase=phase).table(poses)
    assert table["loop_rad"].isna().sum() == 40
    assert np.isfinite(found._replace(phase=phase).metrics(poses)["heading_resultant"])
