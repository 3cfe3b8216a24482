import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cogmap.experiments.paper.cyclic import _along_the_way


@given(st.floats(-np.pi, np.pi), st.floats(-5, 5))
def test_distance_along_the_way_does_not_depend_on_where_the_way_lies(angle: float, shift: float) -> None:
    rng = np.random.default_rng(0)
    along = rng.uniform(-1, 1, 500)
    along -= along.mean()
    across = rng.uniform(-0.1, 0.1, 500)
    across -= across.mean()
    across -= along * (across @ along) / (along @ along)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    found = _along_the_way(np.column_stack([along, across]) @ turn + shift)
    np.testing.assert_allclose(found * np.sign(found @ along), along, atol=1e-9)
