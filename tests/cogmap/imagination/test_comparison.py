from typing import Any

import numpy as np
import pytest

from cogmap.imagination import Imagination
from cogmap.imagination.alignment import Seen
from cogmap.imagination.comparison import Comparison


def test_what_only_one_of_two_dreams_gets_wrong_does_not_surprise(
    dream: Imagination, remembered: tuple[np.ndarray, np.ndarray], monkeypatch: pytest.MonkeyPatch
) -> None:
    plain, asked = Comparison.seen, []

    def seen(self: Comparison, *told: Any, again: bool = False) -> Seen:
        found = plain(self, *told, again=again)
        asked.append(again)
        if not again:
            found.unusual[:, 5, 5] += 50
        return found

    monkeypatch.setattr(Comparison, "seen", seen)
    waking = Imagination(dream.cmap, memory=dream.memory)
    waking.__dict__["threshold"] = 40.0
    assert not waking.surprise(remembered[0][-6:]).alarms.any()
    assert any(asked)
