"""The report: a result as one HTML page to show to someone."""

from cogmap.pages.report.page import report

__all__ = ["report"]
