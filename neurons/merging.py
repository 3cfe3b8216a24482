"""Merging: what maps grown from the same charts have learnt apart, added up."""

from __future__ import annotations

from copy import deepcopy

import torch

from neurons.errors import NeuronsError
from neurons.network import EPOCHS, STAGES, Network

SUMS = {
    "olfaction": ("olfaction.gram", "olfaction.cross"),
    "metric_map": (
        "metric_map.spread",
        "metric_map.ahead",
        "metric_map.shared",
        "metric_map.counted",
        "metric_map.seen",
    ),
    "afferents": (
        "place.afferents.association",
        "place.afferents.activity",
        "heading.afferents.association",
        "heading.afferents.activity",
    ),
}
"""What each stage adds to. In the others units compete, and what they learn depends on the order of views."""
OWN = ("views_seen", "metric_map.recent")
"""In what else two maps may differ: the views so far, and the last of them."""


def forked(network: Network) -> Network:
    """Copy a network, but for what it has summed up in the present stage.

    Raises
    ------
    NeuronsError
        In a stage that learns no sums.
    """
    network.advance_stage()
    stage = _shared_stage(network)
    other = deepcopy(network)
    for name in SUMS[stage]:
        other.get_buffer(name).zero_()
    other.metric_map.break_sequence()
    other.views_seen.fill_(network.begins(stage))
    return other


def merge(network: Network, other: Network) -> None:
    """Add to a network what another, in the same stage on the same charts, has learnt in it.

    The views of both count, but do not carry the stage beyond its end.

    Raises
    ------
    NeuronsError
        When they differ in anything but these sums.
    """
    if network.stage == STAGES[int(other.stage_index)]:
        network.advance_stage()
    stage = _shared_stage(network)
    _check_kin(network, other, stage)
    for name in SUMS[stage]:
        network.get_buffer(name).add_(other.get_buffer(name))
    begun = network.begins(stage)
    views_seen, others = int(network.views_seen), int(other.views_seen)
    together = views_seen + others - begun
    if stage != STAGES[-1]:
        together = min(together, max(begun + EPOCHS[stage] * network.epoch, views_seen, others))
    network.views_seen.fill_(together)


def _shared_stage(network: Network) -> str:
    """Give the stage that a network is in, if its work can be shared."""
    stage = STAGES[int(network.stage_index)]
    if stage not in SUMS:
        raise NeuronsError(
            f"this map is in its {stage!r} stage, in which units compete for one view after the other; "
            f"maps share the work in {', '.join(map(repr, SUMS))}: show it more views first"
        )
    return stage


def _check_kin(network: Network, other: Network, stage: str) -> None:
    mine, its = network.state_dict(), other.state_dict()
    if network.epoch != other.epoch or any(mine[name].shape != its[name].shape for name in mine):
        raise NeuronsError(
            "these maps differ in views, odorants, charts, components, cells or epoch; merge forks of one map"
        )
    if other.stage_index != network.stage_index:
        raise NeuronsError(
            f"this map is in its {stage!r} stage and the other in its {STAGES[int(other.stage_index)]!r} "
            "stage; merge them before either leaves the stage in which they parted"
        )
    for name in mine:
        if name in (*SUMS[stage], *OWN):
            continue
        if not torch.equal(mine[name].nan_to_num(), its[name].nan_to_num()):
            raise NeuronsError(
                f"these maps were not grown from the same charts: {name} differs; merge forks of one map, "
                "brought to this stage by processors that calculate alike (see `cogmap portable`)"
            )
