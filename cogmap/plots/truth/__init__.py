"""Figures of what a map tells against the truth."""
