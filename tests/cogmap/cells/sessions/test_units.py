import numpy as np
import pytest

from cogmap.cells.sessions.units import check_metres, in_radians, metres_per, positive, scaled
from cogmap.errors import CogmapError


@pytest.mark.parametrize(
    ("word", "metres"),
    [
        ("m", 1), ("meters", 1), ("Metres", 1), (" cm ", 0.01), ("centimeter", 0.01), ("centimetres", 0.01),
        ("mm", 0.001), ("Millimeters", 0.001), ("inches", 0.0254), ("feet", 0.3048), (None, 1),
    ],
)  # fmt: skip
def test_words_for_lengths(word: str | None, metres: float) -> None:
    assert metres_per(word, None, None) == metres
    assert metres_per("parsec", word or "m", None) == metres


def test_other_words_are_refused() -> None:
    for word in ("pixels", "px", "a.u.", "unknown", ""):
        with pytest.raises(CogmapError, match="no length; say unit='cm'"):
            metres_per(word, None, None)
        assert metres_per(word, None, np.float32(0.5)) == 0.5


@pytest.mark.parametrize("wrong", [0, -1, np.nan, np.inf, "two", True, None, [1.0]])
def test_what_is_no_positive_number(wrong: object) -> None:
    with pytest.raises(CogmapError, match=r"length is .* positive number"):
        positive("length", wrong)
    assert positive("length", 0, or_zero=True) == 0


def test_whole_centimetres_are_the_metres_that_are_written() -> None:
    centimetres = np.arange(1000.0)
    metres = np.array([float(f"{whole // 100}.{whole % 100:02d}") for whole in range(1000)])
    np.testing.assert_array_equal(scaled(centimetres, 0.01), metres)
    assert not np.array_equal(centimetres * 0.01, metres)


@pytest.mark.parametrize("size", [0.0, 0.1, 1.0, 18.0])
def test_rooms_and_still_animals_are_taken(size: float) -> None:
    places = size * np.random.default_rng(0).random((500, 2))
    places[:4] = [np.nan, np.nan], [1e6, 0], [-1e6, 3], [1023, 1023]  # lost, and a tracker's jumps
    check_metres(places, told=False)


@pytest.mark.parametrize(("size", "said"), [(40.0, "centimetres or pixels"), (0.004, "taken twice")])
def test_what_no_room_is_like_is_refused(size: float, said: str) -> None:
    places = size * np.random.default_rng(0).random((500, 2))
    with pytest.raises(CogmapError, match=f"positions span .*{said}.*unit='m'"):
        check_metres(places, told=False)
    check_metres(places, told=True)


def test_turns_in_any_unit() -> None:
    turns = np.array([0.0, 90.0, 180.0, 270.0, np.nan])
    expected = [0, np.pi / 2, np.pi, -np.pi / 2, np.nan]
    np.testing.assert_allclose(np.abs(in_radians(turns, "degrees", None)), np.abs(expected))
    np.testing.assert_allclose(in_radians(turns, "radians", "deg")[[1, 3]], [np.pi / 2, -np.pi / 2])
    np.testing.assert_allclose(in_radians(np.deg2rad(turns), "radians", None)[3], -np.pi / 2)
    np.testing.assert_allclose(in_radians(np.array([7.0]), None, "rad"), 7 - 2 * np.pi)
    with pytest.raises(CogmapError, match="headings reach 270"):
        in_radians(turns, "radians", None)
