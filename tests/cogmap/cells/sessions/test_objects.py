from types import SimpleNamespace

import neo
import numpy as np
import pandas as pd
import pynapple
import pytest
import quantities as pq

from cogmap.cells import session
from cogmap.errors import CogmapError

pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning:(pynapple|xarray|neo|quantities).*")


def test_pynapple(rat) -> None:
    group = pynapple.TsGroup({7 + index: pynapple.Ts(train) for index, train in enumerate(rat.trains)})
    places = pynapple.TsdFrame(rat.times, 100 * rat.positions, columns=["x", "y"])
    turns = pynapple.Tsd(rat.times, rat.headings)
    found = session(group, track=(places, turns), unit="cm")
    np.testing.assert_array_equal(found.counts, rat.counts)
    np.testing.assert_allclose(found.positions, rat.positions, atol=1e-9)
    np.testing.assert_allclose(found.headings, rat.headings, atol=1e-12)
    assert found.names == tuple(str(7 + index) for index in range(len(rat.trains)))
    assert session(group, track=places, unit="cm").headings is None
    part = session(group, track=places.restrict(pynapple.IntervalSet(103, 203)), unit="cm")
    np.testing.assert_array_equal(part.counts, rat.counts[(rat.times >= 103) & (rat.times <= 203)])


def test_neo_by_its_own_units(rat) -> None:
    trains = [
        neo.SpikeTrain(1000 * train * pq.ms, t_stop=700_000 * pq.ms, name=f"unit {index}")
        for index, train in enumerate(rat.trains)
    ]
    segment = neo.Segment()
    segment.spiketrains.extend(trains)
    places = neo.IrregularlySampledSignal(1000 * rat.times * pq.ms, 100 * rat.positions * pq.cm)
    turns = neo.IrregularlySampledSignal(rat.times * pq.s, np.rad2deg(rat.headings) * pq.deg)
    block = neo.Block()
    block.segments.append(segment)
    for source in (segment, block, trains):
        found = session(source, track=(places, turns))
        np.testing.assert_array_equal(found.counts, rat.counts)
        np.testing.assert_allclose(found.positions, rat.positions, atol=1e-9)
        np.testing.assert_allclose(found.headings, rat.headings, atol=1e-9)
        assert found.names[:2] == ("unit 0", "unit 1")
    block.segments.append(neo.Segment())
    with pytest.raises(CogmapError, match="2 segments; give one"):
        session(block, track=places)
    with pytest.raises(CogmapError, match="headings are float"):
        session(trains, track=(places, 3.0))
    pixels = neo.AnalogSignal(rat.positions, units="dimensionless", sampling_rate=20 * pq.Hz)
    with pytest.raises(CogmapError, match="'dimensionless', which is no length"):
        session(trains, track=pixels)


def test_trains_without_names_are_counted() -> None:
    train = neo.SpikeTrain([0.5, 1.5] * pq.s, t_stop=3)
    track = (np.arange(4.0), np.zeros((4, 2)))
    assert session([train, train], track=track).names == ("0", "1")
    assert session({"a": train, "b": [0.1]}, track=track).names == ("a", "b")


def test_plain_arrays_tables_and_recordings(rat) -> None:
    expected = rat.counts
    ragged = np.empty(len(rat.trains), dtype=object)
    ragged[:] = rat.trains
    lengths = [len(train) for train in rat.trains]
    table = pd.DataFrame(
        {"cell": np.repeat(np.arange(len(lengths)), lengths), "t": np.concatenate(rat.trains)}
    ).sample(frac=1, random_state=0)
    walked = pd.DataFrame(
        {"t": rat.times, "x": rat.positions[:, 0], "y": rat.positions[:, 1],
         "heading_deg": np.rad2deg(rat.headings)}
    )  # fmt: skip
    recording = SimpleNamespace(times=rat.times, poses=np.c_[rat.positions, rat.headings])
    before = session(rat.trains, track=rat.track)
    for source in (rat.trains, ragged, table, dict(enumerate(rat.trains))):
        for track in (rat.track, walked, recording, before):
            found = session(source, track=track)
            np.testing.assert_array_equal(found.counts, expected)
            np.testing.assert_allclose(found.headings, rat.headings, atol=1e-9)
    assert session(table, track=rat.track).names == tuple(map(str, range(22)))
    with pytest.raises(CogmapError, match="both heading and heading_deg"):
        session(rat.trains, track=walked.assign(heading=0.0))
