import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.plots import plot_fields
from tests.cogmap.plots.many_rooms.test_remapping import maps


def test_a_line_a_room_and_a_column_a_cell() -> None:
    rooms = {"study": maps(0), "wet_cellar": maps(1)}
    figure = plot_fields(rooms, 4)
    panels = np.reshape(figure.axes[:8], (2, 4))
    assert [axes.get_ylabel() for axes in panels[:, 0]] == ["study", "wet\ncellar"]
    for column in panels.T:
        cell = int(column[0].get_title().split()[1].rstrip(":"))
        top = max(np.nanmax(room.rates[cell]) for room in rooms.values())
        assert column[0].get_title() == f"cell {cell}: {top:.1f} Hz"
        for axes, room in zip(column, rooms.values(), strict=True):
            (mesh,) = axes.collections
            np.testing.assert_allclose(mesh.get_clim(), (0, top))
            drawn = np.ma.filled(mesh.get_array(), np.nan)
            np.testing.assert_allclose(np.nanmax(drawn), np.nanmax(room.rates[cell]))


def test_no_room_is_refused() -> None:
    with pytest.raises(CogmapError, match="no rooms to draw"):
        plot_fields({})
