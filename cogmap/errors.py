"""Errors that `cogmap` raises when it is given something it cannot use, and its warnings."""


class CogmapError(ValueError):
    """Bad input: the message says what was given, what was expected and what to do."""


class OpenSeamWarning(UserWarning):
    """Views that were said to be panoramas do not close around; the message says what to do."""


class UnlikeArithmeticWarning(UserWarning):
    """Results that stand beside each other were calculated by processors that round differently."""


class UntrustedMapWarning(UserWarning):
    """A map that its own diagnosis does not trust was asked what it perceives; the message says why."""


class SeparatePiecesWarning(UserWarning):
    """A neighbour graph falls into pieces between which nothing is known; the message says how many."""
