import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.csgraph import minimum_spanning_tree

from cogmap.features import compass
from cogmap.features.compass import misfit, synchronise_headings, turns
from cogmap.features.strips import strips
from cogmap.graph.neighbour_graph import neighbour_graph

AZIMUTHS = np.pi - 2 * np.pi * (np.arange(360) + 0.5) / 360
RNG = np.random.default_rng(0)
WAVES = RNG.normal(size=(10, 15)) + 1j * RNG.normal(size=(10, 15))


def off(angles: np.ndarray) -> np.ndarray:
    return np.rad2deg(np.abs(np.angle(np.exp(1j * angles))))


def panorama(bearings: np.ndarray) -> np.ndarray:
    """What ten rows of a picture at infinity look like where each column looks in this direction."""
    grey = (WAVES @ np.exp(1j * np.outer(np.arange(1, 16), bearings))).real
    return np.repeat(np.clip(128 + 12 * grey, 0, 255)[..., None], 3, axis=-1).astype(np.uint8)


def test_turns_are_the_first_heading_minus_the_second() -> None:
    headings = RNG.uniform(-np.pi, np.pi, 40)
    found = strips(np.stack([panorama(AZIMUTHS + heading) for heading in headings])).grey
    pairs = RNG.integers(0, 40, (100, 2))
    assert off(turns(found, pairs) - headings[pairs[:, 0]] + headings[pairs[:, 1]]).max() < 0.5


def test_blocks_of_pairs_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    found = strips(np.stack([panorama(AZIMUTHS + heading) for heading in range(6)])).grey
    pairs = RNG.integers(0, 6, (20, 2))
    whole = turns(found, pairs)
    unlike = misfit(found, pairs, whole)
    monkeypatch.setattr(compass, "BLOCK", 7)
    np.testing.assert_allclose(turns(found, pairs), whole, atol=1e-6)
    np.testing.assert_allclose(misfit(found, pairs, whole), unlike, atol=1e-6)


@pytest.mark.parametrize("stripes", [1, 27])
def test_the_broadest_and_the_finest_stripes_do_not_tell_the_turn(stripes: int) -> None:
    """They stand still, or repeat too often to say which is which, and are as strong as all that turned."""
    views = [panorama(AZIMUTHS + heading).astype(float) / 2 for heading in (0.9, 0.0)]
    blurred = 60 * (1 + np.cos(stripes * AZIMUTHS))
    both = np.stack([view + blurred[:, None] for view in views]).astype(np.uint8)
    assert off(turns(strips(both).grey, np.array([[0, 1]])) - 0.9)[0] < 5


@pytest.mark.parametrize("step", [0.0, 1.0, -2.2])
def test_a_step_past_what_is_near_on_one_side_is_no_turn(step: float) -> None:
    """Nearness is 0.15 on the left and 0.02 on the right, so that the mean flow is far from the turn."""
    nearness = 0.085 + 0.065 * np.sin(AZIMUTHS)
    flow = nearness * np.sin(AZIMUTHS - step)
    found = strips(np.stack([panorama(AZIMUTHS + 0.4), panorama(AZIMUTHS - flow)])).grey
    turn = turns(found, np.array([[0, 1]]))
    assert off(turn - 0.4)[0] < 0.5 * np.rad2deg(np.abs(flow.mean()))


def test_pairs_of_two_sets_and_views_of_nothing() -> None:
    ours, theirs = (strips(panorama(AZIMUTHS + by)[None]).grey for by in (1, -0.5))
    assert off(turns(ours, np.array([[0, 0]]), theirs) - 1.5)[0] < 0.5
    blank = strips(np.full((2, 10, 90, 3), 77, np.uint8)).grey
    assert np.isfinite(turns(blank, np.array([[0, 1]]))).all()


def test_misfit_is_what_is_left_once_both_are_turned_alike() -> None:
    first, turned, other = (panorama(AZIMUTHS + 0.7), panorama(AZIMUTHS - 0.5), panorama(2 * AZIMUTHS))
    ours, theirs = strips(first[None]).grey, strips(np.stack([turned, other, first])).grey
    pairs = np.array([[0, 0], [0, 0], [0, 1], [0, 2]])
    found = misfit(ours, pairs, np.array([1.2, 0.2, 0.0, 0.0]), theirs)
    assert found[0] < 2e-3
    assert found[3] < 1e-9
    assert (found[1:3] > 0.5).all()
    assert (found <= 2).all()
    # by Parseval it is the same over pixels, all but their means
    grey = [view.astype(float).mean(axis=2) for view in (first, other)]
    plain, away = (image - image.mean(axis=1, keepdims=True) for image in grey)
    trusted = np.square(plain - away).sum() / (np.square(plain).sum() + np.square(away).sum())
    assert found[2] == pytest.approx(trusted, abs=0.01)
    inverted = strips((255 - first)[None]).grey
    assert misfit(ours, pairs[:1], np.zeros(1), inverted)[0] == pytest.approx(2, abs=0.02)


