"""Figures of one map of many rooms."""
