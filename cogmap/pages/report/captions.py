"""Captions of the pictures of a result, for those who read them and for those who cannot see them."""

CAPTIONS = {
    "barcodes": "Bars of loops and voids, each with the threshold above which it counts",
    "cells": "What each cell tells of position and of heading, by population",
    "compass": "Learnt against true heading, the same colour for the same direction",
    "confusion": "Where the nearest view was taken, turned half round or not",
    "cylinder": "Coordinates of the views on their manifold, coloured by heading and by place along the way",
    "distances": "Distance along the manifold against distance between poses",
    "errors": "How far from the true pose fresh views are placed",
    "examples": "Six cells of each population: rate maps, and rate by heading",
    "goals": "The views at each goal, as strokes that point where the body looks",
    "heading": "Heading read off the views against the true one",
    "heading_cells": "Tuning curves of head-direction cells, rate against heading",
    "likeness": "Which views each measure of likeness takes for the same",
    "metric_map": "Where the map believes it is, laid over where it truly is",
    "neighbours": "Fresh views beside the known views they are placed among",
    "place_cells": "Rate maps of place cells, rate against position",
    "position": "Recalled against true position",
    "prediction": "Heading predicted by a small network against the true one",
    "ring": "The first two coordinates of the views of a spin, coloured by heading",
    "room": "The room from above, with the way through it",
    "sources": "What the cells tell of place with ever more sources of smell",
    "torus": "The first three coordinates of the views, coloured by heading and by place",
    "torus_fourth": "The first, second and fourth coordinate of the views, coloured by heading and by place",
    "translation": "Height on the cylinder against place along the way",
    "views": "Some of the views, with where they were taken",
    "walk": "The way through the room, and place and heading over time",
}


def caption(name: str) -> str:
    """Say what a picture of this name shows; a picture nobody described has only its name."""
    return CAPTIONS.get(name, name.replace("_", " ").capitalize())
