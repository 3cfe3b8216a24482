"""Experiments, one file each: data in, table and figures out."""

from cogmap.experiments.conditions import Conditions
from cogmap.experiments.poses import pose_columns, pose_errors
from cogmap.experiments.registry import experiment
from cogmap.experiments.result import Result
from cogmap.experiments.trial import Trial, show_cells

__all__ = [
    "Conditions",
    "Result",
    "Trial",
    "experiment",
    "pose_columns",
    "pose_errors",
    "show_cells",
]
