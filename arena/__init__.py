"""The world and the body in it: what an animal can see, smell and bump into."""

from contextlib import suppress

from arena.acting import Journeys, journeys
from arena.bodies.arm import Arm
from arena.bodies.base import Axis, Body
from arena.bodies.disc import Disc
from arena.bodies.heavy_disc import HeavyDisc
from arena.bodies.neck import Neck
from arena.bodies.rail import Rail
from arena.bodies.turntable import Turntable
from arena.errors import ArenaError, TrackWarning
from arena.exploration import explore
from arena.eye.camera import Camera
from arena.eye.overhead import Overhead
from arena.motions.babble import Babble
from arena.motions.base import Motion, Walk
from arena.motions.brownian import Brownian
from arena.motions.chemotaxis import Chemotaxis
from arena.motions.cyclic import Cyclic
from arena.motions.policy import Policy
from arena.motions.replay import Replay
from arena.motions.rotation import Rotation
from arena.motions.track import Track
from arena.recordings.recording import Recording
from arena.recordings.rescue import rescue
from arena.recordings.tracks import RecordedPath, read_track
from arena.rooms.arena import Arena, gallery
from arena.rooms.light import Light
from arena.rooms.parts import Block, Box, Pillar, Source, Wall
from arena.smell.nose import Nose
from arena.smell.odour import OdourField

__all__ = [
    "Arena",
    "ArenaError",
    "Arm",
    "Axis",
    "Babble",
    "Block",
    "Body",
    "Box",
    "Brownian",
    "Camera",
    "Chemotaxis",
    "Cyclic",
    "Disc",
    "HeavyDisc",
    "Journeys",
    "Light",
    "Motion",
    "Neck",
    "Nose",
    "OdourField",
    "Overhead",
    "Pillar",
    "Policy",
    "Rail",
    "RecordedPath",
    "Recording",
    "Replay",
    "Rotation",
    "Source",
    "Track",
    "TrackWarning",
    "Turntable",
    "Walk",
    "Wall",
    "explore",
    "gallery",
    "journeys",
    "read_track",
    "rescue",
]

# Of the extra `gym`. gymnasium 1 reads no entry points, so whoever imports the arena has the environment.
with suppress(ImportError):
    import gymnasium

    gymnasium.register(
        id="arena/Explorer-v0",
        entry_point="arena.environment:Explorer",
        vector_entry_point="arena.vector_environment:VectorExplorer",
        max_episode_steps=2000,
    )
