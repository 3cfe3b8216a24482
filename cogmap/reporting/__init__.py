"""A result as one HTML page to show to someone."""

from cogmap.reporting.page import report

__all__ = ["report"]
