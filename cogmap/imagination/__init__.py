"""What a map expects to see: dreams of places, of ways between them, of what comes next; no pose enters."""

from cogmap.imagination.imagination import Dream, Imagination

__all__ = ["Dream", "Imagination"]
