"""Figures of what an explorer does with its map."""
