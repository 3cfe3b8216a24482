import numpy as np
import pytest

from cogmap import CogmapError
from cogmap.plots import plot_translation

ALONG = np.linspace(-1, 1, 50)


def test_heights_stand_over_the_way_with_their_agreement() -> None:
    figure = plot_translation((ALONG + 1) / 2, ALONG, ALONG)
    axes = figure.axes[0]
    np.testing.assert_allclose(axes.collections[0].get_offsets(), np.column_stack([ALONG, (ALONG + 1) / 2]))
    assert "50 views, R² = 1.000" in axes.get_title()
    assert axes.get_xlabel().endswith("(m)")


def test_what_is_not_finite_is_refused() -> None:
    with pytest.raises(CogmapError, match="along is not finite"):
        plot_translation(ALONG, ALONG * np.nan, ALONG)
