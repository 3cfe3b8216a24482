"""Rooms: walls, solids, materials, light, and the file that describes them."""
