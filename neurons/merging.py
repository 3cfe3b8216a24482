"""Merging: what maps grown from the same charts have learnt apart, added up."""

from copy import deepcopy
from typing import Any

import torch

from neurons.errors import NeuronsError
from neurons.network import Network
from neurons.stages import Stage


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
    for name in stage.sums:
        other.get_buffer(name).zero_()
    other.break_sequence()
    other.views_seen.fill_(network.begins(stage.name))
    return other


def merge(network: Network, other: Network) -> None:
    """Add to a network what another, in the same stage on the same charts, has learnt in it.

    The views of both count, but do not carry the stage beyond its end.

    Raises
    ------
    NeuronsError
        When they differ in anything but these sums.
    """
    if network.stage == other.entered:
        network.advance_stage()
    stage = _shared_stage(network)
    _check_kin(network, other, stage)
    for name in stage.sums:
        network.get_buffer(name).add_(other.get_buffer(name).to(network.views_seen.device))
    begun = network.begins(stage.name)
    views_seen, others = int(network.views_seen), int(other.views_seen)
    together = views_seen + others - begun
    if stage != network.stages[-1]:
        together = min(together, max(begun + stage.epochs * network.epoch, views_seen, others))
    network.views_seen.fill_(together)


def _shared_stage(network: Network) -> Stage[Any]:
    """Give the stage that a network is in, if its work can be shared."""
    stage = network.entered
    if not stage.sums:
        shared = ", ".join(repr(each.name) for each in network.stages if each.sums)
        raise NeuronsError(
            f"this map is in its {stage.name!r} stage, in which units compete for one view after the other; "
            f"maps share the work in {shared}: show it more views first"
        )
    return stage


def _check_kin(network: Network, other: Network, stage: Stage[Any]) -> None:
    mine = network.state_dict()
    its = {name: learnt.to(network.views_seen.device) for name, learnt in other.state_dict().items()}
    if (network.stages, network.epoch) != (other.stages, other.epoch) or any(
        mine[name].shape != its[name].shape for name in mine
    ):
        raise NeuronsError(
            "these maps differ in views, odorants, charts, components, cells, epoch or stages; "
            "merge forks of one map"
        )
    if other.entered != stage:
        raise NeuronsError(
            f"this map is in its {stage.name!r} stage and the other in its {other.entered.name!r} "
            "stage; merge them before either leaves the stage in which they parted"
        )
    recent = (name for each in network.stages for name in each.recent)
    own = {"views_seen", *stage.sums, *recent}  # in which two maps may differ
    for name in sorted(mine.keys() - own):
        if not torch.equal(mine[name].nan_to_num(), its[name].nan_to_num()):
            raise NeuronsError(
                f"these maps were not grown from the same charts: {name} differs; merge forks of one map, "
                "brought to this stage by processors that calculate alike (see `cogmap portable`)"
            )
