"""Sessions of animals: where they were, when their cells fired, in one frame of metres, radians and hertz."""
