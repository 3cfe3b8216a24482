"""Types beside each parameter, in words: ``Float[np.ndarray, "views 2"]`` reads ``float array (views, 2)``.

Docstrings of this project name parameters without types, for these stand in the signature. What they link
to is found by its bare name among what is documented.
"""

import inspect
import re
from collections.abc import Iterator
from importlib import import_module
from typing import Any

from docutils import nodes
from every_public_name import documented
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.nodes import make_refnode

KINDS = {
    "Float": "float", "Float32": "float32", "Float64": "float64", "Int": "integer", "Int64": "int64",
    "Integer": "integer", "Bool": "boolean", "UInt8": "uint8", "Complex": "complex", "Num": "number",
    "Shaped": "any",
}  # fmt: skip
HOLDERS = {
    "np.ndarray": "array",
    "ndarray": "array",
    "Tensor": "tensor",
    "torch.Tensor": "tensor",
    "Array": "array",
}
ARRAY = re.compile(r"\b(" + "|".join(KINDS) + r""")\[\s*([\w.| ]+?),\s*["']([^"']*)["']\s*\]""")
HELD = "What it holds"
"""Instead of a section of attributes, which Sphinx would describe a second time; conf.py names it, too."""
WORDS = {"AnyArray": "array-like", "Whole": "int", "np.random.Generator": "numpy.random.Generator"}


def readable(annotation: object) -> str:
    """Say a type in words."""
    text = annotation if isinstance(annotation, str) else inspect.formatannotation(annotation)

    def array(match: re.Match[str]) -> str:
        kind, holder, axes = match.groups()
        shape = ", ".join(axis for axis in axes.split() if axis)
        return f"{KINDS[kind]} {HOLDERS.get(holder.strip(), holder.strip())} ({shape})"

    text = ARRAY.sub(array, text.replace("jaxtyping.", ""))
    for name, word in WORDS.items():
        text = re.sub(rf"(?<![\w.]){re.escape(name)}\b", word, text)
    text = re.sub(
        r"\b(?:arena|neurons|cogmap|typing|pathlib|collections\.abc)(?:\.[a-z_]+)*\.(?=[A-Z])", "", text
    )
    # numpy's own scalars are taken wherever plain ones are
    text = re.sub(r" \| (?:np|numpy)\.(?:floating|integer|bool)\b", "", text)
    return (
        text.replace(" | ", " or ")
        if "Literal" in text
        else text.replace(" | ", " or ").replace('"', "").replace("'", "")
    )


def typed(obj: object, lines: list[str]) -> list[str]:
    """Add types to the parameters of a docstring, and what is returned where it does not say."""
    try:
        signature = inspect.signature(obj)  # type: ignore[arg-type]  # asked for callables only
    except (TypeError, ValueError):
        return lines
    types = {name: readable(each.annotation) for name, each in signature.parameters.items()
             if each.annotation is not each.empty}  # fmt: skip
    result, section = list[str](), ""
    for line, following in zip(lines, [*lines[1:], ""], strict=True):
        if re.fullmatch(r"-{3,}", following.strip()):
            section = line.strip()
        names = [name.strip(" *") for name in line.split(",")]
        if section == "Parameters" and not line.startswith(" ") and all(name in types for name in names):
            told = dict.fromkeys(types[name] for name in names)
            result.append(f"{line} : {', '.join(f'``{each}``' for each in told)}")
        elif section == "Attributes" and line.strip(" -") not in {"", section} and line[0] != " ":
            called, _, kind = line.partition(" : ")
            shown = ", ".join(f"``{name.strip()}``" for name in called.split(","))
            result.append(f"{shown} : {kind}" if kind else shown)
        elif section in {"Returns", "Yields"} and line.strip(" -") not in {"", section} and line[0] != " ":
            result.append(f"``{line}``" if "`" not in line else line)
        else:
            result.append(line)
    result = [HELD if line == "Attributes" else line for line in result]
    returned = signature.return_annotation
    silent = inspect.isclass(obj) or returned in {signature.empty, None, "None"} or "Returns" in lines
    if not silent and "Yields" not in lines:
        result = _before_notes(result, ["", "Returns", "-------", f"``{readable(returned)}``", ""])
    return result


