"""Bodies that move through a room and are stopped by its walls."""
