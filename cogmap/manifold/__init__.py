"""The shape of a cloud of codes: its neighbour graph, its dimension, its holes, its coordinates."""
