"""What `neurons` raises when it is given something it cannot use."""


class NeuronsError(ValueError):
    """Bad input: the message says what was given, what was expected and what to do."""
