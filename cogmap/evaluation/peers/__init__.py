"""Peers: what others do, to compare with."""
