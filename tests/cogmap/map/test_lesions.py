import numpy as np
import pytest
import torch

from arena import Recording
from cogmap import CognitiveMap
from cogmap.map.lesions import afferent_weights, lesioned, weights_of, with_blank_afferents, with_state
from neurons.layers.readout import ChartActivity


def test_nothing_changed_is_the_same_map(cmap: CognitiveMap, walk: Recording) -> None:
    same = with_state(cmap, {})
    for one, other in zip(
        vars(cmap.perceive(walk.views[:50])).values(),
        vars(same.perceive(walk.views[:50])).values(),
        strict=True,
    ):
        np.testing.assert_array_equal(one, other)


def test_a_newborn_remembers_all_but_its_cells_hear_nothing(cmap: CognitiveMap, walk: Recording) -> None:
    known, blank = (some.perceive(walk.views[:50]) for some in (cmap, with_blank_afferents(cmap)))
    assert not blank.place.any()
    assert not blank.heading.any()
    np.testing.assert_array_equal(blank.phase, known.phase)
    np.testing.assert_array_equal(blank.odour, known.odour)


def test_a_newborn_learns_the_same_weights_again(cmap: CognitiveMap, walk: Recording) -> None:
    growing = with_blank_afferents(cmap)
    growing.partial_fit(walk.views[:1000], walk.odours[:1000])
    growing.partial_fit(walk.views[1000:], walk.odours[1000:])
    for cells in ("place", "heading"):
        np.testing.assert_allclose(
            afferent_weights(growing, cells), afferent_weights(cmap, cells), rtol=1e-3, atol=1e-3
        )


def excited(cmap: CognitiveMap, walk: Recording) -> ChartActivity:
    layers = cmap._rooms[0]
    with torch.no_grad():
        codes = torch.from_numpy(cmap.encode(walk.views))
        # as the charts have voted
        return layers.readout(layers.charts, codes, layers.readout.excite(layers.charts, codes)).excited


@pytest.mark.parametrize("cells", ["place", "heading"])
def test_weights_are_what_cells_fire_by(cmap: CognitiveMap, walk: Recording, cells: str) -> None:
    weights = afferent_weights(cmap, cells)
    chart, activity = excited(cmap, walk)
    fired = np.einsum("nw,nwc->nc", activity.numpy(), weights[chart.numpy()])
    np.testing.assert_allclose(getattr(cmap.perceive(walk.views), cells), fired, rtol=1e-4, atol=1e-4)


def test_silent_charts_are_never_heard(cmap: CognitiveMap, walk: Recording) -> None:
    views = walk.views[:100]
    silent = np.random.default_rng(0).permutation(cmap.charts)[: cmap.charts // 2]
    assert np.isin(silent, excited(cmap, walk).chart.numpy()).all()
    less = lesioned(cmap, silent)
    assert not np.isin(silent, excited(less, walk).chart.numpy()).any()
    heard = less.perceive(views)
    assert np.isfinite(heard.place).all()
    assert not np.array_equal(heard.place, cmap.perceive(views).place)
    weights = weights_of(less)
    for name in ("place.afferents.association", "heading.afferents.association"):
        weights[name] = weights[name].clone()
        weights[name][silent] = 1e9
    np.testing.assert_array_equal(with_state(less, weights).perceive(views).place, heard.place)


def test_no_chart_silenced_changes_nothing(cmap: CognitiveMap, walk: Recording) -> None:
    none = lesioned(cmap, np.zeros(0, dtype=int))
    np.testing.assert_array_equal(
        none.perceive(walk.views[:20]).heading, cmap.perceive(walk.views[:20]).heading
    )


def test_the_map_itself_is_left_as_it_is(cmap: CognitiveMap) -> None:
    before = weights_of(cmap)
    lesioned(cmap, np.arange(10))
    with_blank_afferents(cmap)
    for name, kept in weights_of(cmap).items():
        assert kept.equal(before[name]) or kept.isnan().any(), name


def test_a_map_is_operated_on_in_memory(cmap: CognitiveMap, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CognitiveMap, "save", None)
    lesioned(with_blank_afferents(cmap), np.arange(10))


def test_only_weights_that_a_map_has_can_be_changed(cmap: CognitiveMap) -> None:
    with pytest.raises(KeyError):
        with_state(cmap, {"charts.centers": torch.zeros(1)})


def test_only_populations_have_afferents(cmap: CognitiveMap) -> None:
    with pytest.raises(KeyError):
        afferent_weights(cmap, "grid")
