"""Maps that tests grow stand clear of every guard, so that no processor's rounding decides a test."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tests import type_checks
from tests.guards import described, too_near

LONGEST = (
    "test_running", "growing/test_processes", "test_merging", "atlas/test_metric_map", "shape/test_homology",
    "test_isomap",
    "test_notebooks", "test_portable", "test_registry", "test_readme", "test_directionality",
    "test_topology_of_maps", "test_development_and_lesions", "test_cognitive_map", "test_cli",
    "test_exploration", "test_fusion", "growing/test_growing",
)  # fmt: skip
"""Files that are begun first, the longest of them, so that no worker waits for another at the end.

But for those before the notebooks, which need no kernels: these are compiled by one worker meanwhile.
"""
GROWN = pytest.StashKey[set[str]]()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the longest files."""
    ranks = {name: rank for rank, name in enumerate(LONGEST)}

    def rank(item: pytest.Item) -> int:
        return min((ranks[name] for name in LONGEST if item.path.match(f"{name}.py")), default=len(ranks))

    items.sort(key=rank)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup() -> None:
    """Check types of the first calls in each test."""
    type_checks.begin()


@pytest.fixture(scope="session", autouse=True)
def _no_power_cuts() -> Iterator[None]:
    """Let the system write when it likes: syncing thousands of small files takes a tenth of the time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda _: None)
        yield


@pytest.fixture(scope="session", autouse=True)
def guards(request: pytest.FixtureRequest) -> Iterator[list[str]]:
    """What stands too near a bound, of all maps whose guards are asked."""
    from neurons.network import Network  # noqa: PLC0415  imported once type checks are hooked in

    grown = request.config.stash.setdefault(GROWN, set())
    near: list[str] = []
    asked = {
        "atlas_diagnosis": ("signs", "phases"),
        "heading_diagnosis": ("signs", "phases", "metric", "vote"),
        "metric_diagnosis": ("metric",),
    }
    with pytest.MonkeyPatch.context() as patch:
        for method, names in asked.items():
            patch.setattr(Network, method, _watched(getattr(Network, method), names, grown, near))
        yield near


def _watched(
    plain: Callable[[Any], str], names: tuple[str, ...], grown: set[str], near: list[str]
) -> Callable[[Any], str]:
    """Note what a guard is asked of, and whether it stands too near."""

    def ask(network: Any) -> str:
        line = described(network, names)
        if "nan" not in line:
            grown.add(line)
        if too_near(network, names):
            near.append(line)
        return plain(network)

    return ask


@pytest.fixture(autouse=True)
def _clear_of_guards(guards: list[str], request: pytest.FixtureRequest) -> Iterator[None]:
    """Fail a test that asks a guard of a map that rounding might carry over its bound."""
    yield
    near = "; ".join(dict.fromkeys(guards))
    guards.clear()
    if near and request.node.get_closest_marker("near_guard") is None:
        pytest.fail(f"a map stands too near a guard: {near}")


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    """Hand what a worker has grown to whoever prints it."""
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["grown"] = sorted(session.config.stash.get(GROWN, set()))


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    """Gather what the workers have grown."""
    node.config.stash.setdefault(GROWN, set()).update(getattr(node, "workeroutput", {}).get("grown", ()))


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Print every grown map with its distances from the guards, the nearest first."""
    grown = config.stash.get(GROWN, set())
    if grown:
        terminalreporter.section("maps and their guards: figure (distance from its bound, 1 at best)")
        for line in sorted(grown):
            terminalreporter.write_line(line)
