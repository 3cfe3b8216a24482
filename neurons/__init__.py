"""Plastic layers that learn by local Hebbian rules; handed views and odours, they know nothing else."""
