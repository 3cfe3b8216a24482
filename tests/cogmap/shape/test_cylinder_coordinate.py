import numpy as np
import pytest
import scipy.sparse as sp

from cogmap.errors import CogmapError, SeparatePiecesWarning
from cogmap.shape.circular import circular_coordinate
from cogmap.shape.cylinder_coordinate import height_coordinate
from cogmap.shape.isomap import LandmarkIsomap


def cylinder(n: int, rng: np.random.Generator, shear: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    angle, height = rng.uniform(-np.pi, np.pi, n), rng.uniform(0, 3, n)
    along = height + shear * np.cos(angle)
    X = np.column_stack([np.cos(angle), np.sin(angle), along]) + rng.normal(scale=0.02, size=(n, 3))
    return X, height


def measure(X: np.ndarray) -> np.ndarray:
    model = LandmarkIsomap(4).fit(X)
    return height_coordinate(model.graph_, model.embedding_, circular_coordinate(model.graph_).phase)


def explained(height: np.ndarray, truth: np.ndarray) -> float:
    return float(np.corrcoef(height, truth)[0, 1] ** 2)


@pytest.mark.parametrize("seed", range(3))
def test_height_of_a_cylinder(seed: int) -> None:
    X, truth = cylinder(2000, np.random.default_rng(seed))
    height = measure(X)
    assert explained(height, truth) > 0.97
    assert height.min() == 0
    assert height.max() == 1
    assert np.mean((height == 0) | (height == 1)) == pytest.approx(0.16, abs=0.03)


def test_ends_straighten_what_is_sheared() -> None:
    X, truth = cylinder(2500, np.random.default_rng(3), shear=0.6)
    assert explained(X[:, 2], truth) < 0.85
    assert explained(measure(X), truth) > 0.95


def test_potential_of_a_path() -> None:
    # On a path between its ends the harmonic function is even; 80 points so that every slice holds them all.
    ends = np.arange(79)
    graph = sp.csr_array((np.ones(79), (ends, ends + 1)), shape=(80, 80))
    phase = np.random.default_rng(4).permutation(np.linspace(-3, 3, 80))
    embedding = np.column_stack([np.arange(80.0), np.zeros(80)])
    height = height_coordinate(sp.csr_array(graph + graph.T), embedding, phase)
    inside = (height > 0) & (height < 1)
    steps = np.diff(height[inside])
    np.testing.assert_allclose(steps, steps[0], rtol=1e-5)
    assert inside.sum() > 50
    longer = height_coordinate(sp.csr_array(graph + graph.T), embedding, phase, similar=1 / 20, end=0.3)
    assert ((longer > 0) & (longer < 1)).sum() < 40


def test_points_without_a_phase_have_no_height() -> None:
    X, truth = cylinder(1500, np.random.default_rng(5))
    with pytest.warns(SeparatePiecesWarning, match="2 pieces"):
        height = measure(np.concatenate([X, X[:100] + 50]))
    assert np.isnan(height[1500:]).all()
    assert explained(height[:1500], truth) > 0.97


@pytest.mark.parametrize(
    ("points", "phases", "message"), [(60, 50, "there are 50 phases"), (30, 30, "30 points have a phase")]
)
def test_bad_input_gets_one_sentence(points: int, phases: int, message: str) -> None:
    graph = sp.csr_array(np.ones((points, points)))
    with pytest.raises(CogmapError, match=message):
        height_coordinate(graph, np.zeros((phases, 2)), np.zeros(phases))