def ring(count: int, rng: np.random.Generator) -> tuple[sp.csr_array, np.ndarray, np.ndarray]:
    places = rng.uniform(-1, 1, (count, 2))
    graph = neighbour_graph(places, 8)
    return graph, np.column_stack(sp.triu(graph, 1).nonzero()), rng.uniform(-np.pi, np.pi, count)


def test_north_is_common_where_turns_agree() -> None:
    graph, edges, headings = ring(300, np.random.default_rng(1))
    turned = np.angle(np.exp(1j * (headings[edges[:, 0]] - headings[edges[:, 1]])))
    found = synchronise_headings(graph, edges, turned)
    assert np.abs(found).max() <= np.pi
    north = np.angle(np.exp(1j * (found - headings)).mean())
    assert off(found - headings - north).max() < 1e-2


def test_outliers_count_less_beside_a_tree_that_has_none(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(2)
    graph, edges, headings = ring(300, rng)
    tree = minimum_spanning_tree(graph)
    beside = np.asarray((tree + tree.T)[edges[:, 0], edges[:, 1]]) == 0
    turned = headings[edges[:, 0]] - headings[edges[:, 1]] + 0.5 * (beside & (rng.random(len(edges)) < 0.1))

    def errors() -> np.ndarray:
        found = synchronise_headings(graph, edges, turned)
        return off(np.diff(found[edges])[:, 0] - np.diff(headings[edges])[:, 0])

    robust = np.percentile(errors(), 90)
    monkeypatch.setattr(compass, "OUTLIERS", [1e6])
    assert robust < 0.3
    assert np.percentile(errors(), 90) > 10 * robust


def test_least_squares_where_nothing_is_an_outlier(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compass, "OUTLIERS", [1e6])
    rng = np.random.default_rng(3)
    graph, edges, headings = ring(60, rng)
    turned = 0.1 * (headings[edges[:, 0]] - headings[edges[:, 1]]) + 0.05 * rng.standard_normal(len(edges))
    found = synchronise_headings(graph, edges, turned)
    lengths = graph[edges[:, 0], edges[:, 1]]
    incidence = np.eye(60)[edges[:, 0]] - np.eye(60)[edges[:, 1]]
    root = 1 / (lengths + 0.1 * np.median(lengths))
    trusted = np.linalg.lstsq(root[:, None] * incidence, root * turned, rcond=None)[0]
    np.testing.assert_allclose(found - found.mean(), trusted - trusted.mean(), atol=1e-3)


def test_what_a_loop_has_too_much_is_shared_by_all_of_it() -> None:
    rng = np.random.default_rng(5)
    around = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    places = (1 + rng.uniform(-0.1, 0.1, 200))[:, None] * np.column_stack([np.cos(around), np.sin(around)])
    graph = neighbour_graph(places, 8)
    edges = np.column_stack(sp.triu(graph, 1).nonzero())
    apart = np.angle(np.exp(1j * (around[edges[:, 0]] - around[edges[:, 1]])))
    found = synchronise_headings(graph, edges, 0.05 * apart)  # 18° too many once around
    assert off(np.diff(found[edges])[:, 0] + 0.05 * apart).max() < 1


def test_each_piece_has_a_north_of_its_own_and_a_lone_view_one_too() -> None:
    one, edges, headings = ring(40, np.random.default_rng(4))
    graph = sp.csr_array(sp.block_diag([one, one, sp.csr_array((1, 1))]))
    both, true = np.concatenate([edges, edges + 40]), np.concatenate([headings, headings, [0.0]])
    found = synchronise_headings(graph, both, true[both[:, 0]] - true[both[:, 1]])
    for piece in (slice(0, 40), slice(40, 80)):
        away = np.exp(1j * (found[piece] - true[piece]))
        assert off(np.angle(away / away[0])).max() < 1e-2
    assert found[80] == 0
    assert synchronise_headings(sp.csr_array((1, 1)), np.empty((0, 2), int), np.empty(0)).tolist() == [0]