def _before_notes(lines: list[str], added: list[str]) -> list[str]:
    # Raises comes after Returns; other sections are rare here
    at = lines.index("Raises") if "Raises" in lines else len(lines)
    return [*lines[:at], *added, *lines[at:]]


def add_types(_: Sphinx, what: str, name: str, obj: Any, __: Any, lines: list[str]) -> None:
    """Rewrite a docstring before it is read as one of numpy's."""
    # |x| is an absolute value here, no substitution
    lines[:] = [
        re.sub(r"\|", r"\\|", line) if "`" not in line and not line.startswith("|") else line
        for line in lines
    ]
    if what in {"function", "method", "class", "exception"}:
        lines[:] = typed(obj, lines)
    elif what == "attribute" and (annotation := _annotation_of(name)):
        lines[:] = [
            f"``{annotation}`` — {lines[0]}" if lines and lines[0] else f"``{annotation}``",
            *lines[1:],
        ]
    elif what == "property" and getattr(obj, "fget", None) is not None:
        returned = inspect.get_annotations(obj.fget).get("return")
        if returned is not None and lines:
            lines[:] = [f"``{readable(returned)}`` — {lines[0]}", *lines[1:]]


def _annotation_of(name: str) -> str | None:
    package, *rest = name.split(".")
    found: Any = import_module(package)
    for part in rest[:-1]:
        found = getattr(found, part, None)
    annotation = getattr(found, "__annotations__", {}).get(rest[-1])
    return None if annotation is None else readable(annotation)


def ours(
    _: str, __: str, text: str, line: int, inliner: Any, *___: Any
) -> tuple[list[nodes.Node], list[nodes.system_message]]:
    """Read a single backtick: a name of ours is to become a link, anything else is code."""
    del line
    shown = nodes.literal(text, text, classes=["xref", "py"])
    document = inliner.document.settings.env.docname
    return [pending_xref("", shown, refdomain="", reftype="ours", reftarget=text, refdoc=document)], []


def resolve(
    app: Sphinx, env: BuildEnvironment, node: pending_xref, shown: nodes.Element
) -> nodes.Element | None:
    """Link to what is documented, under whichever name it was asked for; what is not of ours stays code."""
    kind, target = node.get("reftype"), node["reftarget"].removesuffix("()")
    if kind != "ours" and node.get("refdomain") != "py":
        return None
    objects = env.domains.python_domain.objects
    for home in _homes(target):
        if home in objects:
            entry = objects[home]
            return make_refnode(app.builder, node["refdoc"], entry.docname, entry.node_id, shown, home)
    foreign = target.split(".")[0] not in {"arena", "neurons", "cogmap"}
    return shown if kind == "ours" or foreign else None


def _homes(target: str) -> Iterator[str]:
    """Names under which something may be documented: its own, that of its object, that of its class."""
    homes = documented()
    parts = target.split(".")
    for count in range(len(parts), 0, -1):
        called, members = ".".join(parts[:count]), parts[count:]
        if called in homes:
            yield ".".join([homes[called], *members])
        for name, home in homes.items():
            if "." not in called and name.rsplit(".", 1)[-1] == called:
                yield ".".join([home, *members])
    yield from (home for name, home in homes.items() if len(parts) > 1 and name.endswith(f".{parts[-1]}"))


def setup(app: Sphinx) -> dict[str, bool]:
    """Make it known to Sphinx."""
    app.add_role("ours", ours)
    app.connect("autodoc-process-docstring", add_types, priority=400)  # before napoleon, at 500
    app.connect("missing-reference", resolve)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
