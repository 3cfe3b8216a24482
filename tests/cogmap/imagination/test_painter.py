import numpy as np
import pytest

from cogmap.imagination.painter import Painter, Turned
from cogmap.imagination.places import RememberedPlaces


@pytest.mark.parametrize(("method", "sense"), [("turned", 1), ("turned", -1), ("blend", 1), ("warp", 1)])
def test_a_view_is_seen_again_where_it_was_taken_and_turned_as_phase_runs(
    method: Turned, sense: int, remembered: tuple[np.ndarray, np.ndarray]
) -> None:
    views, poses = (part[:40] for part in remembered)
    places = RememberedPlaces(views, poses[:, :2], poses[:, 2])
    sources = places.sources(poses[:3, :2], 4)
    sources = sources.alone() if method == "turned" else sources
    painter, column = Painter(places, sense), 2 * np.pi / views.shape[2]
    for turn, shift in ((0.0, 0), (20 * column, sense * 20)):
        for painted, view in zip(painter.paint(sources, poses[:3, 2] + turn, method), views, strict=False):
            shown = np.roll(view, shift, axis=1).astype(float)
            assert np.abs(painted.view - shown).mean() < (1e-3 if method == "turned" else 0.5)
