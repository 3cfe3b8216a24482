"""Recordings: what was seen and smelt, and when and where, in memory or as zarr on disk."""
