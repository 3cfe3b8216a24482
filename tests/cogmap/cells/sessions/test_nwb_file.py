import sys
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pynapple
import pynwb
import pytest

from cogmap.cells import MeasuredSession, Session, session
from cogmap.errors import CogmapError

pytestmark = [
    pytest.mark.filterwarnings("ignore::DeprecationWarning:(hdmf|pynwb|pynapple|xarray).*"),
    pytest.mark.filterwarnings("ignore::UserWarning:(hdmf|pynwb).*"),
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
]


def series(name: str, data: np.ndarray, **told: Any) -> pynwb.behavior.SpatialSeries:
    return pynwb.behavior.SpatialSeries(name=name, data=data, reference_frame="box", **told)


@pytest.fixture
def write(rat, tmp_path: Path) -> Callable[..., Path]:
    """Write the rat as NWB, with these series as its position and heading."""

    def to(
        positions: list[pynwb.behavior.SpatialSeries],
        headings: pynwb.behavior.SpatialSeries | None,
        **units: Any,
    ) -> Path:
        file = pynwb.NWBFile("rat", "rat", datetime(2000, 1, 1, tzinfo=UTC))
        module = file.create_processing_module("behavior", "where it was")
        module.add(pynwb.behavior.Position(spatial_series=positions))
        if headings is not None:
            module.add(pynwb.behavior.CompassDirection(spatial_series=headings))
        for name in units.keys() - {"obs_intervals"}:
            file.add_unit_column(name, "of each unit")
        for index, train in enumerate(rat.trains):
            file.add_unit(spike_times=train, **{name: values[index] for name, values in units.items()})
        with pynwb.NWBHDF5IO(tmp_path / "rat.nwb", "w") as disk:
            disk.write(file)
        return tmp_path / "rat.nwb"

    return to


def same(found: Session, rat, atol: float = 1e-9) -> None:
    np.testing.assert_array_equal(found.counts, rat.counts)
    np.testing.assert_allclose(found.times, rat.times, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.positions, rat.positions, rtol=0, atol=atol)
    np.testing.assert_allclose(found.headings, rat.headings, rtol=0, atol=atol)


@pytest.mark.parametrize(
    ("per_metre", "told"),
    [
        (1.0, {"unit": "meters"}),
        (100.0, {"unit": "meters", "conversion": 0.01}),
        (100.0, {"unit": "centimeters"}),
        (400.0, {"unit": "m", "conversion": 0.0025}),
        (100.0, {"unit": "cm", "offset": 0.0}),
    ],
)
def test_conversion_and_unit_are_honoured(rat, write, per_metre: float, told: dict[str, Any]) -> None:
    places = series("led", rat.positions * per_metre, timestamps=rat.times, **told)
    turns = series("hd", np.rad2deg(rat.headings), timestamps=rat.times, unit="degrees")
    found = session(write([places], turns))
    same(found, rat)
    assert (found.notes["position"], found.notes["heading"]) == ("Position/led", "CompassDirection/hd")


def test_a_table_is_that_of_the_same_arrays(rat, write) -> None:
    places = series("led", rat.positions * 100, timestamps=rat.times, unit="cm")
    turns = series("hd", rat.headings, timestamps=rat.times, unit="radians")
    read = MeasuredSession(session(write([places], turns)), shuffles=5).table
    direct = MeasuredSession(session(rat.trains, track=rat.track), shuffles=5).table
    pd.testing.assert_frame_equal(read, direct, rtol=0, atol=1e-6)


def test_what_the_file_says_gives_way_to_what_is_told(rat, write) -> None:
    """Centimetres that are called metres, degrees that are called radians: both are often met."""
    places = series("led", rat.positions * 100, timestamps=rat.times, unit="meters")
    turns = series("hd", np.rad2deg(rat.headings), timestamps=rat.times, unit="radians")
    path = write([places], turns)
    with pytest.raises(CogmapError, match=r"headings reach 1[78]"):
        session(path, unit="cm")
    with pytest.raises(CogmapError, match=r"positions span 9.*unit='cm'"):
        session(path, heading_unit="deg")
    same(session(path, unit="cm", heading_unit="deg"), rat)
    same(session(path, metres_per_unit=0.01, heading_unit="deg"), rat)


def test_pixels_must_be_told(rat, write) -> None:
    places = series("led", rat.positions * 400, timestamps=rat.times, unit="pixels")
    path = write([places], None)
    with pytest.raises(CogmapError, match=r"says that positions are in 'pixels'.*metres_per_unit="):
        session(path)
    found = session(path, metres_per_unit=0.0025)
    np.testing.assert_allclose(found.positions, rat.positions, atol=1e-9)
    assert found.headings is None


