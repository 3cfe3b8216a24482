import sys
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import nwbinspector
import pandas as pd
import pynapple
import pynwb
import pytest

from arena import Recording
from cogmap import CogmapError, CognitiveMap, cli
from cogmap.cells import MeasuredSession, heading_statistics, place_statistics, poisson_spikes, session
from cogmap.cells.measures.both import join_statistics
from cogmap.evaluation.map_session import map_session
from cogmap.export import RESOLUTION, export_nwb

pytestmark = [
    pytest.mark.filterwarnings("ignore::DeprecationWarning:(hdmf|pynwb|pynapple|nwbinspector).*"),
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
]


@pytest.fixture(scope="module")
def short(walk: Recording) -> Recording:
    """A walk with a gap of a minute in it."""
    part = walk[:3000]  # long enough that no cell fires just once, which pynapple warns of
    times = part.times.copy()
    times[400:] += 60
    return replace(part, times=times)


@pytest.fixture(scope="module")
def out(short: Recording, cmap: CognitiveMap, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("nwb") / "deep" / "walk.nwb"
    export_nwb(short, cmap, path, seed=3)
    return path


def test_the_inspector_finds_nothing(out: Path) -> None:
    with pynwb.NWBHDF5IO(out, "r") as disk:
        assert list(nwbinspector.inspect_nwbfile_object(disk.read())) == []


def test_pynapple_reads_it_back(out: Path, short: Recording, cmap: CognitiveMap) -> None:
    data = pynapple.load_file(str(out))
    activity = cmap.perceive(short.views)
    np.testing.assert_array_equal(data["position"].times(), short.times)
    np.testing.assert_array_equal(data["position"].values, short.poses[:, :2])
    np.testing.assert_array_equal(data["heading"].values, short.poses[:, 2])
    np.testing.assert_array_equal(data["place_rates"].values, activity.place)
    np.testing.assert_array_equal(data["heading_rates"].values, activity.heading)
    kinds = ["place"] * cmap.place_cells + ["heading"] * cmap.heading_cells
    assert list(data["units"]["cell_type"]) == kinds


def test_cells_spike_as_often_as_their_rates_say(out: Path, short: Recording, cmap: CognitiveMap) -> None:
    units = pynapple.load_file(str(out))["units"]
    activity = cmap.perceive(short.views)
    steps = np.append(np.diff(short.times), np.nan)
    usual = np.nanmedian(steps)
    lasting = np.where(np.isnan(steps), usual, np.minimum(steps, 2 * usual))
    expected = lasting @ np.hstack([activity.place, activity.heading]).astype(float)
    counts = np.array([len(units[cell]) for cell in units])
    assert np.square(counts - expected).sum() / expected.sum() == pytest.approx(1, abs=0.3)
    times = np.concatenate([units[cell].times() for cell in units])
    within = times - short.times[np.searchsorted(short.times, times + 2 * RESOLUTION) - 1]
    assert within.max() <= 2 * usual + RESOLUTION
    assert not ((times > short.times[399] + 2 * usual + RESOLUTION) & (times < short.times[400])).any()
    assert times.max() <= short.times[-1] + usual
    share = within / lasting[np.searchsorted(short.times, times + 2 * RESOLUTION) - 1]
    assert share.mean() == pytest.approx(0.5, abs=0.01)
    assert share.std() == pytest.approx(12**-0.5, abs=0.01)


def test_head_direction_cells_are_tuned(out: Path, cmap: CognitiveMap) -> None:
    data = pynapple.load_file(str(out))
    cells = [cell for cell, kind in enumerate(data["units"]["cell_type"]) if kind == "heading"]
    turn = pynapple.Tsd(data["heading"].times(), data["heading"].d[:] % (2 * np.pi))
    curves = pynapple.compute_tuning_curves(
        data["units"][cells], turn, bins=12, range=(0, 2 * np.pi), feature_names=["heading"]
    ).to_numpy()
    angles = (np.arange(12) + 0.5) * np.pi / 6
    vectors = np.abs((np.nan_to_num(curves) @ np.exp(1j * angles)) / np.nan_to_num(curves).sum(axis=1))
    assert len(cells) == cmap.heading_cells
    assert np.median(vectors) > 0.5


@pytest.fixture(scope="module")
def drawn(short: Recording, cmap: CognitiveMap) -> np.ndarray:
    """Spikes of each place cell in each view, drawn as the export draws them, and not via their times."""
    steps = np.diff(short.times)
    lasting = np.minimum(np.append(steps, np.median(steps)), 2 * np.median(steps))
    place = cmap.perceive(short.views).place.astype(float)
    return poisson_spikes(place * lasting[:, None], np.random.default_rng(3), peak=None, seconds=1.0)


def test_a_session_of_its_spikes_is_what_was_drawn(out: Path, short: Recording, drawn: np.ndarray) -> None:
    found = session(out)
    place = found.population("place")
    np.testing.assert_array_equal(place.counts, drawn)
    np.testing.assert_array_equal(found.positions, short.poses[:, :2])
    np.testing.assert_allclose(found.headings, short.poses[:, 2], rtol=0, atol=1e-12)
    assert (found.notes["spikes_outside"], found.notes["lost"]) == (0, 0)


def test_the_command_gives_the_table_of_the_direct_route(
    out: Path, short: Recording, cmap: CognitiveMap, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By spikes whose times never went through a file with their track."""
    with pynwb.NWBHDF5IO(out, "r") as disk:
        units = disk.read().units
        trains = [np.asarray(units.get_unit_spike_times(index)) for index in range(len(units))]
    positions, headings = short.poses[:, :2], short.poses[:, 2]
    rates = session(trains, track=(short.times, positions, headings)).rates
    place = place_statistics(rates, positions, headings)
    direct = join_statistics(place, heading_statistics(rates, positions, headings)).reset_index(drop=True)
    words = ["cells", out, "--out", tmp_path / "cells", "--shuffles", 1]
    monkeypatch.setattr(sys, "argv", ["cogmap", *map(str, words)])
    cli.main()
    table = pd.read_parquet(tmp_path / "cells" / "cells.parquet")
    pd.testing.assert_frame_equal(table[list(direct)], direct, rtol=0, atol=1e-6)
    assert list(table["population"]) == ["place"] * cmap.place_cells + ["heading"] * cmap.heading_cells


def test_the_rates_in_the_file_have_the_table_of_the_map(
    out: Path, short: Recording, cmap: CognitiveMap
) -> None:
    read = MeasuredSession(session(out, activity="rates"), shuffles=3).table
    straight = MeasuredSession(map_session(short, cmap), shuffles=3).table
    pd.testing.assert_frame_equal(read, straight, rtol=0, atol=1e-6)
    activity = cmap.perceive(short.views)
    rates = np.hstack([activity.place, activity.heading]).astype(float)
    place = place_statistics(rates, short.poses[:, :2], short.poses[:, 2])
    np.testing.assert_allclose(read["spatial_information"], place["spatial_information"], rtol=0, atol=1e-6)


def test_the_seed_draws_the_spikes(short: Recording, cmap: CognitiveMap, out: Path, tmp_path: Path) -> None:
    trains = {}
    for seed in (3, 4):
        export_nwb(short, cmap, tmp_path / f"{seed}.nwb", seed=seed)
        with pynwb.NWBHDF5IO(tmp_path / f"{seed}.nwb", "r") as disk:
            file = disk.read()
            assert file.session_start_time == datetime(2000, 1, 1, tzinfo=UTC)
            assert file.units.resolution == RESOLUTION
            trains[seed] = np.asarray(file.units["spike_times"].target.data[:])
    with pynwb.NWBHDF5IO(out, "r") as disk:
        np.testing.assert_array_equal(np.asarray(disk.read().units["spike_times"].target.data[:]), trains[3])
    assert not np.array_equal(trains[3][:50], trains[4][:50])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["3.nwb", "4.nwb"]


def test_what_cannot_be_exported(
    short: Recording, cmap: CognitiveMap, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    diary = tmp_path / "diary.nwb"
    diary.write_text("mine", encoding="utf-8")
    with pytest.raises(CogmapError, match="exists already"):
        export_nwb(short, cmap, diary)
    for recording, said in (
        (short.without_truth(), "no poses"), (short[::-1], "do not increase"), (short[:1], "do not increase"),
    ):  # fmt: skip
        with pytest.raises(CogmapError, match=said):
            export_nwb(recording, cmap, tmp_path / "out.nwb")
    with pytest.raises(CogmapError, match="seed is -1"):
        export_nwb(short, cmap, tmp_path / "out.nwb", seed=-1)
    with pytest.raises(CogmapError, match="cannot write"):
        export_nwb(short, cmap, diary / "out.nwb")
    monkeypatch.setattr(
        pynwb.NWBHDF5IO, "write", lambda *_, **__: (_ for _ in ()).throw(OSError(28, "No space left"))
    )
    with pytest.raises(CogmapError, match=r"cannot write .*out\.nwb: No space left"):
        export_nwb(short, cmap, tmp_path / "out.nwb")
    monkeypatch.setitem(sys.modules, "pynwb", None)
    with pytest.raises(CogmapError, match=r"pip install 'cogmap\[nwb\]'"):
        export_nwb(short, cmap, tmp_path / "out.nwb")
    assert [path.name for path in tmp_path.iterdir()] == ["diary.nwb"]
    assert diary.read_text(encoding="utf-8") == "mine"
