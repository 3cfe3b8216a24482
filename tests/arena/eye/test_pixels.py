import numpy as np
import pytest

from arena.eye.pixels import copy, emit, finish
from arena.eye.render import PART
from arena.eye.texture_sampling import BLANK


@pytest.mark.parametrize("width", [8, 7])
def test_columns_become_rows(width: int) -> None:
    rng = np.random.default_rng(0)
    columns = rng.integers(0, 256, (width, 40)).astype(np.uint8)
    image, sky = np.zeros((12, 3 * width), np.uint8), np.zeros((1, 40), np.uint8)
    for c in range(0, width, 4):
        count = min(4, width - c)
        emit(columns[c : c + count], np.full((4, 2), (2, 9)), c, count, sky, image)
    np.testing.assert_array_equal(
        image.reshape(12, width, 3)[2:9], columns.reshape(width, 10, 4)[:, 2:9, :3].swapaxes(0, 1)
    )
    assert not image[[0, 1, 9, 10, 11]].any()


def test_columns_of_other_rows_are_filled_up_with_backdrop() -> None:
    sky = np.full((1, 40), 7, np.uint8)
    columns, image = np.full((4, 40), 9, np.uint8), np.zeros((10, 12), np.uint8)
    emit(columns, np.array([(2, 5), (4, 9), (3, 4), (8, 9)]), 0, 4, sky, image)
    wanted = np.full((7, 4), 7)
    for c, (first, last) in enumerate([(2, 5), (4, 9), (3, 4), (8, 9)]):
        wanted[first - 2 : last - 2, c] = 9
    np.testing.assert_array_equal(image.reshape(10, 4, 3)[2:9], np.repeat(wanted[..., None], 3, 2))
    assert not image[[0, 1, 9]].any()


def test_an_image_is_copied() -> None:
    image = np.random.default_rng(0).integers(1, 256, (6, 24)).astype(np.uint8)
    out = np.zeros_like(image)
    copy(image, out)
    np.testing.assert_array_equal(out, image)


def test_what_no_part_has_painted_is_backdrop_by_its_share() -> None:
    backdrop = np.full(40 + 128, 100, np.uint8)
    column, quad = np.full(len(backdrop), BLANK), np.zeros(len(backdrop), np.uint8)
    parts = np.zeros(2, PART)
    parts[0], parts[1] = (2, 6, 0.25), (4, 8, 0.75)
    # All of grey level 200.
    for first, last, share in parts.tolist():
        column[4 * first : 4 * last] += np.uint16(128 * 200 * share)
    rows = np.zeros(2, np.int64)
    finish(parts, 2, backdrop, column, quad, rows)
    assert rows.tolist() == [2, 8]
    levels = quad[8:32].reshape(6, 4)
    assert (levels[:, :3] == levels[:, :1]).all()
    np.testing.assert_array_equal(levels[:, 0], [125, 125, 200, 200, 175, 175])
    assert (column == BLANK).all()
