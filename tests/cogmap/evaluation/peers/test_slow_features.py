import numpy as np

from cogmap.evaluation.peers.slow_features import learn_stage, slow_cells


def mixed(views: int) -> tuple[np.ndarray, np.ndarray]:
    """Six nonlinear mixtures of a slow signal and a fast one."""
    t = np.linspace(0, 40 * np.pi, views)
    slow, fast = np.sin(t / 10), np.sin(11 * t)
    columns = [slow + fast**2, fast, slow * fast, fast - slow**2, slow - 0.5 * fast, fast**2]
    return np.column_stack(columns), slow


def test_the_slowest_feature_is_the_slow_signal() -> None:
    x, slow = mixed(4000)
    stage = learn_stage(x, 2)
    features = stage(x)
    assert abs(np.corrcoef(features[:, 0], slow)[0, 1]) > 0.999
    np.testing.assert_allclose(np.cov(features.T), np.eye(2), atol=0.01)
    change = np.square(np.diff(features, axis=0)).mean(axis=0)
    assert change[0] < change[1]


def test_in_random_order_nothing_is_slow() -> None:
    x, _ = mixed(4000)
    shuffled = x[np.random.default_rng(0).permutation(len(x))]
    change = np.square(np.diff(learn_stage(shuffled, 2)(shuffled), axis=0)).mean(axis=0)
    np.testing.assert_allclose(change, 2, atol=0.2)


def test_cells_fire_seldom_and_strongly() -> None:
    rng = np.random.default_rng(0)
    place = np.cumsum(0.1 * rng.standard_normal((3000, 3)), axis=0)
    codes = np.concatenate([np.cos(place), np.sin(place), rng.standard_normal((3000, 2))], axis=1)
    learnt, other = slow_cells(codes, codes, codes[:10], seed=1)
    assert learnt.rates.shape == (3000, 16)
    np.testing.assert_allclose(learnt.rates.max(axis=0), 20)
    assert learnt.rates.min() == 0
    assert (np.mean(learnt.features**3, axis=0) >= 0).all()
    np.testing.assert_allclose(other.rates, learnt.rates[:10])
    (few,) = slow_cells(codes, codes, slow=5, cells=4, peak=10.0, seed=1)
    assert few.rates.shape == (3000, 4)
    np.testing.assert_allclose(few.rates.max(axis=0), 10)
    (fewer,) = slow_cells(codes, codes, slow=1, seed=1)
    assert fewer.rates.shape == (3000, 1)
    (again,) = slow_cells(codes, codes, seed=1)
    np.testing.assert_array_equal(again.rates, learnt.rates)
