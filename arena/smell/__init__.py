"""Smell: odours diffusing around walls, and the noisy nose that samples them."""
