"""The commands of `cogmap`, by what they are about; each registers with `app` where it is defined."""

from cogmap.commands import maps, results, rooms
from cogmap.commands.app import app

__all__ = ["app", "maps", "results", "rooms"]
