"""Decoding of rates: places, headings, patterns."""
