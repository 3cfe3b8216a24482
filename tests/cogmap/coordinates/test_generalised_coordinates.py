from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sklearn.base import clone

from arena.angles import wrap_angle
from cogmap import GeneralisedCoordinates
from cogmap.errors import CogmapError
from cogmap.map.storage import read_state, write_state


@pytest.fixture(scope="module")
def turning(ring: np.ndarray) -> GeneralisedCoordinates:
    return GeneralisedCoordinates(components=8).fit(ring)


@pytest.fixture(scope="module")
def sliding(sheet: tuple[np.ndarray, np.ndarray]) -> GeneralisedCoordinates:
    return GeneralisedCoordinates(components=12, memory=300).fit(sheet[0])


def test_a_ring_has_one_phase(turning: GeneralisedCoordinates, ring: np.ndarray, angles: np.ndarray) -> None:
    assert (turning.dimension_, turning.betti_.numbers, turning.reason_) == (1, (1, 1, 0), "")
    assert turning.eye_ == "perspective"
    assert turning.vote_ > 0.8
    assert len(turning.indices_) == 250
    phase = turning.transform(ring)[:, 0]
    assert max(abs(np.exp(1j * (phase - sign * angles)).mean()) for sign in (-1, 1)) > 0.99
    assert list(turning.get_feature_names_out()) == ["phase_0"]
    np.testing.assert_allclose(wrap_angle(phase[turning.indices_] - turning.coordinates_[:, 0]), 0, atol=0.05)


def test_a_sheet_has_two_heights(
    sliding: GeneralisedCoordinates, sheet: tuple[np.ndarray, np.ndarray]
) -> None:
    views, places = sheet
    assert (sliding.dimension_, sliding.loops_, sliding.reason_) == (2, 0, "")
    assert len(sliding.codes_) == 300
    found = np.column_stack([sliding.transform(views), np.ones(len(views))])
    missed = places - found @ np.linalg.lstsq(found, places, rcond=None)[0]
    assert (missed.var(axis=0) < 0.02 * places.var(axis=0)).all()


def test_what_is_saved_is_loaded(turning: GeneralisedCoordinates, ring: np.ndarray, tmp_path: Path) -> None:
    turning.save(tmp_path / "ring")
    loaded = GeneralisedCoordinates.load(tmp_path / "ring")
    np.testing.assert_array_equal(loaded.transform(ring[:50]), turning.transform(ring[:50]))
    assert str(loaded.betti_) == str(turning.betti_)
    for name in ("dimension_", "vote_", "reason_", "eye_", "loops_"):
        assert getattr(loaded, name) == getattr(turning, name)
    for name in ("spectrum_", "indices_", "codes_", "coordinates_"):
        np.testing.assert_array_equal(getattr(loaded, name), getattr(turning, name))
    assert loaded.get_params() == turning.get_params()
    weights, *_ = read_state(tmp_path / "ring", kind="coordinates")
    assert "code.weight" in weights
    write_state(tmp_path / "other", {}, {}, {}, kind="coordinates")
    with pytest.raises(CogmapError, match="does not hold whole coordinates"):
        GeneralisedCoordinates.load(tmp_path / "other")


def test_unresolved_loops_leave_no_coordinates(turning: GeneralisedCoordinates, ring: np.ndarray) -> None:
    doubtful = clone(turning)
    doubtful.__dict__.update(turning.__dict__)
    doubtful.betti_ = replace(turning.betti_, reasons=("", "its weakest bar is short", ""))
    assert not doubtful.located_
    assert doubtful._doubts() == "loops: its weakest bar is short"
    doubtful.reason_, doubtful.coordinates_ = doubtful._doubts(), None
    with pytest.raises(CogmapError, match="unresolved: loops: its weakest bar is short"):
        doubtful.transform(ring)


@pytest.mark.parametrize(
    ("numbers", "dimension", "vote", "said"),
    [
        ((1, 1, 0), 1, 0.4, "only 40% of the neighbourhoods say 1"),
        ((2, 1, 0), 1, 1.0, "the views fall into 2 pieces"),
        ((1, 2, 0), 2, 1.0, "2 loops and 0 voids"),
        ((1, 3, 3), 2, 1.0, "3 loops and 3 voids"),
        ((1, 2, 1), 2, 1.0, ""),
    ],
)
def test_what_is_no_product_is_told(
    turning: GeneralisedCoordinates, numbers: tuple[int, ...], dimension: int, vote: float, said: str
) -> None:
    odd = clone(turning)
    odd.betti_, odd.dimension_, odd.vote_ = replace(turning.betti_, numbers=numbers), dimension, vote
    assert said in odd._doubts()
    assert bool(said) == bool(odd._doubts())


def test_bad_input_gets_one_sentence(turning: GeneralisedCoordinates, ring: np.ndarray) -> None:
    with pytest.raises(CogmapError, match="300 views are too few"):
        GeneralisedCoordinates().fit(ring[:300])
    with pytest.raises(CogmapError, match="12×24 pixels"):
        turning.transform(ring[:, :12])
    with pytest.raises(CogmapError, match="memory is 10"):
        GeneralisedCoordinates(memory=10).fit(ring)
