"""Kernels of the cognitive map: loops that numba compiles, cached under a hash of their own sources."""

from pathlib import Path

from arena.kernels import cache_folder, kernels_cached_in

kernel = kernels_cached_in(cache_folder(Path(__file__).parent, "graph", "imagination"))
