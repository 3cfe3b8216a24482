"""Data of one's own: what real cameras, animals and electrodes deliver, one file each."""
