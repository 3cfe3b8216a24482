"""Code metrics of the packages: how many lines, how long, how well commented, at two revisions side by side.

    python -m tools.measure_house [--before REVISION] [--after REVISION | CHECKOUT]

A line of code holds a token that is neither a comment nor a docstring. Both columns are counted alike.
"""

import argparse
import ast
import io
import re
import subprocess
import sys
import tarfile
import tokenize
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from statistics import median

PACKAGES = ("arena", "neurons", "cogmap")
SILENT = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
}


def at_revision(repository: Path, revision: str) -> dict[str, str]:
    """Read the packages' Python files as they were committed."""
    packed = subprocess.check_output(["git", "-C", repository, "archive", revision, *PACKAGES])  # noqa: S607
    with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
        members = {item.name: archive.extractfile(item) for item in archive if item.name.endswith(".py")}
    return {name: file.read().decode() for name, file in members.items() if file is not None}


def on_disk(checkout: Path) -> dict[str, str]:
    """Read the packages' Python files as they lie there."""
    files = (path for package in PACKAGES for path in (checkout / package).rglob("*.py"))
    return {str(path.relative_to(checkout)): path.read_text(encoding="utf-8") for path in files}


def functions(tree: ast.AST) -> list[ast.FunctionDef | ast.AsyncFunctionDef]:
    """Find every function and method."""
    return [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)]


def parameters(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Count what a caller may give: `self` and `cls` are not given."""
    given = function.args
    names = [part.arg for part in (*given.posonlyargs, *given.args, *given.kwonlyargs)]
    return len(names) - (names[:1] in (["self"], ["cls"])) + bool(given.vararg) + bool(given.kwarg)


def docstring_lines(tree: ast.AST) -> set[int]:
    """Give the lines of docstrings, those below a constant or a field too."""
    texts = (node for node in ast.walk(tree) if isinstance(node, ast.Expr))
    return {
        line
        for node in texts
        if isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        for line in range(node.lineno, (node.end_lineno or node.lineno) + 1)
    }


def constants(tree: ast.Module) -> tuple[int, int]:
    """Count UPPER_CASE names of a module: those assigned alone, and all, in tuples and with a type too."""
    plain = [node.targets[0] for node in tree.body if isinstance(node, ast.Assign)]
    typed = [node.target for node in tree.body if isinstance(node, ast.AnnAssign)]
    alone = [target.id for target in plain if isinstance(target, ast.Name)]
    every = [name.id for target in plain + typed for name in ast.walk(target) if isinstance(name, ast.Name)]
    # Shorter ones are type variables, mostly.
    found = (
        sum(bool(re.fullmatch(r"_?[A-Z][A-Z0-9_]{2,}", name)) for name in names) for names in (alone, every)
    )
    return next(found), next(found)


def measure(files: Mapping[str, str]) -> dict[str, object]:
    """Measure all that is asked of a house."""
    trees = {name: ast.parse(text) for name, text in files.items()}
    lengths = {name: len(text.splitlines()) for name, text in files.items()}
    code, comments = 0, 0
    for name, text in files.items():
        tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
        spoken = {
            line
            for token in tokens
            if token.type not in SILENT
            for line in range(token.start[0], token.end[0] + 1)
        }
        code += len(spoken - docstring_lines(trees[name]))
        comments += len({token.start[0] for token in tokens if token.type == tokenize.COMMENT})
    every = [(name, function) for name, tree in trees.items() for function in functions(tree)]
    longest, where = max(
        ((function.end_lineno or 0) - function.lineno + 1, f"{name}:{function.name}")
        for name, function in every
    )
    crowds = Counter(str(Path(name).parent) for name in files if not name.endswith("__init__.py"))
    crowded = sorted(f"{folder} ({count})" for folder, count in crowds.items() if count > 14)
    total, largest = sum(lengths.values()), max(lengths, key=lambda name: lengths[name])
    return {
        "files": len(files),
        "lines": total,
        "lines of code": code,
        "median file": median(length for length in lengths.values()),
        "longest file": f"{lengths[largest]} {largest}",
        "longest function": f"{longest} {where}",
        "comments, % of lines": round(100 * comments / total, 1),
        "module constants": sum(constants(tree)[0] for tree in trees.values()),
        "with those of tuples and with a type": sum(constants(tree)[1] for tree in trees.values()),
        "functions with > 8 parameters": sum(parameters(function) > 8 for _, function in every),
        "folders with > 14 files": ", ".join(crowded) or "none",
    }


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--before", default="d4469ae", help="revision before the house was rebuilt")
    parser.add_argument("--after", default=".", help="a revision, or the folder of a checkout")
    given = parser.parse_args()
    here = Path(__file__).parents[1]
    after = Path(given.after)
    before = measure(at_revision(here, given.before))
    now = measure(on_disk(after) if after.is_dir() else at_revision(here, given.after))
    print(f"| | before ({given.before}) | after |\n|---|---|---|")
    for name, value in before.items():
        print(f"| {name} | {value} | {now[name]} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
