import json
import sys
from pathlib import Path

import pytest

from cogmap import CognitiveMap, cli


def run(monkeypatch: pytest.MonkeyPatch, *words: object) -> int:
    monkeypatch.setattr(sys, "argv", ["cogmap", "grow", *map(str, words)])
    try:
        cli.main()
    except SystemExit as left:
        return int(left.code or 0)
    return 0


def test_a_map_is_grown_and_told_of(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    sizes = ["--explorers", 3, "--views", 300, "--charts", 30, "--width", 90, "--height", 15, "--threads", 1]
    told = ["--set", "map.components=8", "--set", "motion.speed=0.3", "--set", "body.radius=0.15"]
    out = tmp_path / "map"
    assert run(monkeypatch, "open_field", "--out", out, *sizes, *told, "--nose-noise", 0.05, "--json") == 0
    said = json.loads(capsys.readouterr().out)
    assert (said["map"], said["charts"], said["explorers"], said["views"]) == (str(out), 30, 3, 300)
    assert said["trusted"] is False
    assert {"ways", "codes", "charts", "afferents"} <= said["seconds"].keys()
    cmap = CognitiveMap.load(out)
    assert (cmap.components, cmap.view_shape_) == (8, (15, 90, 3))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nowhere"], "nowhere"),
        (["furnished", "--explorers", 0], "explorers is 0"),
        (["furnished", "--set", "eye.width=3"], "unknown parameter 'eye'"),
        (["furnished", "--set", "map.colour=3"], "unknown parameter 'map.colour'"),
        (["furnished", "--set", "body=arm"], "many explorers are discs"),
        (["furnished", "--threads", 2, "--scheduler", "tcp://127.0.0.1:9"], "give one of them"),
    ],
)
def test_what_cannot_be_is_one_sentence(
    words: list[object],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(monkeypatch, *words, "--out", tmp_path / "map") == 2
    (sentence,) = capsys.readouterr().err.splitlines()
    assert said in sentence
    assert not list(tmp_path.iterdir())
