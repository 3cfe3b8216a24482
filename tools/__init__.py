"""Tools that look at the repository itself: what changed, and how large it is."""
