from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from arena import ArenaError
from cogmap.cells import session
from cogmap.cells.sessions.tables import read_spikes
from cogmap.errors import CogmapError


@pytest.fixture
def folder(rat, tmp_path: Path) -> Path:
    """The rat in centimetres and degrees, its cells by name."""
    cells = np.repeat([f"tt{index}" for index in range(22)], [len(train) for train in rat.trains])
    spikes = pd.DataFrame({"cell": cells, "t": np.concatenate(rat.trains)})
    spikes.sort_values("t").to_csv(tmp_path / "spikes.csv", index=False)
    x, y = 100 * rat.positions.T
    track = pd.DataFrame({"t": rat.times, "x": x, "y": y, "heading_deg": np.rad2deg(rat.headings)})
    track.loc[100:109, ["x", "y"]] = np.nan
    track.to_csv(tmp_path / "track.csv", index=False)
    return tmp_path


def test_a_folder_of_tables(rat, folder: Path) -> None:
    found = session(folder, unit="cm")
    kept = np.r_[0:100, 110 : len(rat.times)]
    by_name = np.argsort([f"tt{index}" for index in range(22)])
    np.testing.assert_array_equal(found.counts, rat.counts[kept][:, by_name])
    np.testing.assert_allclose(found.positions, rat.positions[kept], atol=1e-9)
    np.testing.assert_allclose(found.headings, rat.headings[kept], atol=1e-9)
    assert found.notes["lost"] == 10
    assert set(found.names) == {f"tt{index}" for index in range(22)}
    (folder / "track.csv").rename(folder / "elsewhere.csv")
    apart = session(str(folder / "spikes.csv"), track=folder / "elsewhere.csv", unit="cm")
    np.testing.assert_array_equal(apart.counts, found.counts)
    with pytest.raises(ArenaError, match=r"cannot read .*track\.csv"):
        session(folder, unit="cm")
    with pytest.raises(ArenaError, match="colour"):
        session(folder, track=folder / "elsewhere.csv", colour="red")


def test_the_file_of_a_track_is_read_by_its_options(rat, folder: Path) -> None:
    before = session(folder, unit="cm")
    track = pd.read_csv(folder / "track.csv").fillna(-1)
    pixels = pd.DataFrame(
        {
            "ms": 1e3 * track.t,
            "nose_x": 4 * track.x,
            "nose_y": -4 * track.y,
            "way": -np.deg2rad(track.heading_deg),
        }
    )
    pixels.loc[100:109, ["nose_x", "nose_y"]] = -1
    pixels.to_csv(folder / "track.csv", index=False, sep=";", decimal=",")
    told = {
        "x": "nose_x",
        "y": "nose_y",
        "heading": "way",
        "y_down": True,
        "missing": -1,
        "t": "ms",
        "rate": 1000,
    }
    found = session(folder, metres_per_unit=0.0025, **told)
    np.testing.assert_array_equal(found.counts, before.counts)
    np.testing.assert_allclose(found.positions, before.positions, atol=1e-9)
    np.testing.assert_allclose(found.headings, before.headings, atol=1e-9)
    assert (found.notes["missing"], found.notes["metres_per_unit"]) == (10, [0.0025, 0.0025])
    with pytest.raises(CogmapError, match="both a unit and scale"):
        session(folder, unit="cm", scale=0.0025)
    with pytest.raises(CogmapError, match="the option rate is for a track's file"):
        session(folder / "spikes.csv", track=rat.track, rate=20)


def test_numbers_are_in_their_order(tmp_path: Path) -> None:
    path = tmp_path / "spikes.csv"
    path.write_text("\ufeffcell, t\n10, 1.5\n9, 2.5\n10, .5\na, 1\n", encoding="utf-8")
    found = read_spikes(path)
    assert list(found) == ["9", "10", "a"]
    np.testing.assert_array_equal(found["10"], [1.5, 0.5])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("unit,t\n0,1\n", "no column cell; it has unit, t"),
        ("cell,t\n0,1\n0,late\n", "row 3 has t = 'late'"),
        ("cell,t\n,1\n", "spike 1 has cell =  and t = 1"),
        ("", "no column cell and no t"),
        ('cell,t\n"0,1\n', "it is damaged"),
    ],
)
def test_bad_spikes_are_told(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "spikes.csv").write_text(text, encoding="utf-8")
    with pytest.raises((ArenaError, CogmapError), match=said):
        read_spikes(tmp_path / "spikes.csv")
    with pytest.raises(ArenaError, match=r"cannot read .*none\.csv"):
        read_spikes(tmp_path / "none.csv")
