from typing import Any

import pytest

from arena import ArenaError, Arm, Babble, Camera, Neck, Nose, Overhead
from cogmap.errors import CogmapError
from cogmap.experiments.parameters import build, by_family, parse


@pytest.mark.parametrize(
    ("pairs", "usual", "made"),
    [
        (["body=arm", "body.limits=one", "body.links=[0.7, 0.6, 0.5]"], "disc",
         Arm(limits="one", links=(0.7, 0.6, 0.5))),
        (["body.limits=both"], "arm", Arm(limits="both")),
        (["body.deck=seen"], "neck", Neck(deck="seen")),
        (["motion=babble", "motion.swing_every=100"], "disc", Babble(swing_every=100)),
        (["camera=overhead", "camera.span=5.0"], "disc", Overhead(span=5.0)),
        (["camera.width=90", "camera.height=15"], "disc", Camera.panoramic(90, 15)),
        (["nose.noise=0.2"], "disc", Nose(noise=0.2)),
        (["map.charts=400"], "disc", {"charts": 400}),
    ],
)  # fmt: skip
def test_parts_are_made_of_what_is_set(pairs: list[str], usual: str, made: Any) -> None:
    ((family, told),) = by_family(parse(pairs)).items()
    assert build(family, told, usual=usual) == made


def test_values_are_as_in_toml_or_words() -> None:
    told = parse(["a=1", "b=1.5", "c=one", 'd="1"', "e=true", "f=x=y", "g=[1"])
    assert told == {"a": 1, "b": 1.5, "c": "one", "d": "1", "e": True, "f": "x=y", "g": "[1"}


@pytest.mark.parametrize(
    ("pairs", "message"),
    [
        (["body.limts=one"], "did you mean 'body.limits'"),
        (["body=leg"], "leg"),
        (["body.limits=some"], "is 'some'"),
        (["body"], "'body' sets nothing"),
        (["=1"], "sets nothing"),
    ],
)
def test_what_cannot_be_is_one_sentence(pairs: list[str], message: str) -> None:
    with pytest.raises((ArenaError, CogmapError), match=message):
        build("body", by_family(parse(pairs))["body"], usual="arm")
