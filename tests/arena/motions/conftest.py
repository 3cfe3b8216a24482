from collections.abc import Callable

import numpy as np
import pytest

from arena.rooms.arena import Arena


@pytest.fixture(scope="session")
def random_room() -> Callable[[int], Arena]:
    """A room with boxes, walls and a pillar at random on its platform, and three odours."""

    def make(seed: int) -> Arena:
        rng = np.random.default_rng(seed)
        half = rng.uniform(0.8, 2.5, 2)
        corners = (half * [[-1, -1], [1, -1], [1, 1], [-1, 1]]).tolist()
        ends = rng.uniform(-half, half, (2, 2, 2)).tolist()
        parts = {
            "platform": [corners],
            "walls": [
                {"start": a, "end": b, "material": "brick"}
                for a, b in [*zip(corners, corners[1:] + corners[:1], strict=True), *ends]
            ],
            "boxes": [
                {
                    "center": rng.uniform(-half, half).tolist(),
                    "size": rng.uniform(0.1, 0.6, 2).tolist(),
                    "angle_deg": rng.uniform(0, 90),
                    "material": "timber",
                }
                for _ in range(rng.integers(3))
            ],
            "pillars": [
                {"center": rng.uniform(-half, half).tolist(), "radius": 0.2, "material": "granite"}
                for _ in range(rng.integers(2))
            ],
        }
        blank = Arena.create(name="random", **parts)
        sources = [{"position": place} for place in blank.sample_free(3, 0.1, rng).tolist()]
        return Arena.create(name="random", **parts, sources=sources)

    return make
