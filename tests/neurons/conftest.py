from collections.abc import Callable, Iterator

import pytest
import torch
from threadpoolctl import threadpool_limits
from torch import Tensor

from neurons.layers.charts import Charts

Codes = Callable[[Tensor], Tensor]


def _turning(pose: Tensor) -> Tensor:
    """Unit vectors of turning on the spot."""
    nought = torch.zeros(len(pose))
    return torch.stack([nought, nought, -pose[:, 2].sin(), pose[:, 2].cos()], dim=1)


@pytest.fixture(autouse=True, scope="module")
def one_thread() -> Iterator[None]:
    """As in production: small matrices only lose time on two threads."""
    with threadpool_limits(limits=1):
        yield


@pytest.fixture(scope="session")
def radius() -> float:
    return 0.5


@pytest.fixture(scope="session")
def cylinder(radius: float) -> Codes:
    """Codes (x, y, r cos θ, r sin θ) of poses (x, y, θ): the simplest manifold of views."""

    def codes(pose: Tensor) -> Tensor:
        x, y, heading = pose.T
        return torch.stack([x, y, radius * heading.cos(), radius * heading.sin()], dim=1)

    return codes


@pytest.fixture(scope="session")
def poses() -> Callable[[int, int], Tensor]:
    """So many poses from a seed: x and y in a square metre, θ around the circle."""

    def draw(count: int, seed: int) -> Tensor:
        uniform = torch.rand(count, 3, generator=torch.Generator().manual_seed(seed))
        return uniform * torch.tensor([1.0, 1.0, 2 * torch.pi])

    return draw


@pytest.fixture(scope="session")
def turning() -> Codes:
    return _turning


@pytest.fixture(scope="session")
def tiling(cylinder: Codes, poses: Callable[[int, int], Tensor]) -> tuple[Tensor, Charts]:
    """Poses of chart centres on the cylinder, and charts with exact tangents, each in a basis of its own."""
    pose = poses(1200, 0)
    generator = torch.Generator().manual_seed(1)
    walking = torch.eye(4)[:2].expand(len(pose), 2, 4)
    exact = torch.cat([walking, _turning(pose)[:, None]], dim=1)
    charts = Charts(len(pose), 4, 3, generator=generator)
    charts.centres = cylinder(pose)
    charts.tangents = torch.linalg.qr(torch.randn(len(pose), 3, 3, generator=generator)).Q @ exact
    return pose, charts
