import numpy as np
import pytest
import shapely
from hypothesis import given, settings

from arena.errors import ArenaError
from arena.rooms.arena import Arena
from arena.rooms.parts import PILLAR_SIDES, Block, Box, Pillar
from tests.arena import strategies

FOUR = ("brick", "oak", "tiles", "marble")


def with_parts(**parts: object) -> Arena:
    wall = {"start": (-9.0, -9.0), "end": (9.0, -9.0), "material": "granite"}
    return Arena.create(name="parts", platform=[[(0, 0), (1, 0), (0, 1)]], walls=[wall], **parts)


def facing(part: Box | Block | Pillar, side: int) -> float:
    """Where a side looks, degrees."""
    dx, dy = np.roll(part.outline, -1, axis=0)[side] - part.outline[side]
    return float(np.rad2deg(np.arctan2(-dx, dy)))


@pytest.mark.parametrize("turn", [0.0, 30.0, -200.0])
def test_sides_of_a_box_are_front_right_back_left_of_it_unturned(turn: float) -> None:
    box = Box(center=(1.0, 2.0), size=(0.4, 0.2), angle_deg=turn, material=FOUR)
    assert box.sides == FOUR
    for side, direction in enumerate([-90, 0, 90, 180]):
        assert np.cos(np.deg2rad(facing(box, side) - direction - turn)) == pytest.approx(1)
    middle = box.outline.mean(axis=0)
    np.testing.assert_allclose(middle, [1, 2])
    assert shapely.Polygon(box.outline).area == pytest.approx(0.08)
    assert Box(center=(0, 0), size=(1, 1), material="oak").sides == 4 * ("oak",)


def test_a_pillar_is_a_prism() -> None:
    pillar = Pillar(center=(1.0, 2.0), radius=0.5, material="oak")
    np.testing.assert_allclose(np.linalg.norm(pillar.outline - (1, 2), axis=1), 0.5)
    assert shapely.Polygon(pillar.outline).area == pytest.approx(16 * 0.25 * np.sin(np.pi / 16))
    assert pillar.sides == ("oak",) * PILLAR_SIDES


HOOK = [(0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (2.0, 2.0), (2.0, 1.0), (0.0, 1.0)]
EACH = ("brick", "oak", "tiles", "marble", "plaid", "books")


def test_a_block_keeps_each_material_on_its_side_whichever_way_it_is_listed() -> None:
    block = Block(corners=tuple(HOOK), material=EACH)
    assert block.outline.tolist() == [list(corner) for corner in HOOK]
    assert block.sides == EACH
    # The same sides listed clockwise: the last joins the new first corner to the new last.
    mirrored = Block(corners=tuple(HOOK[::-1]), material=(*EACH[-2::-1], EACH[-1]))
    assert shapely.LinearRing(mirrored.outline).is_ccw
    assert mirrored.outline[0].tolist() == list(HOOK[-1])

    def looks(part: Block) -> set[tuple[float, ...]]:
        ends = np.stack([part.outline, np.roll(part.outline, -1, axis=0)], axis=1).reshape(-1, 4)
        return {(*end, name) for end, name in zip(ends.tolist(), part.sides, strict=True)}

    assert looks(mirrored) == looks(block)
    assert Block(corners=tuple(HOOK), material="oak").sides == 6 * ("oak",)


@settings(deadline=None)
@given(strategies.blocks())
@pytest.mark.filterwarnings("ignore:Do not use the `random` module")
def test_outlines_of_blocks_are_counter_clockwise_and_of_the_same_ground(fields: dict[str, object]) -> None:
    block = Block.model_validate(fields)
    ring = shapely.LinearRing(block.outline)
    assert ring.is_ccw
    assert ring.equals(shapely.LinearRing(fields["corners"]))
    assert len(block.sides) == len(block.outline)
    assert sorted(map(tuple, block.outline.tolist())) == sorted(fields["corners"])


BLOCK = {"corners": HOOK, "material": "oak"}
BOX = {"center": (0.0, 0.0), "size": (1.0, 1.0), "material": "oak"}


@pytest.mark.parametrize(
    ("parts", "says"),
    [
        ({"blocks": [{**BLOCK, "corners": HOOK[:2]}]}, "blocks.0.corners: .* at least 3 items"),
        (
            {"blocks": [{**BLOCK, "corners": [*HOOK, HOOK[-1]]}]},
            "blocks.0.corners: corner 5 and the next are the",
        ),
        (
            {"blocks": [{**BLOCK, "corners": [HOOK[i] for i in (0, 2, 1, 3)]}]},
            "blocks.0.corners: .* crosses itself",
        ),
        ({"blocks": [{**BLOCK, "corners": [(0, 0), (1, 1), (2, 2)]}]}, "blocks.0.corners: .* is flat"),
        (
            {"blocks": [BLOCK, {**BLOCK, "material": FOUR}]},
            "blocks.1: 4 materials for 6 sides; give one name or",
        ),
        (
            {"blocks": [{**BLOCK, "material": (*FOUR, "mud", "oak")}]},
            "blocks.0.material.4 is 'mud': unknown material",
        ),
        ({"blocks": [{**BLOCK, "height": 0.0}]}, "blocks.0.height is 0.0"),
        ({"boxes": [BOX, {**BOX, "material": FOUR[:3]}]}, "boxes.1.material.3: Field required"),
        ({"boxes": [{**BOX, "material": (*FOUR[:2], "mud", "oak")}]}, "boxes.0.material.2 is 'mud': unknown"),
        (
            {"boxes": [{**BOX, "material": "mud"}]},
            "boxes.0.material is 'mud': unknown material; choose one of blue,",
        ),
        ({"boxes": [{**BOX, "material": 3}]}, "boxes.0.material is 3"),
        (
            {"boxes": [BOX, BOX, {**BOX, "size": (-1.0, 1.0)}]},
            "boxes.2.size.0 is -1.0: Input should be greater",
        ),
        ({"boxes": [{**BOX, "size": (True, 1.0)}]}, "boxes.0.size.0 is True: Input should be a valid number"),
        ({"boxes": [{**BOX, "height": "1"}]}, "boxes.0.height is '1': Input should be a valid number"),
        ({"boxes": [{**BOX, "center": (2e3, 0.0)}]}, "boxes.0.center.0 is 2000.0: "),
        ({"boxes": [{**BOX, "angle_deg": 400.0}]}, "boxes.0.angle_deg is 400.0"),
        (
            {"pillars": [{"center": (0.0, 0.0), "radius": 1e-9, "material": "oak"}]},
            "pillars.0.radius is 1e-09",
        ),
    ],
)
def test_mistakes_name_the_key(parts: dict[str, object], says: str) -> None:
    with pytest.raises(ArenaError, match=f"^{says}") as error:
        with_parts(**parts)
    assert len(str(error.value).splitlines()) == 1
