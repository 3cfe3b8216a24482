"""Measures of cells: fields, information, tuning to heading, stability."""
