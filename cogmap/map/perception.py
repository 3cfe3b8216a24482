"""Perception: what the rooms of a map say of views, of smells in the dark, and of neither."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from cogmap.map.activity import Activity
from neurons.layers.readout import Recalled
from neurons.network import Network
from neurons.rooms import Rooms


def seen(
    rooms: Rooms,
    strips: Float[Tensor, "views features"],
    log_odours: Float[Tensor, "views odorants"] | None,
) -> Activity:
    """Let the room that each view is of tell what it is, from sight or from both senses."""
    found, recalled = rooms.recall(strips, log_odours)
    told = [(views, _told(rooms[room], what)) for room, views, what in recalled]
    order = torch.cat([views for views, _ in told]).argsort()
    place, heading, phase, odour, position = (
        torch.cat(parts)[order].cpu().numpy() for parts in zip(*(parts for _, parts in told), strict=True)
    )
    room, confidence = (part.cpu().numpy() for part in (found.room, found.confidence))
    return Activity(place, heading, phase, odour, position, room=room, room_confidence=confidence)


def _told(network: Network, recalled: Recalled) -> tuple[Tensor, ...]:
    """Rates of both populations, heading, recalled odour and position."""
    position, phase = network.metric_map(network.place, network.heading, recalled.odour, recalled.heading)
    place, heading = (cells.afferents(recalled.excited) for cells in (network.place, network.heading))
    return place, heading, phase, recalled.odour, position


def recognised(rooms: Rooms, strips: Float[Tensor, "views features"]) -> Activity:
    """Say of views what a map without a second sense can say: of which room they are, and nothing else."""
    network, found = rooms[0], rooms.recognise(strips)
    cells = len(network.place.centres), len(network.heading.preferred)
    blind = np.full((len(strips), sum(cells) + 3), np.nan, np.float32)
    place, heading, phase, position = np.split(blind, np.cumsum([*cells, 1]), axis=1)
    room, confidence = (part.cpu().numpy() for part in (found.room, found.confidence))
    nothing = blind[:, :0]
    return Activity(place, heading, phase[:, 0], nothing, position, room=room, room_confidence=confidence)


def smelt(rooms: Rooms, log_odours: Float[Tensor, "views odorants"]) -> Activity:
    """Place cells and position in the dark, where heading is not known."""
    found = rooms.sniff(log_odours)
    # float32, as everything that a map says of views
    blind = np.full((len(log_odours), 1 + len(rooms[0].heading.preferred)), np.nan, np.float32)
    place = log_odours.new_empty(len(log_odours), len(rooms[0].place.centres))
    position = log_odours.new_empty(len(log_odours), 2)
    for room in found.nearest.unique().tolist():
        network, here = rooms[room], found.nearest == room
        place[here] = network.place.tuning(log_odours[here])
        position[here] = network.metric_map.locate(network.place, log_odours[here])
    return Activity(
        place=place.cpu().numpy(),
        heading=blind[:, 1:],
        phase=blind[:, 0],
        odour=log_odours.cpu().numpy(),
        position=position.cpu().numpy(),
        room=found.room.cpu().numpy(),
        room_confidence=found.confidence.cpu().numpy(),
    )


def joined(parts: Sequence[Activity]) -> Activity:
    """Put what was told of batches of views together."""
    known = [name for name, part in vars(parts[0]).items() if part is not None]
    together: dict[str, Any] = {
        name: np.concatenate([getattr(part, name) for part in parts]) for name in known
    }
    return replace(parts[0], **together)
