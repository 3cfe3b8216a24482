"""The command that tells whether what was written is still what it was."""

from typing import Any

import arena
from arena.atomic import check_absent
from cogmap.checking import check
from cogmap.commands.common import Json, MaybePath, UserPath, tell
from cogmap.errors import CogmapError


def _check(path: UserPath, /, *, rescue: MaybePath = None, as_json: Json = False) -> None:
    """Compare all of a recording, map, result or sweep with its checksums, and tell what is whole.

    Examples: `cogmap check map --json`; `cogmap check walk.zarr --rescue rest.zarr`.

    Parameters
    ----------
    path
        What `cogmap` wrote, or the TOML file of a room or a sweep.
    rescue
        Folder to write what is whole of a recording to; it must not exist.
    """
    if rescue is not None:
        check_absent(rescue, CogmapError)
    found = check(path)
    told: dict[str, Any] = {
        "path": str(path),
        "kind": found.kind,
        "version": found.version,
        "whole": found.whole,
        "parts": found.parts,
        "damage": list(found.damage),
    }
    if rescue is not None:
        if found.kind != "recording":
            raise CogmapError(f"{path} is a {found.kind}, and only recordings are rescued")
        saved = arena.rescue(path)
        saved.save(rescue)
        told["rescued"] = {"recording": str(rescue), "views": len(saved)}
    tell(told, as_json=as_json)
    if not (found.whole or rescue):
        raise CogmapError(found.sentence)
