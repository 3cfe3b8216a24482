"""Figures of bars and embeddings."""