def test_a_rate_stands_for_times_and_headings_may_have_others(rat, write) -> None:
    places = series("led", rat.positions, starting_time=3.0, rate=20.0, unit="meters")
    turns = series("hd", rat.headings[::2, None], timestamps=rat.times[::2], unit="radians")
    found = session(write([places], turns))
    assert found.notes["without_heading"] == 1  # nobody knows the last
    np.testing.assert_allclose(found.headings[::2], rat.headings[::2], atol=1e-9)
    turned = np.angle(np.exp(1j * (found.headings - rat.headings[:-1])))
    assert np.median(np.abs(turned[1::2])) < 0.1


def test_one_of_several_series_is_chosen(rat, write) -> None:
    lamps = [
        series(name, rat.positions + by, timestamps=rat.times, unit="meters")
        for name, by in (("front", 0.0), ("back", 0.1))
    ]
    path = write(lamps, None)
    with pytest.raises(
        CogmapError, match=r"more than one position: Position/back, Position/front.*position="
    ):
        session(path)
    for name in ("front", "Position/front"):
        np.testing.assert_array_equal(session(path, position=name).positions, rat.positions)
    with pytest.raises(CogmapError, match="no position 'tail'; it has Position/back, Position/front"):
        session(path, position="tail")
    with pytest.raises(CogmapError, match="no series 'nose' to be the heading"):
        session(path, position="front", heading="nose")


def test_units_keep_names_and_populations_and_are_not_heard_beyond_their_intervals(rat, write) -> None:
    places = series("led", rat.positions, timestamps=rat.times, unit="meters")
    heard = [[[0.0, 203.0], [303.0, 999.0]]] * 21 + [[[103.0, 999.0]]]
    names = [f"tt{index}" for index in range(22)]
    kinds = ["place"] * 16 + ["heading"] * 6
    path = write([places], None, unit_name=names, cell_type=kinds, obs_intervals=heard)
    found = session(path)
    assert found.names == tuple(names)
    assert found.populations == tuple(kinds)
    there = ((rat.times >= 103) & (rat.times <= 203)) | (rat.times >= 303)
    np.testing.assert_array_equal(found.times, rat.times[there])
    assert found.notes["unobserved"] == (~there).sum()


def test_open_files_and_other_tracks(rat, write) -> None:
    places = series("led", rat.positions, timestamps=rat.times, unit="meters")
    turns = series("hd", rat.headings, timestamps=rat.times, unit="radians")
    path = write([places], turns)
    with pynwb.NWBHDF5IO(path, "r") as disk:
        same(session(disk.read()), rat)
    same(session(pynapple.load_file(str(path))), rat)
    elsewhere = session(path, track=(rat.times, rat.positions + 3.0))
    np.testing.assert_array_equal(elsewhere.positions, rat.positions + 3.0)
    np.testing.assert_array_equal(elsewhere.counts, rat.counts)
    with pytest.raises(CogmapError, match="no rates in hertz at the times of the position; it has none"):
        session(path, activity="rates")


def test_a_track_that_was_straightened(rat, write) -> None:
    places = series("led", rat.positions[:, 0], timestamps=rat.times, unit="meters")
    found = session(write([places], None))
    np.testing.assert_array_equal(found.positions, rat.positions * [1, 0])


def test_what_is_no_session_is_told(rat, write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    places = series("led", np.c_[rat.positions, rat.headings], timestamps=rat.times, unit="meters")
    path = write([places], None)
    with pytest.raises(CogmapError, match="positions have 3 columns"):
        session(path)
    with pytest.raises(CogmapError, match="there is no such file"):
        session(tmp_path / "none.nwb")
    content = path.read_bytes()
    for name, part in (("cut.nwb", content[: len(content) // 2]), ("text.nwb", b"no file"), ("e.nwb", b"")):
        (tmp_path / name).write_bytes(part)
        with pytest.raises(CogmapError, match=f"{name} cannot be read as NWB"):
            session(tmp_path / name)
    empty = pynwb.NWBFile("rat", "rat", datetime(2000, 1, 1, tzinfo=UTC))
    with pytest.raises(CogmapError, match="no position; it has no spatial series at all"):
        session(empty)
    with pytest.raises(CogmapError, match="no units with spike times"):
        session(empty, track=rat.track, activity="spikes")
    monkeypatch.setitem(sys.modules, "pynwb", None)
    with pytest.raises(CogmapError, match=r"pip install 'cogmap\[nwb\]'"):
        session(path)
