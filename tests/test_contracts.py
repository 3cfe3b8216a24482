"""The import contracts that `make lint` checks are all there, and none has a hole."""

import itertools
import tomllib
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[1] / "pyproject.toml"
NEVER = {
    (
        "cogmap.map",
        "cogmap.features",
        "cogmap.graph",
        "cogmap.shape",
        "cogmap.navigation",
        "cogmap.imagination",
        "cogmap.coordinates",
    ): ("cogmap.evaluation", "cogmap.experiments"),
    ("cogmap.coordinates",): ("cogmap.navigation", "cogmap.imagination", "cogmap.control"),
    ("cogmap.navigation", "cogmap.imagination"): ("cogmap.control",),
    ("cogmap.graph", "cogmap.shape", "cogmap.map", "cogmap.coordinates"): ("arena",),
    ("neurons",): ("arena", "cogmap"),
    ("arena",): ("neurons", "cogmap"),
}

KEYS = {"name", "type", "source_modules", "forbidden_modules", "ignore_imports"}
"""Nothing else: `allow_indirect_imports` would be a hole."""
TOOLS = ["cogmap.atomic -> arena.atomic", "cogmap.kernels -> arena.kernels", "cogmap.** -> arena.angles"]
"""The exceptions: how files are written, loops compiled and angles wrapped, which tells nothing of a room."""


@pytest.mark.parametrize(
    "arrow", [arrow for names in NEVER.items() for arrow in itertools.product(*names)], ids=" → ".join
)
def test_a_forbidden_import_has_its_contract(arrow: tuple[str, str]) -> None:
    contracts = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["tool"]["importlinter"]["contracts"]
    strict = [
        contract
        for contract in contracts
        if contract.keys() <= KEYS
        and contract["type"] == "forbidden"
        and contract.get("ignore_imports", TOOLS) == TOOLS
    ]
    assert any(
        arrow[0] in contract["source_modules"] and arrow[1] in contract["forbidden_modules"]
        for contract in strict
    )


def test_cogmap_stands_on_neurons_and_arena() -> None:
    settings = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["tool"]["importlinter"]
    assert settings.keys() == {"root_packages", "contracts"}
    assert ["cogmap", "neurons | arena"] in [contract.get("layers") for contract in settings["contracts"]]
