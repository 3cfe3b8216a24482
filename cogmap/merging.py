"""What maps grown from the same charts have learnt apart, added up."""

from __future__ import annotations

from copy import deepcopy

import torch

from cogmap.errors import CogmapError
from cogmap.layers import EPOCHS, STAGES, Layers

SUMS = {
    "olfaction": ("olfaction.gram", "olfaction.cross"),
    "gauge": ("gauge.spread", "gauge.ahead", "gauge.shared", "gauge.counted", "gauge.seen"),
    "afferents": (
        "place.afferents.association",
        "place.afferents.activity",
        "heading.afferents.association",
        "heading.afferents.activity",
    ),
}
"""What each stage adds to. In the others units compete, and what they learn depends on the order of views."""
OWN = ("age", "gauge.recent")
"""In what else two maps may differ: the views so far, and the last of them."""


def forked(layers: Layers) -> Layers:
    """Copy layers, but for what they have summed up in the present stage.

    Raises
    ------
    CogmapError
        In a stage that learns no sums.
    """
    layers.mature()
    stage = _shared_stage(layers)
    other = deepcopy(layers)
    for name in SUMS[stage]:
        other.get_buffer(name).zero_()
    other.gauge.jump()
    other.age.fill_(layers.begins(stage))
    return other


def merge(layers: Layers, other: Layers) -> None:
    """Add to the layers what others, in the same stage on the same charts, have learnt in it.

    The views of both count, but do not carry the stage beyond its end.

    Raises
    ------
    CogmapError
        When they differ in anything but these sums.
    """
    if layers.stage == STAGES[int(other.matured)]:
        layers.mature()
    stage = _shared_stage(layers)
    _check_kin(layers, other, stage)
    for name in SUMS[stage]:
        layers.get_buffer(name).add_(other.get_buffer(name))
    begun = layers.begins(stage)
    age, others = int(layers.age), int(other.age)
    together = age + others - begun
    if stage != STAGES[-1]:
        together = min(together, max(begun + EPOCHS[stage] * layers.epoch, age, others))
    layers.age.fill_(together)


def _shared_stage(layers: Layers) -> str:
    """Give the stage that layers are in, if its work can be shared."""
    stage = STAGES[int(layers.matured)]
    if stage not in SUMS:
        raise CogmapError(
            f"this map is in its {stage!r} stage, in which units compete for one view after the other; "
            f"maps share the work in {', '.join(map(repr, SUMS))}: show it more views first"
        )
    return stage


def _check_kin(layers: Layers, other: Layers, stage: str) -> None:
    mine, its = layers.state_dict(), other.state_dict()
    if layers.epoch != other.epoch or any(mine[name].shape != its[name].shape for name in mine):
        raise CogmapError(
            "these maps differ in views, odorants, charts, components, cells or epoch; merge forks of one map"
        )
    if other.matured != layers.matured:
        raise CogmapError(
            f"this map is in its {stage!r} stage and the other in its {STAGES[int(other.matured)]!r} stage; "
            "merge them before either leaves the stage in which they parted"
        )
    for name in mine:
        if name in (*SUMS[stage], *OWN):
            continue
        if not torch.equal(mine[name].nan_to_num(), its[name].nan_to_num()):
            raise CogmapError(
                f"these maps were not grown from the same charts: {name} differs; merge forks of one map, "
                "brought to this stage by processors that calculate alike (see `cogmap portable`)"
            )
