"""Motions: ways of moving through an arena, one file each."""

from arena.motions.base import Motion, Walk

__all__ = ["Motion", "Walk"]
