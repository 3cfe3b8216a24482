import pytest
import torch
from torch import Tensor

from neurons.atlas.atlas import Atlas
from neurons.atlas.disambiguation import place_branches

FIRST, SECOND = torch.tensor([-1.0, 0.0]), torch.tensor([1.0, 0.0])


@pytest.fixture(scope="module")
def charts() -> tuple[Tensor, Tensor, Tensor]:
    """Places (x, y), headings, and overlaps of charts on [−2, 2] × [−1, 1] × S¹."""
    generator = torch.Generator().manual_seed(0)
    uniform = torch.rand(1500, 3, generator=generator)
    place, heading = (
        uniform[:, :2] * torch.tensor([4.0, 2.0]) - torch.tensor([2.0, 1.0]),
        6.2832 * uniform[:, 2],
    )
    codes = torch.cat([place, 0.7 * torch.stack([heading.cos(), heading.sin()], dim=1)], dim=1)
    return place, heading, Atlas.of(codes).edges


def bump(place: Tensor, *centres: Tensor, width: float = 0.35) -> Tensor:
    return sum(torch.exp(-0.5 * ((place - centre) / width).square().sum(dim=1)) for centre in centres)


def test_a_unit_of_one_place_is_left_alone(charts: tuple[Tensor, Tensor, Tensor]) -> None:
    place, heading, edges = charts
    assert place_branches(bump(place, FIRST)[:, None], heading, edges).all()


def test_units_of_two_places_share_them_out(charts: tuple[Tensor, Tensor, Tensor]) -> None:
    place, heading, edges = charts
    both = bump(place, FIRST, SECOND)
    kept = place_branches(torch.stack([both] * 4, dim=1), heading, edges)
    near = {0: (place - FIRST).norm(dim=1) < 0.5, 1: (place - SECOND).norm(dim=1) < 0.5}
    sides = [0 if unit[near[0]].float().mean() > 0.5 else 1 for unit in kept.T]
    assert sorted(sides) == [0, 0, 1, 1]
    for side, unit in zip(sides, kept.T, strict=True):
        assert unit[near[side]].float().mean() > 0.98
        assert unit[near[1 - side]].float().mean() < 0.02


def test_a_place_that_is_covered_already_is_left_to_the_others(charts: tuple[Tensor, Tensor, Tensor]) -> None:
    place, heading, edges = charts
    rates = torch.stack([bump(place, FIRST, SECOND), bump(place, FIRST)], dim=1)
    kept = place_branches(rates, heading, edges)
    assert kept[:, 1].all()
    assert kept[(place - SECOND).norm(dim=1) < 0.5, 0].float().mean() > 0.98
    assert kept[(place - FIRST).norm(dim=1) < 0.5, 0].float().mean() < 0.02


@pytest.mark.parametrize(
    ("weak", "rival", "places"), [(0.5, 0.12, 2), (0.17, 0.12, 1), (0.5, 0.6, 1), (0.17, 0.05, 2)]
)
def test_a_faint_second_place_is_none(
    charts: tuple[Tensor, Tensor, Tensor], weak: float, rival: float, places: int
) -> None:
    place, heading, edges = charts
    rates = bump(place, FIRST) + weak * bump(place, SECOND)
    kept = place_branches(rates[:, None], heading, edges, rival=rival)
    assert kept.all() == (places == 1)
    # now the faint place has no active charts at all
    assert place_branches(rates[:, None], heading, edges, active=0.6, rival=rival).all()


def test_headings_apart_at_one_place_are_not_two_places(charts: tuple[Tensor, Tensor, Tensor]) -> None:
    place, heading, edges = charts
    gaps = (heading % 3.1416 - 1.5708).abs() > 0.5
    rates = bump(place, FIRST) * gaps
    assert place_branches(rates[:, None], heading, edges).all()


def test_without_a_compass_two_headings_that_no_turn_joins_are_two_places(
    charts: tuple[Tensor, Tensor, Tensor],
) -> None:
    place, heading, edges = charts
    ways = (heading.cos().abs() > 0.8) * bump(place, FIRST)
    kept = place_branches(ways[:, None], torch.full_like(heading, torch.nan), edges)[:, 0]
    ahead, back = (kept[(sign * heading.cos() > 0.8) & (ways > 0.3)].float().mean() for sign in (1, -1))
    assert sorted([round(float(ahead)), round(float(back))]) == [0, 1]


def test_silent_units_are_left_alone(charts: tuple[Tensor, Tensor, Tensor]) -> None:
    place, heading, edges = charts
    assert place_branches(torch.zeros(len(place), 2), heading, edges).all()
