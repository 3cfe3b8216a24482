import numpy as np
import pytest

from arena import Brownian, Camera
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.registry import Experiment, experiments
from cogmap.experiments.result import Result


def toy(conditions: Conditions) -> Result:
    """Smell a little, and find what can be worked out beside it."""
    walk = conditions.explore(Brownian(), Camera.panoramic(16, 4), views=20)
    charts = conditions.map.get("charts", 100)
    if charts == 13:
        raise RuntimeError("thirteen charts\nare bad luck")
    return Result(
        {
            "smell": float(np.log(walk.odours).mean()),
            "by_charts": {"share": 1 / charts, "betti": [1, conditions.seed], "query_ms": 3.0},
            "seconds": {"toy": 1.0},
            "trusted": charts > 20,
            "reason": "" if charts > 20 else "too few charts",
        }
    )


@pytest.fixture(autouse=True)
def toys(monkeypatch: pytest.MonkeyPatch) -> None:
    everything = ("nose", "motion", "camera", "map")
    monkeypatch.setitem(experiments(), "toy", Experiment(toy, "furnished", 200, takes=everything))
    monkeypatch.setitem(experiments(), "at_home", Experiment(toy, "furnished", 200, any_room=False))
