"""Maps that tests grow stand clear of every guard, so that no processor's rounding decides a test.

A map whose guard is asked stands clear of it when its figure is farther from the bound than half of the
bound's own distance from 1. It is soundly trusted when it stands clear above all, and soundly refused when it
stands clear below one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import pytest

GROWN = pytest.StashKey[set[str]]()
BOUNDS = {"signs": 0.995, "phases": 0.999, "metric": 0.8}


def _margin(figure: float, bound: float) -> float:
    """How far a figure stands from its bound, in units of the bound's own distance from 1."""
    return (figure - bound) / (1 - bound)


def _is_clear(margins: list[float]) -> bool:
    return all(margin >= 0.5 for margin in margins) or any(not margin > -0.5 for margin in margins)


def _figures(layers: Any) -> dict[str, float]:
    signs, phases = layers.agreement.tolist()
    return {"signs": signs, "phases": phases, "metric": float(layers.gauge.foretold.min())}


@pytest.fixture(scope="session", autouse=True)
def guards(request: pytest.FixtureRequest) -> Iterator[list[str]]:
    """What stands too near a bound, of all maps whose guards are asked."""
    from cogmap.layers import Layers  # noqa: PLC0415  imported once type checks are hooked in

    grown = request.config.stash.setdefault(GROWN, set())
    near: list[str] = []
    asked = {"_doubt": ("signs", "phases"), "complain_of_metric": ("metric",)}
    with pytest.MonkeyPatch.context() as patch:
        for method, names in asked.items():
            patch.setattr(Layers, method, _watched(getattr(Layers, method), names, grown, near))
        yield near


def _watched(
    plain: Callable[[Any], str], names: tuple[str, ...], grown: set[str], near: list[str]
) -> Callable[[Any], str]:
    """Note what a guard is asked of, and whether it stands too near."""

    def ask(layers: Any) -> str:
        figures = _figures(layers)
        margins = {name: _margin(figures[name], BOUNDS[name]) for name in names}
        if not all(math.isnan(margin) for margin in margins.values()):
            told = ", ".join(f"{name} {figures[name]:.5f} ({margins[name]:+.2f})" for name in names)
            line = f"{layers.epoch} views, {len(layers.charts)} charts: {told}"
            grown.add(line)
            if not _is_clear(list(margins.values())):
                near.append(line)
        return plain(layers)

    return ask


@pytest.fixture(autouse=True)
def _clear_of_guards(guards: list[str], request: pytest.FixtureRequest) -> Iterator[None]:
    """Fail a test that asks a guard of a map that rounding might carry over its bound."""
    guards.clear()
    yield
    if guards and request.node.get_closest_marker("near_guard") is None:
        pytest.fail("a map stands too near a guard: " + "; ".join(dict.fromkeys(guards)))


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
