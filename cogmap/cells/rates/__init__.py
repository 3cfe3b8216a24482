"""Rates over bins of place and heading, spikes, and their nulls."""
