"""Figures of bodies whose mechanism nobody has described, one file each."""
