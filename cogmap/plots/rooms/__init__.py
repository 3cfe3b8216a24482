"""Figures of rooms, walks and views."""
