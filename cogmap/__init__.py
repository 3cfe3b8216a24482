"""The cognitive map, its uses and its measures."""
