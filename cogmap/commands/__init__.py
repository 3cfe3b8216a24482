"""The commands of `cogmap`, each of them imported when it is called or its help is read."""

from cyclopts import App

__all__ = ["app"]

app = App(
    name="cogmap",
    help="Grow place cells and head-direction cells from sight and smell alone.",
    version_flags=["--version"],
    result_action="return_value",
)
_COMMANDS = {
    "arena": "rooms:_arena",
    "cells": "cells:_cells",
    "check": "checking:_check",
    "demo": "results:_demo",
    "dream": "acting:_dream",
    "experiment": "results:experiment_command",
    "explore": "rooms:_explore",
    "export": "maps:_export",
    "film": "page:_film",
    "grow": "growing:_grow",
    "import": "pictures:_import",
    "learn": "maps:_learn",
    "page": "page:_page",
    "reach": "acting:_reach",
    "report": "results:_page",
    "score": "maps:_score",
    "sweep": "results:_sweep",
}
for _name, _home in _COMMANDS.items():
    app.command(f"{__name__}.{_home}", name=_name)
# Flags after it are those of the command that it runs.
app.command(f"{__name__}.running:_portable", name="portable", help_flags=[], version_flags=[])
