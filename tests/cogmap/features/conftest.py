import numpy as np
import pytest

from arena import Arena, Camera


@pytest.fixture(scope="session")
def views() -> np.ndarray:
    """A hundred small views along a turn."""
    heading = np.linspace(-np.pi, np.pi, 100, endpoint=False)
    poses = np.column_stack([np.full((100, 2), 0.3), heading])
    return Camera.perspective(120, 90).render(Arena.load("furnished"), poses)
