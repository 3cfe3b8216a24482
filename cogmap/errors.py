"""What `cogmap` raises when it is given something it cannot use."""


class CogmapError(ValueError):
    """Bad input: the message says what was given, what was expected and what to do."""


class UnlikeArithmeticWarning(UserWarning):
    """Results that stand beside each other were calculated by processors that round differently."""
