import numpy as np
import pytest

from cogmap import Activity, CogmapError
from cogmap.map.novelty import KNOWN, check_known


def seen(*novelty: float) -> Activity:
    nothing = np.zeros((len(novelty), 2), np.float32)
    phase = np.zeros(len(novelty), np.float32)
    return Activity(nothing, nothing, phase, nothing, nothing, novelty=np.array(novelty))


def test_what_is_known_passes_and_the_least_known_is_named() -> None:
    check_known(seen(1.0, KNOWN), "goal")
    with pytest.raises(CogmapError, match=r"view 1 is nothing that this map remembers: .* 9\.0 times"):
        check_known(seen(KNOWN + 0.1, 9.0, 1.0), "view")


def test_a_map_that_was_not_refined_cannot_tell() -> None:
    nothing = np.zeros((2, 2), np.float32)
    check_known(Activity(nothing, nothing, np.zeros(2, np.float32), nothing, nothing), "view")
