import pytest
import torch

from neurons.circuit import Circuit
from neurons.guard import Guard


def circuit(*, most_charts: int = 60, guard: Guard | None = None) -> Circuit:
    return Circuit(
        30,
        3,
        charts=40,
        most_charts=most_charts,
        components=8,
        place_cells=10,
        heading_cells=6,
        generator=torch.Generator().manual_seed(0),
        guard=guard,
    )


def test_charts_are_judged_by_the_guard_that_is_given() -> None:
    guarded = circuit(guard=Guard(least_eigenvalue=0.5))
    guarded.agreement = torch.tensor([0.9, 0.8])
    assert guarded.atlas_diagnosis() == guarded.guard.atlas(*guarded.agreement.tolist())
    assert "heading axes" in guarded.atlas_diagnosis()


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
    smells = torch.randn(5, 3, generator=generator)
    seeing.charts.smells = torch.randn(40, 3, generator=generator)
    both = seeing.recall(strips, smells)
    points = torch.cat([codes, seeing.charts.smell_weight * smells], dim=1)
    assert torch.equal(both.chart, torch.cdist(points, seeing.charts.points).argsort()[:, :8])
    assert not torch.equal(both.chart, recalled.chart)


@pytest.mark.parametrize(("most", "charts"), [(60, 60), (100, 80)])
def test_added_charts_keep_what_does_not_stand_on_charts(most: int, charts: int) -> None:
    grown, fresh = circuit(most_charts=most), circuit()
    grown.charts.centres = torch.randn(40, 8, generator=torch.Generator().manual_seed(1))
    for name in ("olfaction.gram", "readout.phases", "place.centres", "heading.afferents.activity"):
        grown.get_buffer(name).fill_(1.0)
    grown.place.branches.fill_(False)  # noqa: FBT003
    for name in ("agreement", "ambiguity", "connected", "spectrum", "votes", "felt"):
        grown.get_buffer(name).fill_(1.0)
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
    for name in ("ambiguity", "spectrum", "votes", "felt"):
        assert grown.get_buffer(name).isnan().all(), name
    assert not grown.connected


def spread(seeing: Circuit, *dimensions: int) -> None:
    """Let so many charts each have seen 1, 2, … dimensions."""
    variances = [
        [1.0] * d + [0.01] * (6 - d) for d, charts in enumerate(dimensions, 1) for _ in range(charts)
    ]
    seeing.charts.variances = torch.tensor(variances)


@pytest.mark.parametrize(
    ("dimensions", "told", "kept"),
    [((0, 24, 16), (2, 0.6), 2), ((4, 4, 4, 28), (4, 0.7), 4), ((14, 13, 13), (1, 0.35), 3)],
)
def test_charts_keep_the_tangents_that_most_tell(
    dimensions: tuple[int, ...], told: tuple[int, float], kept: int
) -> None:
    """Too few that agree say nothing: charts keep as many as they began with."""
    seeing = circuit()
    assert seeing.dimension[0] == 0
    seeing.widen_charts()
    assert seeing.charts.dimensions == 6
    widest = seeing.charts.tangents.clone()
    spread(seeing, *dimensions)
    seeing.cut_charts()
    assert seeing.dimension == (told[0], pytest.approx(told[1]))
    assert torch.equal(seeing.charts.tangents, widest[:, :kept])
    assert seeing.olfaction.gram.shape == (40, kept + 1, kept + 1)
    assert seeing.readout.jacobians.shape == (40, kept, 3)


def test_views_that_are_all_the_same_tell_no_dimension() -> None:
    seeing = circuit()
    seeing.widen_charts()
    seeing.cut_charts()
    assert seeing.dimension[0] == 0
    assert seeing.votes.isnan().all()
    assert seeing.charts.dimensions == 3
