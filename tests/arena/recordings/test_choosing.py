from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import torch

from arena.errors import ArenaError
from arena.recordings import choosing
from arena.recordings.recording import Recording

COUNT = 5


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> tuple[Recording, Recording]:
    """One in memory, and the same on disk."""
    rng = np.random.default_rng(0)
    rec = Recording(
        views=rng.integers(0, 256, (COUNT, 2, 3, 3), dtype=np.uint8),
        times=np.arange(float(COUNT)),
        odours=rng.uniform(1, 2, (COUNT, 2)).astype(np.float32),
        poses=rng.normal(size=(COUNT, 3)),
        signals={"speed": rng.normal(size=COUNT), "paws": rng.normal(size=(COUNT, 2, 2))},
    )
    path = tmp_path_factory.mktemp("one") / "rec.zarr"
    rec.save(path)
    return rec, Recording.open(path)


@pytest.mark.parametrize(
    "key", [0, 4, -1, -5, np.int64(3), np.uint8(3), np.int64(-2), np.array(2), torch.tensor(2)], ids=repr
)
def test_one_view_is_a_row_of_every_array(recordings: tuple[Recording, ...], key: Any) -> None:
    for rec in recordings:
        moment = rec[key]
        np.testing.assert_array_equal(moment.views, rec.views[int(key)])
        assert moment.views.shape == (2, 3, 3)
        assert moment.times == rec.times[int(key)]
        np.testing.assert_array_equal(moment.odours, rec.require("odours")[int(key)])
        np.testing.assert_array_equal(moment.poses, rec.require("poses")[int(key)])
        assert (moment.commands, moment.joints) == (None, None)
        assert moment.signals["speed"] == rec.signals["speed"][int(key)]
        np.testing.assert_array_equal(moment.signals["paws"], rec.signals["paws"][int(key)])


def test_iteration_gives_every_view_once_and_ends(recordings: tuple[Recording, ...]) -> None:
    for rec in recordings:
        moments = list(rec)
        assert len(moments) == len(rec) == COUNT
        np.testing.assert_array_equal([moment.views for moment in moments], rec.views[:])
        np.testing.assert_array_equal([moment.times for moment in moments], rec.times)


def test_what_goes_by_numbers_alone_ends_too(recordings: tuple[Recording, ...]) -> None:
    """As the data loaders of torch and Python before `__iter__`: from 0 on, until there is an IndexError."""

    def numbered() -> Iterator[float]:
        number = 0
        while True:
            try:
                yield recordings[0][number].times
            except IndexError:
                return
            number += 1

    assert list(numbered()) == [0, 1, 2, 3, 4]


@pytest.mark.parametrize(
    ("key", "wanted"),
    [
        ([0, 3], [0, 3]),
        ([-1, 0, 0], [4, 0, 0]),
        ([True, False, True, False, False], [0, 2]),
        ([], []),
        (range(1, 3), [1, 2]),
        (np.array([4, -5], np.int8), [4, 0]),
        (np.array([4, 0], np.uint64), [4, 0]),
        (np.arange(COUNT) > 2, [3, 4]),
        (pd.Series([1, 2], index=[7, 8]), [1, 2]),
        (pd.Series([False, True, False, False, False]), [1]),
        (torch.tensor([1, -1]), [1, 4]),
        (slice(np.int64(3), None), [3, 4]),
        (slice(None, None, -2), [4, 2, 0]),
    ],
    ids=str,
)
def test_several_views_are_a_recording(
    recordings: tuple[Recording, ...], key: Any, wanted: list[int]
) -> None:
    for rec in recordings:
        some = rec[key]
        assert isinstance(some, Recording)
        np.testing.assert_array_equal(some.times, wanted)
        np.testing.assert_array_equal(some.views, recordings[0].views[np.array(wanted, int)])
        np.testing.assert_array_equal(some.signals["paws"], rec.signals["paws"][np.array(wanted, int)])


@pytest.mark.parametrize(
    ("key", "number"), [(5, 5), (-6, -6), ([5], 5), (np.int64(99), 99), ([0, 7, 9], 7), (np.array([-6]), -6)]
)
def test_past_either_end_is_an_index_error_in_our_words(
    recordings: tuple[Recording, ...], key: Any, number: int
) -> None:
    for rec in recordings:
        with pytest.raises(
            IndexError, match=f"no view {number} among 5; give a number from -5 to 4"
        ) as error:
            rec[key]
        assert isinstance(error.value, ArenaError)


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ([True], "the mask has 1 values for 5 views"),
        (np.ones(6, bool), "the mask has 6 values for 5 views"),
        (np.array([0.5, 1.0]), r"float64 of shape \(2,\) chooses no views"),
        (np.array([[0, 1]]), r"int64 of shape \(1, 2\) chooses no views"),
    ],
)
def test_what_chooses_no_views(recordings: tuple[Recording, ...], key: Any, words: str) -> None:
    with pytest.raises(ArenaError, match=words):
        recordings[0][key]


@pytest.mark.parametrize("key", [True, 1.5, None, "a", ..., (0, 1)], ids=repr)
def test_what_is_of_no_kind_that_chooses(key: Any) -> None:
    assert choosing.one(key, COUNT) is None
    with pytest.raises(ArenaError, match="chooses no views; give a number, a slice, a list"):
        choosing.several(key, COUNT)


def test_written_and_read_back(recordings: tuple[Recording, ...], tmp_path: Path) -> None:
    recordings[1][[4, 0]].save(tmp_path / "some.zarr")
    np.testing.assert_array_equal(Recording.open(tmp_path / "some.zarr").times, [4, 0])
