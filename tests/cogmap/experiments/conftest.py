from collections.abc import Iterator

import pytest
from matplotlib.layout_engine import ConstrainedLayoutEngine


@pytest.fixture(scope="module", autouse=True)
def _no_layout() -> Iterator[None]:
    """Leave the parts of figures where they begin: to lay them out, which plots are tested for, is slow."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ConstrainedLayoutEngine, "execute", lambda *_: None)
        yield
