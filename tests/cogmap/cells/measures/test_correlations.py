import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from cogmap.cells.measures.correlations import correlations, standardised


def test_agree_with_scipy_row_by_row() -> None:
    rng = np.random.default_rng(0)
    one, other = rng.normal(1000, 1, (2, 20, 50))
    one[rng.random(one.shape) < 0.2] = np.nan
    other[rng.random(other.shape) < 0.2] = np.nan
    both = ~(np.isnan(one) | np.isnan(other))
    expected = [stats.pearsonr(a[k], b[k]).statistic for a, b, k in zip(one, other, both, strict=True)]
    np.testing.assert_allclose(correlations(one, other), expected, atol=1e-12)


def test_constant_and_unknown_rows_have_none() -> None:
    rng = np.random.default_rng(0)
    nearly = 3 * (1 + 1e-15 * rng.normal(size=9))
    rows = np.stack([nearly, np.full(9, np.nan), np.zeros(9), np.arange(9.0)])
    np.testing.assert_allclose(
        correlations(rows, np.tile(np.arange(9.0), (4, 1))), [np.nan] * 3 + [1], atol=1e-12
    )
    one = np.array([[0.0, np.nan, 2, np.nan]])
    assert np.isnan(correlations(one, np.array([[np.nan, 1.0, np.nan, 3]]))).all()


def test_dot_products_of_standardised_rows_are_numpys_matrix() -> None:
    rows = np.random.default_rng(0).normal(size=(6, 30))
    np.testing.assert_allclose(standardised(rows) @ standardised(rows).T, np.corrcoef(rows), atol=1e-12)


@settings(deadline=None)
@given(st.floats(1e-3, 1e3), st.floats(-1e3, 1e3), st.integers(0, 2**32 - 1))
def test_scale_and_shift_do_not_matter(scale: float, shift: float, seed: int) -> None:
    one, other = np.random.default_rng(seed).normal(size=(2, 4, 12))
    expected = correlations(one, other)
    np.testing.assert_allclose(correlations(scale * one + shift, other), expected, atol=1e-6)
    np.testing.assert_allclose(correlations(-one, other), -expected, atol=1e-12)
