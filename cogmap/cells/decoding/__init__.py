"""What can be read from rates: places, headings, patterns."""
