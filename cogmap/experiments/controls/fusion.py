"""Fusion of sight and smell: what cells come of sight alone, of smell alone, and of both."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from cogmap.evaluation.populations import competing_cells, trust_report
from cogmap.experiments import Conditions, Result, Trial, experiment, show_cells
from cogmap.features import VisualSmell
from cogmap.features.seam import wraps_around


@experiment(
    room="furnished",
    views=17_000,
    takes=("nose", "motion", "camera", "body", "map"),
    extra_rooms=("cue_square",),
)
def fusion(conditions: Conditions) -> Result:
    """Compare cells that see, cells that smell, and cells that see what smell has taught them.

    The same competitive layer learns from the Sanger codes of the views (`vision_only`) and from the log
    odour that the nose smells (`olfaction_only`); the two populations of the map (`fused`) fire from sight.
    All are measured on a fresh walk, each cell both as a place cell and as a head-direction cell.
    `place_cells_passing` and `heading_cells_passing` of `vision_only` and `olfaction_only` are of the same
    cells; `position_median_m` of `olfaction_only` is read from the raw nose. `in_field_direction_vector` is
    the median over the cells that have a field. `seconds` are those of learning, by stage; `reason` and
    `metric_reason` say why the map is not to be trusted, or lays out no places.

    `visual_smell` is a map whose second sense is made of the same panoramas (`cogmap.features.VisualSmell`),
    for explorers that have no nose; only eyes that look all around have it.

    `competition` is the other control: the same walks, learnt once with smell among what charts compete for
    and once with sight alone there (`CognitiveMap(smell=0)`), here and where one card alone tells four equal
    walls apart. Both maps learn place and heading from smell, and both fire from sight alone afterwards.
    """
    trial = Trial.of(conditions)
    truth, cmap = trial.truth, trial.cmap
    cells = {
        "vision only": truth.measure(competing_cells(*trial.codes, seed=conditions.seed)[0]),
        "olfaction only": truth.measure(competing_cells(*trial.smells, seed=conditions.seed)[0]),
        "fused, place": trial.place,
        "fused, heading": trial.heading,
    }
    alone = {
        name: {**cells[name].place_figures, **cells[name].heading_figures}
        for name in ("vision only", "olfaction only")
    }
    competition = {
        item.conditions.room.name: {
            "with_smell": _figures(item),
            "sight_alone": _figures(replace(item, conditions=_without_smell(item.conditions))),
        }
        for item in (trial, *(Trial.of(replace(conditions, room=room)) for room in conditions.extra_rooms))
    }
    seen_twice = _by_visual_smell(trial)
    return Result(
        {
            "vision_only": alone["vision only"],
            "olfaction_only": {**alone["olfaction only"], **truth.position(*trial.smells)},
            "fused": {
                **trial.figures,
                **trial.nose_figures,
                **trust_report(cmap),
                "metric_reason": cmap.metric_reason_,
                "seconds": {stage: round(spent, 3) for stage, spent in cmap.seconds_.items()},
            },
            **seen_twice,
            "competition": competition,
        },
        *show_cells(cells),
    )


def _without_smell(conditions: Conditions) -> Conditions:
    return replace(conditions, map={**conditions.map, "smell": 0.0})


def _by_visual_smell(trial: Trial) -> dict[str, Any]:
    """Learn once more with a second sense made of the views; nothing where these do not look all around."""
    if not wraps_around(trial.walk.views):
        return {}
    smell = VisualSmell()
    walk, fresh = (
        replace(item, odours=give(item.views))
        for item, give in ((trial.walk, smell.fit_transform), (trial.fresh, smell.transform))
    )
    return {"visual_smell": _figures(replace(trial, walk=walk, fresh=fresh))}


def _figures(trial: Trial) -> dict[str, Any]:
    return {**trial.figures, **trust_report(trial.cmap)}
