"""Layers that learn by local Hebbian rules: from the retina to the cells."""
