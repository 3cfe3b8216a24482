"""Growing: one map of what many explorers see and smell, learnt by many processes."""

from cogmap.growing.growing import grow

__all__ = ["grow"]
