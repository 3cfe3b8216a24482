"""Errors that `cogmap` raises when it is given something it cannot use, and its warnings."""


class CogmapError(ValueError):
    """Bad input: the message says what was given, what was expected and what to do."""


class UntrustedMapWarning(UserWarning):
    """A map that its own diagnosis does not trust was asked what it perceives; the message says why."""
