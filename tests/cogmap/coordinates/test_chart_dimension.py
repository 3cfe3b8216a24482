import numpy as np
import pytest

from cogmap.coordinates import chart_dimension
from cogmap.errors import CogmapError


def torus(views: int, dimensions: int, seed: int = 0) -> np.ndarray:
    """Points of a product of circles, bent into eight dimensions, with a little noise."""
    rng = np.random.default_rng(seed)
    angles = rng.uniform(0, 2 * np.pi, (views, dimensions))
    points = np.hstack([np.cos(angles), np.sin(angles), 0.01 * rng.normal(size=(views, 8 - 2 * dimensions))])
    return points.astype(np.float32)


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_charts_tell_the_dimension_of_a_torus(dimensions: int) -> None:
    found = chart_dimension(torus(1500 * dimensions, dimensions), charts=60 * dimensions**2)
    assert found.dimension == dimensions
    assert found.vote > 0.5
    assert found.spectrum.shape == (6,)
    assert found.spectrum[:dimensions].sum() > 0.7


def test_same_seed_same_spectrum() -> None:
    codes = torus(600, 2)
    one, same, other = (chart_dimension(codes, seed=seed).spectrum for seed in (1, 1, 2))
    assert np.array_equal(one, same)
    assert not np.array_equal(one, other)


@pytest.mark.parametrize(
    ("codes", "charts", "message"),
    [
        (torus(20, 2), 30, "20 codes for 30 charts"),
        (torus(5, 2), None, "charts is 0"),
        (np.ones((100, 6), np.float32), 5, "all codes are the same"),
        (np.full((50, 6), np.nan, np.float32), 5, "not finite"),
    ],
)
def test_bad_codes_get_one_sentence(codes: np.ndarray, charts: int | None, message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        chart_dimension(codes, charts=charts)
