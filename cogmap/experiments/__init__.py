"""Experiments, one file each: data in, table and figures out."""
