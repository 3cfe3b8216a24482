from collections.abc import Iterator

import pytest

from cogmap.coordinates import view_code


@pytest.fixture(scope="package", autouse=True)
def _short_lesson() -> Iterator[None]:
    """Learn components from fewer batches."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(view_code, "STEPS", 60)
        yield
