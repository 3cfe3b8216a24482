from collections.abc import Iterator

import pytest
from matplotlib.figure import Figure


@pytest.fixture(scope="module", autouse=True)
def _no_layout() -> Iterator[None]:
    """Leave the parts of figures where they begin, and draw them once: how they lie is tested elsewhere."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "get_layout_engine", lambda _: None)
        yield
