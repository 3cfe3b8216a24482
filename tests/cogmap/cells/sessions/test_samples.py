import numpy as np
import pytest

from cogmap.cells.sessions.recorded import Series
from cogmap.cells.sessions.samples import count_spikes, headings_at, sample_durations, speeds, within


def test_a_sample_lasts_until_the_next_but_for_gaps() -> None:
    lasting = sample_durations(np.array([0.0, 0.1, 0.2, 0.35, 9.0, 9.1, 9.2]))
    np.testing.assert_allclose(lasting, [0.1, 0.1, 0.15, 0.2, 0.1, 0.1, 0.1])


def test_speed_of_a_steady_walk_bridges_lost_samples_and_ignores_jitter() -> None:
    times = np.arange(0, 10, 0.02)
    places = np.stack([0.3 * times, -0.4 * times], axis=1)
    jitter = np.random.default_rng(0).normal(0, 0.002, places.shape)
    places[50:60] = np.nan
    np.testing.assert_allclose(speeds(times, places), 0.5)
    assert speeds(times, places * 0 + jitter).max() < 0.03
    assert np.isnan(speeds(times, places * np.nan)).all()


def test_spikes_are_counted_where_numpy_counts_them() -> None:
    rng, edges = np.random.default_rng(0), np.arange(0, 10.05, 0.1)
    trains = [np.sort(rng.uniform(-1, 11, 500)) for _ in range(3)]
    counts, outside = count_spikes(trains, edges[:-1], np.diff(edges))
    expected = np.stack([np.histogram(train, edges)[0] for train in trains], axis=1)
    np.testing.assert_array_equal(counts, expected)
    assert outside == 1500 - expected.sum()
    silent, none = count_spikes([np.empty(0)], edges[:-1], np.diff(edges))
    assert (silent.shape, silent.sum(), none) == ((100, 1), 0, 0)


def test_headings_go_the_shorter_way_and_are_not_made_up() -> None:
    series = Series(np.array([0.0, 1.0, 2.0, 9.0, 10.0]), np.deg2rad([170, -170, np.nan, 10, 20]), None)
    found = np.rad2deg(headings_at(series, np.array([-0.5, 0.5, 1.0, 1.5, 5.0, 9.0, 9.5, 11.0])))
    np.testing.assert_allclose(np.abs(found[[1, 2]]), [180, 170])
    np.testing.assert_allclose(found[[5, 6]], [10, 15])
    assert np.isnan(found[[0, 3, 4, 7]]).all()


def test_times_within_epochs() -> None:
    epochs = np.array([[0.0, 1.0], [5.0, 6.0]])
    np.testing.assert_array_equal(within(np.array([-1, 0, 1, 2, 5.5]), epochs), [0, 1, 1, 0, 1])
    assert not within(np.array([0.0]), np.empty((0, 2))).any()


@pytest.mark.parametrize("samples", [2, 3])
def test_few_samples_have_speeds(samples: int) -> None:
    times = np.arange(float(samples))
    np.testing.assert_allclose(speeds(times, np.stack([times, 0 * times], axis=1)), 1)
