import pytest
import torch

from neurons.circuit import Circuit


def circuit(*, most_charts: int = 60, **bounds: float) -> Circuit:
    return Circuit(
        30,
        3,
        charts=40,
        most_charts=most_charts,
        components=8,
        place_cells=10,
        heading_cells=6,
        generator=torch.Generator().manual_seed(0),
        **bounds,
    )


@pytest.mark.parametrize(
    ("signs", "phases", "bounds", "said"),
    [
        (1.0, 0.9, {}, "too coarse"),
        (0.9, 0.9999, {}, "heading axes"),
        (torch.nan, torch.nan, {}, "no loop"),
        (1.0, 0.9999, {}, ""),
        (1.0, 0.9, {"least_eigenvalue": 0.85}, ""),
        (1.0, 0.9999, {"least_eigenvalue": 0.99995}, "below 0.99995"),
        (0.9, 0.9999, {"least_sign_agreement": 0.85}, ""),
        (0.996, 0.9999, {"least_sign_agreement": 0.997}, "heading axes"),
    ],
)
def test_diagnosis_of_the_atlas(signs: float, phases: float, bounds: dict[str, float], said: str) -> None:
    guarded = circuit(**bounds)
    guarded.agreement = torch.tensor([signs, phases])
    reason = guarded.atlas_diagnosis()
    assert said in reason
    assert bool(reason) == bool(said)


def test_recall_is_code_charts_and_readout() -> None:
    seeing = circuit()
    generator = torch.Generator().manual_seed(1)
    seeing.charts.centres = torch.randn(40, 8, generator=generator)
    for name, value in seeing.readout.named_buffers():
        setattr(seeing.readout, name, torch.rand(value.shape, generator=generator) + 0.1)
    strips = torch.randn(5, 30, generator=generator)
    recalled = seeing.recall(strips)
    codes = strips @ seeing.code.weight.T
    nearest = torch.cdist(codes, seeing.charts.centres).argsort()[:, :8]
    assert torch.equal(recalled.excited.chart, nearest)
    trusted = seeing.readout(seeing.charts, codes, seeing.readout.excite(seeing.charts, codes))
    torch.testing.assert_close(recalled, trusted)


@pytest.mark.parametrize(("most", "charts"), [(60, 60), (100, 80)])
def test_added_charts_keep_what_does_not_stand_on_charts(most: int, charts: int) -> None:
    grown, fresh = circuit(most_charts=most), circuit()
    grown.charts.centres = torch.randn(40, 8, generator=torch.Generator().manual_seed(1))
    for name in ("olfaction.gram", "readout.phases", "place.centres", "heading.afferents.activity"):
        grown.get_buffer(name).fill_(1.0)
    grown.place.branches.fill_(False)  # noqa: FBT003
    grown.agreement.fill_(1.0)
    grown.add_charts()
    assert len(grown.charts) == charts
    assert (grown.place.centres == 1).all()
    assert grown.place.branches.all()
    for name in ("code.weight", "heading.preferred", "place.covariances", "metric_map.spread"):
        assert torch.equal(grown.get_buffer(name), fresh.get_buffer(name)), name
    for layer in (grown.olfaction.gram, grown.readout.phases, grown.place.afferents.activity):
        assert len(layer) == charts
    assert not grown.olfaction.gram.any()
    assert not grown.heading.afferents.activity.any()
    assert len(grown.heading.afferents.activity) == charts
    assert grown.agreement.isnan().all()
