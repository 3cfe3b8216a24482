"""Sweeps: one experiment at many points, each point a row of one table."""

from cogmap.sweeps.plan import Plan
from cogmap.sweeps.sweeping import sweep

__all__ = ["Plan", "sweep"]
