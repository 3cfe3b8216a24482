"""Every measure that tables and metrics of the code name is defined, with all that is asked of it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np
import pytest

import cogmap
from cogmap.cells import autocorrelograms, grid_statistics, heading_statistics, place_statistics, rate_maps
from tests.docs.snippets import DOCS, ROOT

ASKED = ("Formula", "Unit", "Source", "Good", "Traps")
MEASURES = re.compile(
    r"(_(m|m2|deg|rad|hz|db|ms|p|r2|median|mean|variance|max|p05|p95|passing|ratio|share|resultant|correlation"
    r"|coverage|touching|found|vote|catchment|margins?|determinant|betti|resolved|rejected)"
    r"|auc|ssim|gridness|coherence|stability|sparsity|selectivity|spatial_information|passing|success|confusion"
    r"|deviation_\w+|distortion_\w+|dimension|betti|false_\w+|within_\w+|reached_\w+|touched|novelty)$"
)
"""What keys of metrics and columns of tables end in when they are measures."""
NO_MEASURES = {"babbling_s"}


def sections() -> dict[str, tuple[str, str]]:
    """Every name that is defined, with the page and the text of its section."""
    found = {}
    for page in sorted((DOCS / "measures").glob("*.md")):
        for section in page.read_text(encoding="utf-8").split("\n## ")[1:]:
            heading, _, text = section.partition("\n")
            also = "".join(re.findall(r"^:Also: (.*)$", text, re.MULTILINE))
            for name in re.findall(r"`([^`]+)`", heading + also):
                found[name] = (page.name, text)
    return {name: told for name, told in found.items() if not name.endswith("_")}


DEFINED = sections()


def is_defined(name: str) -> bool:
    return any(name == known or fnmatchcase(name, known) for known in DEFINED)


def keys_of(path: Path) -> Iterator[str]:
    """Names of entries that a module makes or takes: keys of dictionaries, what stands in brackets."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        keys = (
            node.keys
            if isinstance(node, ast.Dict)
            else [node.slice]
            if isinstance(node, ast.Subscript)
            else []
        )
        for key in keys:
            if isinstance(key, ast.Constant) and isinstance(key.value, str):
                yield key.value
            elif isinstance(key, ast.JoinedStr):
                yield "".join(
                    str(part.value) if isinstance(part, ast.Constant) else "*" for part in key.values
                )


def test_every_measure_that_the_code_names_is_defined() -> None:
    named: dict[str, str] = {}
    for folder in ("cells", "evaluation", "experiments"):
        for path in sorted((ROOT / "cogmap" / folder).rglob("*.py")):
            named |= {key: path.name for key in keys_of(path) if MEASURES.search(key) and "/" not in key}
    assert len(named) > 80
    missing = {key: file for key, file in named.items() if not is_defined(key)}
    assert not missing, f"define them in docs/measures: {missing}"


def test_every_column_of_a_table_of_cells_is_defined() -> None:
    rng = np.random.default_rng(0)
    positions, headings = rng.uniform(0, 1, (400, 2)), rng.uniform(-np.pi, np.pi, 400)
    rates = rng.uniform(0, 1, (400, 2))
    tables = (
        place_statistics(rates, positions, headings),
        heading_statistics(rates, positions, headings),
        grid_statistics(rate_maps(rates, positions), shuffles=2),
    )
    for table in tables:
        assert [column for column in table if not is_defined(column)] == []
    assert autocorrelograms(rate_maps(rates, positions)).shape[0] == 2


def test_every_public_function_that_measures_cells_is_defined() -> None:
    about = ("cogmap.cells.measures", "cogmap.cells.decoding.bayes", "cogmap.cells.decoding.patterns")
    named = [
        name
        for name in cogmap.cells.__all__
        if (home := getattr(cogmap.cells, name)).__module__.startswith(about) and not isinstance(home, type)
    ]
    mentioned = {
        word for _, text in DEFINED.values() for word in re.findall(r"`(\w+)", text)
    } | DEFINED.keys()
    assert len(named) > 12
    assert [name for name in named if name not in mentioned] == []


@pytest.mark.parametrize("name", sorted(DEFINED))
def test_a_measure_has_all_that_is_asked_of_it(name: str) -> None:
    page, text = DEFINED[name]
    told = dict(re.findall(r"^:(\w+): (.+)$", text, re.MULTILINE))
    assert [asked for asked in ASKED if not told.get(asked)] == [], page
