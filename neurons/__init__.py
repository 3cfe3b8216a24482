"""Plastic layers, learning by local Hebbian rules; they are handed views and odours, and know of nothing else."""
