import numpy as np
import pytest
import shapely

from arena.motions.fitting import fitted
from arena.recordings.tracks import RecordedPath

FREE = shapely.box(-2, -1, 2, 1)


def recorded(positions: np.ndarray, doubtful: np.ndarray | None = None) -> RecordedPath:
    none = np.zeros(len(positions), dtype=bool)
    return RecordedPath(
        np.arange(len(positions)) / 10, positions, None, {}, none if doubtful is None else doubtful
    )


def loops(count: int = 1000) -> np.ndarray:
    angle = np.linspace(0, 20 * np.pi, count)
    return np.stack([300 + 100 * np.cos(angle), 200 + 25 * np.sin(angle)], axis=1)


def test_it_fills_the_box() -> None:
    found = fitted(recorded(loops()), FREE, None)
    low, high = found.positions.min(axis=0), found.positions.max(axis=0)
    np.testing.assert_allclose([low[0], high[0]], [-2, 2])
    np.testing.assert_allclose(low + high, 0, atol=1e-9)
    assert found.scale == pytest.approx(0.02, rel=1e-4)
    assert not found.left_out.any()
    assert not found.too_fast.any()


def test_what_is_doubtful_or_far_from_all_others_does_not_decide() -> None:
    positions, doubtful = loops(), np.zeros(1000, dtype=bool)
    plain = fitted(recorded(positions), FREE, None)
    # It wanders about outside for a while, and is lost once.
    positions[400:404] = [(900, 200), (905, 201), (909, 201), (912, 200)]
    positions[600], doubtful[600] = (310, 190), True
    positions[700] = np.nan
    found = fitted(recorded(positions, doubtful), FREE, None)
    out = [400, 401, 402, 403, 600]
    assert np.flatnonzero(found.left_out).tolist() == out
    np.testing.assert_allclose(np.delete(found.positions, [*out, 700], axis=0),
                               np.delete(plain.positions, [*out, 700], axis=0), rtol=1e-3)  # fmt: skip
    assert np.isnan(found.positions[[*out, 700]]).all()


def test_an_excursion_is_no_error() -> None:
    """An animal that stays in one half for nearly all the time was in the other one, too."""
    along = np.concatenate([np.linspace(0, 100, 990), np.linspace(100, 190, 10)])
    found = fitted(recorded(np.stack([along, 0 * along], axis=1)), FREE, None)
    assert not found.left_out.any()
    assert found.positions[-1, 0] == pytest.approx(2)


def test_scale_and_speed_agree() -> None:
    positions = loops()
    # Not so far as to be left out; the path grows as it goes.
    positions[250] = (560, 200)
    slow = fitted(recorded(positions), FREE, None)
    found = fitted(recorded(positions), FREE, 2.0)
    assert not slow.too_fast.any()
    assert np.flatnonzero(found.too_fast).tolist() == [250]
    speed = np.hypot(*np.diff(np.delete(found.positions, 250, axis=0), axis=0).T) * 10
    assert speed.max() < 2
    assert np.ptp(np.delete(found.positions, 250, axis=0)[:, 0]) == pytest.approx(4)


def test_doubtful_samples_do_not_make_the_path_so_small_that_they_are_slow() -> None:
    positions, doubtful = loops(), np.zeros(1000, dtype=bool)
    positions[600], doubtful[600] = (580, 200), True
    way = np.hypot(*(positions[600] - positions[[599, 601]]).T).min()
    true, small = 4 / 200, 4 / 380
    fastest = way * (true + small) / 2 / 0.1
    found = fitted(recorded(positions, doubtful), FREE, fastest)
    assert np.flatnonzero(found.too_fast).tolist() == [600]
    assert found.scale == pytest.approx(true, rel=1e-3)
    assert not fitted(recorded(positions), FREE, fastest).too_fast.any()
