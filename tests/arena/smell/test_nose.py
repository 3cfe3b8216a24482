import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from arena.errors import ArenaError
from arena.smell.nose import Nose


def smell(
    nose: Nose, concentrations: np.ndarray, times: np.ndarray | None = None, seed: int = 0
) -> np.ndarray:
    times = np.arange(len(concentrations)) * 0.3 if times is None else times
    return nose.smell(concentrations, times, np.random.default_rng(seed))


def test_perfect_nose_smells_the_concentration() -> None:
    concentrations = np.random.default_rng(1).uniform(0.01, 1, (50, 3))
    smelt = smell(Nose(noise=0.0), concentrations)
    assert smelt.dtype == np.float32
    np.testing.assert_array_equal(smelt, concentrations.astype(np.float32))


@pytest.mark.parametrize("noise", [0.05, 0.1, 0.8])
def test_noise_is_lognormal_around_the_concentration(noise: float) -> None:
    smelt = smell(Nose(noise=noise), np.full((20_000, 2), 0.4))
    error = np.log(smelt.astype(float) / 0.4)
    assert stats.kstest(error.ravel() / noise, "norm").pvalue > 0.01
    assert abs(np.corrcoef(error[:-1, 0], error[1:, 0])[0, 1]) < 0.03
    assert abs(np.corrcoef(error.T)[0, 1]) < 0.03


def test_same_seed_same_smell() -> None:
    nose, concentrations = Nose(fluctuation=0.3), np.full((100, 3), 0.2)
    np.testing.assert_array_equal(smell(nose, concentrations), smell(nose, concentrations))
    assert not np.array_equal(smell(nose, concentrations), smell(nose, concentrations, seed=1))


@pytest.mark.parametrize("fluctuation", [0.0, 0.3])
@pytest.mark.parametrize("cuts", [(), (1,), (0, 7, 7, 30), range(1, 50)])
def test_smelt_in_pieces_it_is_the_same(fluctuation: float, cuts: tuple[int, ...]) -> None:
    nose, rng = Nose(fluctuation=fluctuation, correlation_time=2.0), np.random.default_rng(4)
    concentrations, times = rng.uniform(0.01, 1, (50, 3)), np.cumsum(rng.exponential(0.5, 50))
    sniffer = nose.sniffer(3, np.random.default_rng(0))
    pieces = [
        sniffer.smell(concentration, time)
        for concentration, time in zip(np.split(concentrations, cuts), np.split(times, cuts), strict=True)
    ]
    np.testing.assert_array_equal(np.concatenate(pieces), smell(nose, concentrations, times))


def test_drift_follows_its_recurrence() -> None:
    nose, rng = Nose(noise=0.2, fluctuation=0.3, correlation_time=2.0), np.random.default_rng(4)
    times = np.cumsum(rng.exponential(0.5, 50))
    normals = np.random.default_rng(0).standard_normal((50, 2, 3))
    gain, wanted = 0.3 * normals[0, 1], []
    for view, (sniff, shock) in enumerate(normals):
        if view:
            memory = np.exp((times[view - 1] - times[view]) / 2.0)
            gain = memory * gain + 0.3 * np.sqrt(1 - memory**2) * shock
        wanted.append(0.4 * np.exp(0.2 * sniff + gain))
    np.testing.assert_allclose(smell(nose, np.full((50, 3), 0.4), times), wanted, rtol=1e-6)


def test_time_cannot_run_back_between_calls() -> None:
    sniffer = Nose().sniffer(1, np.random.default_rng(0))
    sniffer.smell(np.ones((2, 1)), np.array([0.0, 3.0]))
    with pytest.raises(ArenaError, match="times"):
        sniffer.smell(np.ones((1, 1)), np.array([2.9]))


def test_fluctuation_is_stationary_and_forgets_at_its_time_constant() -> None:
    nose = Nose(noise=0.0, fluctuation=0.3, correlation_time=2.0)
    times = np.array([0.0, 0.1, 0.5, 0.5, 3.0, 40.0])
    drift = np.log(smell(nose, np.ones((len(times), 20_000)), times)).T
    wanted = 0.09 * np.exp(-np.abs(times[:, None] - times) / 2.0)
    np.testing.assert_allclose(np.cov(drift.T), wanted, atol=0.004)
    np.testing.assert_allclose(drift.mean(axis=0), 0, atol=0.01)


@pytest.mark.parametrize("name", ["noise", "fluctuation", "correlation_time"])
@pytest.mark.parametrize("value", [-0.1, np.nan, np.inf, "much"])
def test_bad_parameters_are_refused(name: str, value: float) -> None:
    with pytest.raises(ArenaError, match=f"^Nose: {name} is {value!r}: Input should be "):
        Nose(**{name: value})


def test_unknown_parameter_is_refused() -> None:
    with pytest.raises(ArenaError, match="nois"):
        Nose(nois=0.1)


@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_bad_concentrations_are_refused(value: float) -> None:
    with pytest.raises(ArenaError, match="concentration"):
        smell(Nose(), np.array([[0.1], [value]]))


@pytest.mark.parametrize("times", [[0.0, 1.0, 0.5], [0.0, np.nan, 1.0]])
def test_times_that_run_backwards_are_refused(times: list[float]) -> None:
    with pytest.raises(ArenaError, match="times"):
        smell(Nose(), np.ones((3, 1)), np.array(times))


@given(st.floats(1e-300, 1e300), st.floats(0, 10))
def test_smell_is_positive_and_finite(concentration: float, noise: float) -> None:
    smelt = smell(Nose(noise=noise), np.full((20, 2), concentration))
    assert np.isfinite(smelt).all()
    assert (smelt > 0).all()
