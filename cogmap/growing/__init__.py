"""Growing: one map of what many explorers see and smell, learnt by many threads or machines."""

from cogmap.growing.growing import grow

__all__ = ["grow"]
