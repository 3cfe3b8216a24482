"""`llms.txt`: the whole of the documentation's own pages as one file of Markdown, for readers of text."""

from importlib import import_module
from pathlib import Path

from every_public_name import PACKAGES, public_names
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

HEAD = """# cogmap

> A laboratory in which place cells and head-direction cells emerge from sight and smell alone: arena
> (rooms, bodies, eyes, noses), neurons (Hebbian layers), cogmap (maps and what is done with them).

All pages of the documentation, in their order, then every public name with what it is.
"""


def written(env: BuildEnvironment) -> str:
    """Put the pages after each other in the order of the table of contents."""
    parts = [HEAD]
    for name in _in_order(env, env.config.root_doc):
        path = Path(env.doc2path(name))
        if path.suffix == ".md":
            parts.append(f"\n---\n<!-- {name} -->\n\n{path.read_text(encoding='utf-8').strip()}\n")
    parts.append("\n---\n\n# Every public name\n")
    for package, about in PACKAGES.items():
        parts.append(f"\n## {package}: {about}\n\n")
        module = import_module(package)
        for name in public_names(package):
            said = (getattr(module, name).__doc__ or "").strip().split("\n")[0]
            parts.append(f"- `{package}.{name}`: {said}\n")
    return "".join(parts)


def _in_order(env: BuildEnvironment, name: str) -> list[str]:
    found = [name]
    for child in env.toctree_includes.get(name, []):
        if child not in found:
            found += [each for each in _in_order(env, child) if each not in found]
    return found


def write(app: Sphinx, failed: Exception | None) -> None:
    """Write it beside the pages."""
    if failed is None and app.builder.format == "html":
        (Path(app.outdir) / "llms.txt").write_text(written(app.env), encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Make it known to Sphinx."""
    app.connect("build-finished", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
