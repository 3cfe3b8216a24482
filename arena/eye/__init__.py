"""The eye: rays cast into a room, textures averaged over each pixel, images out."""
