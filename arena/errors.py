"""What `arena` raises when it is given something it cannot use."""


class ArenaError(ValueError):
    """Bad input: the message says what was given, what was expected and what to do."""


class NoSuchViewError(ArenaError, IndexError):
    """A view is asked for that a recording does not have."""
