"""The nerve of covers whose union is known."""

import gudhi
import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.shape.nerve import ACTIVE, population_nerve

VIEWS = np.linspace(-np.pi, np.pi, 360, endpoint=False)


def arcs(count: int, width: float) -> np.ndarray:
    """Cells that fire on arcs of the circle, `width` rad to either side of their middle."""
    middle = np.linspace(-np.pi, np.pi, count, endpoint=False)
    apart = np.angle(np.exp(1j * (VIEWS[:, None] - middle)))
    return 20.0 * (np.abs(apart) < width)


def fields(xy: np.ndarray, spacing: float = 0.25, width: float = 0.2) -> np.ndarray:
    """Gaussian fields on a grid, as wide as those of place cells."""
    along = np.arange(-1.5, 1.51, spacing)
    centres = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
    rates = 20 * np.exp(-0.5 * (np.linalg.norm(xy[:, None] - centres, axis=2) / width) ** 2)
    return rates[:, rates.max(axis=0) > 10]


def scattered(count: int = 4000) -> np.ndarray:
    return np.random.default_rng(0).uniform(-1.5, 1.5, (count, 2))


def test_three_arcs_that_meet_at_their_ends_close_a_circle() -> None:
    found = population_nerve(arcs(3, 1.2))
    assert found.numbers == (1, 1)
    assert found.simplices == (3, 3, 0)


def test_where_three_arcs_share_a_view_nothing_is_left_open() -> None:
    found = population_nerve(np.concatenate([arcs(3, 1.2), np.full((3, 3), 20.0)]))
    assert found.numbers == (1, 0)
    assert found.simplices == (3, 3, 1)


def test_two_arcs_that_meet_twice_deceive() -> None:
    # the theorem asks for intersections in one piece
    assert population_nerve(arcs(2, 2.0)).numbers == (1, 0)


@pytest.mark.parametrize("count", [4, 12, 60])
def test_more_arcs_make_the_same_circle(count: int) -> None:
    assert population_nerve(arcs(count, 0.9), max_dimension=2).numbers == (1, 1, 0)


def test_arcs_that_leave_gaps_are_pieces() -> None:
    assert population_nerve(arcs(5, 0.5)).numbers == (5, 0)


def test_fields_on_a_square_leave_no_hole() -> None:
    assert population_nerve(fields(scattered())).numbers == (1, 0)


@pytest.mark.parametrize("holes", [1, 2])
def test_fields_around_pillars_leave_their_holes(holes: int) -> None:
    xy = scattered()
    for x in (-0.7, 0.7)[:holes]:
        xy = xy[np.linalg.norm(xy - [x, 0], axis=1) > 0.5]
    assert population_nerve(fields(xy)).numbers == (1, holes)


def test_fields_on_a_shell_leave_a_void() -> None:
    points = np.random.default_rng(1).normal(size=(4000, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    rates = 20 * np.exp(6 * (points @ points[:40].T - 1))
    assert population_nerve(rates, max_dimension=2).numbers == (1, 0, 1)


def test_simplices_are_the_sets_that_some_views_share() -> None:
    rng = np.random.default_rng(2)
    fires = rng.random((300, 12)) < 0.25
    complex_ = gudhi.SimplexTree()
    for one in range(12):
        for other in range(one, 12):
            for third in range(other, 12):
                if fires[:, [one, other, third]].all(axis=1).sum() >= 6:
                    complex_.insert(sorted({one, other, third}))
    complex_.compute_persistence(persistence_dim_max=True)
    found = population_nerve(fires * rng.uniform(5, 20, 12), together=6)
    assert found.numbers == tuple(complex_.betti_numbers()[:2])
    assert sum(found.simplices) == complex_.num_simplices()


def test_every_cell_is_judged_by_its_own_peak() -> None:
    rates = arcs(3, 1.2)
    np.testing.assert_equal(population_nerve(rates * np.array([1, 0.01, 100])), population_nerve(rates))


def test_active_is_a_share_of_the_peak() -> None:
    rates = np.zeros((20, 2))
    rates[:10, 0] = rates[10:, 1] = 10
    rates[:5, 1] = 10 * ACTIVE * 0.99
    assert population_nerve(rates).numbers == (2, 0)
    rates[:5, 1] = 10 * ACTIVE * 1.01
    assert population_nerve(rates).numbers == (1, 0)
    assert population_nerve(rates, active=0.5).numbers == (2, 0)


def test_too_few_views_join_nothing() -> None:
    rates = np.zeros((20, 2))
    rates[:10, 0] = rates[8:, 1] = 1
    assert population_nerve(rates).numbers == (2, 0)
    rates[7, 1] = 1
    assert population_nerve(rates).numbers == (1, 0)


def test_silent_cells_are_left_out() -> None:
    rates = np.column_stack([np.zeros(len(VIEWS)), arcs(3, 1.2), np.zeros(len(VIEWS))])
    assert population_nerve(rates) == population_nerve(arcs(3, 1.2))


@pytest.mark.parametrize(
    ("rates", "options", "says"),
    [
        (np.zeros((10, 3)), {}, "no cell is active in 3 views"),
        (np.ones((10, 3)), {"active": 0.0}, "active is 0"),
        (np.ones((10, 3)), {"active": 1.1}, r"active is 1\.1"),
        (np.ones((10, 3)), {"together": 0}, "together is 0"),
        (np.ones((10, 3)), {"max_dimension": 3}, "max_dimension is 3"),
        (-np.ones((10, 3)), {}, "never negative"),
        (np.full((10, 3), np.nan), {}, "not finite"),
        (np.ones((0, 3)), {}, "one row per view"),
    ],
)
def test_what_has_no_nerve_is_refused(rates: np.ndarray, options: dict[str, float], says: str) -> None:
    with pytest.raises(CogmapError, match=says):
        population_nerve(rates, **options)
