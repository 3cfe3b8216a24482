import numpy as np
import pytest
import torch

from cogmap import Betti
from cogmap.map import topology
from neurons.layers.charts import Charts
from tests.cogmap.shape.numbers import betti_of


def test_charts_as_seen_and_as_seen_and_smelt(monkeypatch: pytest.MonkeyPatch) -> None:
    clouds: list[np.ndarray] = []

    def counted(cloud: np.ndarray) -> Betti:
        clouds.append(cloud)
        return betti_of((1, 1, 0) if len(clouds) > 1 else (1, 2, 0))

    monkeypatch.setattr(topology, "betti", counted)
    charts = Charts(40, 5, 3, generator=torch.Generator().manual_seed(0))
    charts.centres, charts.smells = torch.rand(40, 5), torch.rand(40, 3)
    found = topology.homology_of_charts(charts)
    for cloud, measured in zip(clouds, (charts.centres, charts.points), strict=True):
        np.testing.assert_array_equal(cloud, measured)
    assert found["seen"].resolved == (True, False, True)
    assert "aliased" in found["seen"].reasons[1]
    assert all(found["seen_and_smelt"].resolved)
