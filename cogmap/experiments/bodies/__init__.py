"""Bodies whose mechanism nobody has described, one file each."""
