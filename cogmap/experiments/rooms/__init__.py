"""Many rooms, one file each."""
