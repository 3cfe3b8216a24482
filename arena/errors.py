"""What `arena` raises when it is given something it cannot use, and its warnings."""


class ArenaError(ValueError):
    """Bad input: the message says what was given, what was expected and what to do."""


class NoSuchViewError(ArenaError, IndexError):
    """A view is asked for that a recording does not have."""


class TrackWarning(UserWarning):
    """Samples of an animal's track are doubtful, or were judged lost, bridged or moved; it says which."""
