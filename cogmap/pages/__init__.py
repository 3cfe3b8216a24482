"""Pages to show to someone."""
