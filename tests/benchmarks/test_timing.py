import time
from collections.abc import Callable

import pytest

from benchmarks.timing import versus


def test_ratio_is_of_speeds_with_its_spread(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 0.0

    def lasting(units: int, *seconds: float) -> Callable[[], int]:
        turns = iter(seconds)

        def work() -> int:
            nonlocal now
            now += next(turns)
            return units

        return work

    monkeypatch.setattr(time, "perf_counter", lambda: now)
    found = versus(lasting(8, 9, 1, 2, 4), lasting(1, 9, 1, 1, 2), 3, beside="a snail")
    assert found == {
        "peer": "a snail",
        "per_s": 8,
        "peer_per_s": 1,
        "ratio": 8,
        "ratio_median": 4,
        "ratio_lowest": 4,
        "ratio_highest": 8,
    }
