import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import kstest, qmc

from cogmap import CogmapError
from cogmap.sweeps.sampling import Range, Sample


def drawn(**ranges: Range) -> np.ndarray:
    sample = Sample(points=512, ranges=ranges)
    return np.array([list(point.values()) for point in sample.draw()])


def test_values_are_uniform_between_the_ends() -> None:
    x, y = drawn(x=Range(low=-2, high=3), y=Range(low=0.01, high=10, log=True)).T
    assert kstest(x, "uniform", args=(-2, 5)).pvalue > 0.5
    assert kstest(np.log(y), "uniform", args=(np.log(0.01), np.log(1000))).pvalue > 0.5


def test_sobol_fills_more_evenly_than_chance() -> None:
    ranges = {name: Range(low=0, high=1) for name in "abc"}
    even, chance = (
        qmc.discrepancy([list(p.values()) for p in Sample(points=100, ranges=ranges, method=method).draw()])
        for method in ("sobol", "random")
    )
    assert even < chance / 3


def test_fewer_points_are_the_first_of_more_and_the_seed_matters() -> None:
    ranges = {"a": Range(low=0, high=1), "b": Range(low=1, high=2)}
    for method in ("sobol", "random"):
        some = Sample(points=33, ranges=ranges, method=method).draw()
        assert some[:20] == Sample(points=33, ranges=ranges, method=method).draw()[:20]
        assert some != Sample(points=33, ranges=ranges, method=method, seed=1).draw()
    assert Sample(points=5, ranges=ranges).draw() == Sample(points=8, ranges=ranges).draw()[:5]


@pytest.mark.parametrize("log", [False, True])
def test_whole_numbers_reach_both_ends_and_coincide_once(log: bool) -> None:  # noqa: FBT001
    values = drawn(n=Range(low=1, high=6, integer=True, log=log))[:, 0]
    assert sorted(values) == [1, 2, 3, 4, 5, 6]
    assert Range(low=1, high=6, integer=True).at(0.34) == 3


@given(st.floats(0.01, 10), st.floats(1.01, 100), st.floats(0, 1, exclude_max=True), st.booleans())
def test_no_value_leaves_its_range(low: float, factor: float, share: float, log: bool) -> None:  # noqa: FBT001
    span = Range(low=low, high=low * factor, log=log)
    assert low * (1 - 1e-12) <= span.at(share) <= low * factor * (1 + 1e-12)
    whole = Range(low=3, high=9, log=log, integer=True).at(share)
    assert isinstance(whole, int)
    assert 3 <= whole <= 9


@pytest.mark.parametrize(
    ("span", "says"),
    [
        (Range(low=1, high=1), "give low < high"),
        (Range(low=0, high=1, log=True), "low above 0"),
        (Range(low=0.5, high=3, integer=True), "whole numbers"),
    ],
)
def test_a_range_of_nothing_is_refused(span: Range, says: str) -> None:
    with pytest.raises(CogmapError, match=says):
        Sample(points=2, ranges={"x": span}).draw()
