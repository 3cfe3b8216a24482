"""The commands of `cogmap`, by what they are about; each registers with `app` where it is defined."""

from cogmap.commands import maps, results, rooms, running
from cogmap.commands.app import app

__all__ = ["app", "maps", "results", "rooms", "running"]
