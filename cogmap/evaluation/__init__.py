"""Evaluation: all that is told a pose or a room's plan."""
