import pytest

from cogmap.shape.agreement import unless_aliased, unless_contradicted, unless_lower_is_unresolved
from tests.cogmap.shape.numbers import betti_of


def test_sight_is_resolved_where_smell_tells_the_same() -> None:
    alone, joint = betti_of((1, 3, 0), ("", "", "close")), betti_of((1, 1, 0))
    told = "aliased: sight alone says [1, 3, 0], with smell [1, 1, 0]"
    assert unless_aliased(alone, joint).reasons == ("", told, "close")
    assert unless_aliased(joint, joint).resolved == (True,) * 3
    unsure = unless_aliased(joint, betti_of((1, 1, 0), ("", "it is close", "")))
    assert unsure.reasons == ("", "with smell it is close", "")


@pytest.mark.parametrize(
    ("place", "resolved"),
    [((1, 1, 0), (True, True, True)), ((1, 0, 0), (True, False, False)), ((1, 2, 0), (True, False, False))],
)
def test_places_are_multiplied_by_the_circle_of_headings(
    place: tuple[int, ...], resolved: tuple[bool, ...]
) -> None:
    assert unless_aliased(betti_of(place), betti_of((1, 2, 1)), turning=True).resolved == resolved


def test_what_another_cloud_counts_otherwise_is_not_resolved() -> None:
    bulging, flat = betti_of((1, 2, 1), ("", "", "close")), betti_of((1, 1, 0), ("", "close", ""))
    told = "the fused map says [1, 1, 0]"
    assert unless_contradicted(bulging, flat, "the fused map").reasons == ("", told, "close")
    assert unless_contradicted(bulging, bulging, "itself").reasons == bulging.reasons
    assert unless_contradicted(betti_of((1, 1, 0)), flat, "itself").resolved == (True,) * 3


def test_voids_are_resolved_only_where_loops_are() -> None:
    found = unless_lower_is_unresolved(betti_of((1, 4, 2), ("", "close", "")))
    assert found.reasons == ("", "close", "H1 is unresolved")
    assert unless_lower_is_unresolved(betti_of((1, 4, 2), ("a", "b", "c"))).reasons == ("a", "b", "c")
    assert unless_lower_is_unresolved(betti_of((1, 4, 2), ("", "", "c"))).reasons == ("", "", "c")
