"""Pages of the API: one for each package, from its `__all__`, so that no public name can be missing."""

from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType

from sphinx.application import Sphinx
from sphinx.config import Config

PACKAGES = {
    "arena": "the world and the body in it",
    "neurons": "plastic layers that learn by local rules",
    "cogmap": "the map and its uses",
    "cogmap.cells": "measures of cells, spikes, sessions of animals, decoding",
    "cogmap.features": "features of views",
    "cogmap.graph": "neighbours and graphs",
    "cogmap.shape": "holes, degrees of freedom, coordinates",
    "cogmap.coordinates": "generalised coordinates of any body",
    "cogmap.navigation": "localising and ways",
    "cogmap.imagination": "dreams and expectations",
    "cogmap.control": "motor models and reaching",
    "cogmap.growing": "one map of many explorers",
    "cogmap.experiments": "what an experiment of yours is made of",
    "cogmap.plots": "figures from results",
    "cogmap.sweeps": "one experiment at many points",
    "cogmap.testing": "assertions for tests of yours",
}
"""Packages with a face, and what each is for."""


def public_names(package: str) -> list[str]:
    """Names of a package that are no modules."""
    module = import_module(package)
    named = getattr(module, "__all__", [name for name in vars(module) if name.startswith("assert_")])
    return [name for name in named if not isinstance(getattr(module, name), ModuleType)]


@cache
def documented() -> dict[str, str]:
    """Where each public object is documented, by its identity: the first package that shows it."""
    homes: dict[int, str] = {}
    for package in PACKAGES:
        for name in public_names(package):
            homes.setdefault(id(getattr(import_module(package), name)), f"{package}.{name}")
    return {
        f"{package}.{name}": homes[id(getattr(import_module(package), name))]
        for package in PACKAGES
        for name in public_names(package)
    }


def write_pages(app: Sphinx, _: Config) -> None:
    """Write `api/PACKAGE.rst` before autosummary looks for what to make pages of."""
    homes, pages = documented(), Path(app.srcdir) / "api"
    for package, about in PACKAGES.items():
        shown = [name for name in public_names(package) if homes[f"{package}.{name}"] == f"{package}.{name}"]
        elsewhere = {name: homes[f"{package}.{name}"] for name in public_names(package) if name not in shown}
        lines = [
            package,
            "=" * len(package),
            "",
            f".. py:module:: {package}",
            "",
            f"*{about.capitalize()}.*",
            "",
        ]
        lines += [import_module(package).__doc__ or "", ""]
        lines += [
            ".. currentmodule:: " + package,
            "",
            ".. autosummary::",
            "   :toctree: generated",
            "   :nosignatures:",
        ]
        lines += ["", *(f"   {name}" for name in shown), ""]
        if elsewhere:
            also = ", ".join(f":py:obj:`{name} <{home}>`" for name, home in elsewhere.items())
            lines += [f"Also here: {also}.", ""]
        _write_if_new(pages / f"{package}.rst", "\n".join(lines))


def _write_if_new(page: Path, text: str) -> None:
    # an unchanged page keeps its time, so that it is not read again
    page.parent.mkdir(exist_ok=True)
    if not page.exists() or page.read_text(encoding="utf-8") != text:
        page.write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Make it known to Sphinx."""
    app.connect("config-inited", write_pages)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
