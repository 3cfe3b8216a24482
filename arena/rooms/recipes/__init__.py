"""Recipes of materials, one file each: `paint` turns a generator into the colours of a tile, 0..255."""
