"""The metric map of places, and the compass's offset at each, learnt from the order of views alone."""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple, TypeAlias

import torch
from jaxtyping import Bool, Complex, Float
from torch import Tensor, nn

from neurons.angles import wrap_angle
from neurons.layers.place_cells import PlaceCells

MOST_ITERATIONS, CONVERGED = 20_000, 1e-9
"""Of the power iteration, and the change of a unit number that ends it."""


class MetricReading(NamedTuple):
    """What the metric map reads off smells."""

    position: Float[Tensor, "views 2"]
    """In the map's own frame, in steps from view to view; NaN before it is learnt."""
    offset: Float[Tensor, "views"]
    """By how much the compass is to be corrected there, rad; 0 before it is learnt."""


class MetricMap(nn.Module):
    """Places get positions, and the compass an offset at each, so that views follow each other ahead.

    The place cells share a smell o out as w(o), Σ w = 1. Each holds an affine map of its surroundings and an
    offset of heading f_p, |f_p| = 1, both as complex numbers:

        x(o) = Σ_p w_p (x_p + B_p (o − c_p)) = b(o)·β,        e^{iθ} = e^{iθ̂} f(o),  f(o) = Σ_p w_p f_p.

    Where a body looks it goes: for views t and t + 4 with no turn between them, v = b(o_{t+4}) − b(o_t) and u
    the mean of e^{iθ̂} on the way, v·β should be u f. With the sums S = Σ v vᵀ and D = Σ w ū vᵀ least squares
    gives β = S⁻¹ Dᴴ f, and the displacements that agree best with the compass give f, in turn the phases of

        f ← phase(D S⁻¹ Dᴴ f):

    again a synchronisation, of places connected by walking. The sums are kept for two halves of the walk,
    alternating; unless the map of either foretells the displacements of the other, nothing is learnt, and
    `diagnosis` says so. Sums can be added to by a stream and merged between maps of the same place cells; in
    double precision, as S⁻¹ makes much of little.

    Of few views with noisy smells each half would follow its own noise. Then the maps of all places are drawn
    towards one for all of them, which is affine in o, x_p = x_0 + B c_p and B_p = B, for a compass that is
    taken to be right, f = 1.

    Parameters
    ----------
    cells, odorants
        Of the place cells that it stands on.
    lag
        Steps from view to view in a displacement: long against the error of recall, short against the room.
    straight
        Largest turn per step of a displacement, rad; a look around turns more.
    ridge
        Prior on the map, as a fraction of the mean square of a feature's displacement.
    stiffness
        Prior on what is not one affine map, where `ridge` alone does not suffice.
    least_r2
        Least share of the displacements of one half of a walk that the other half foretells, in a map worth
        having: .88 to .98 on walks of 6,000 views and more, at most .56 where views do not follow each
        other, whatever the headings do.

    References
    ----------
    Singer (2011), Angular synchronization by eigenvectors and semidefinite programming. ACHA 30.
    Boumal (2016), Nonconvex phase synchronization. SIAM J. Optimization 26 (the power iteration).
    """

    def __init__(
        self,
        cells: int,
        odorants: int,
        *,
        lag: int = 4,
        straight: float = 0.25,
        ridge: float = 1e-3,
        stiffness: float = 10.0,
        least_r2: float = 0.8,
    ) -> None:
        super().__init__()
        self.lag, self.straight, self.ridge, self.least_r2 = lag, straight, ridge, least_r2
        self.stiffness = stiffness
        features = cells * (odorants + 1)
        self.spread: Tensor = nn.Buffer(torch.zeros(2, features, features, dtype=torch.double))
        self.ahead: Tensor = nn.Buffer(torch.zeros(2, cells, features, 2, dtype=torch.double))
        self.shared: Tensor = nn.Buffer(torch.zeros(2, cells, cells, dtype=torch.double))
        self.counted: Tensor = nn.Buffer(torch.zeros(2, 2, dtype=torch.double))
        self.seen: Tensor = nn.Buffer(torch.zeros((), dtype=torch.int64))
        self.recent: Tensor = nn.Buffer(torch.full((lag, odorants + 1), torch.nan))
        self.cross_validated_r2: Tensor = nn.Buffer(torch.full((2,), torch.nan))
        self.positions: Tensor = nn.Buffer(torch.full((features, 2), torch.nan))
        self.offsets: Tensor = nn.Buffer(torch.zeros(cells))

    def forward(self, place: PlaceCells, log_odours: Float[Tensor, "views odorants"]) -> MetricReading:
        """Tell the position of smells and the offset of the compass there."""
        share, patches = _patches(place, log_odours)
        return MetricReading(patches @ self.positions, self._offset(share))

    def partial_fit(
        self, place: PlaceCells, log_odours: Float[Tensor, "views odorants"], headings: Float[Tensor, "views"]
    ) -> None:
        """Add the next views of a walk, in order; they follow those of the last call."""
        walk = torch.cat([self.recent, torch.cat([log_odours, headings[:, None]], dim=1)])
        self.recent = walk[-self.lag :].clone()
        share, patches = _patches(place, walk[:, :-1])
        straight, direction = self._directions(walk[:, -1] + self._offset(share))
        # blocks of many times the lag, as displacements that overlap are not independent; short against a
        # walk, so that both halves see all of the room
        half = (self.seen + torch.arange(len(straight), device=straight.device)) // 128 % 2
        self.seen += len(straight)
        moved = patches[self.lag :] - patches[: -self.lag]
        # the middle of the way: its views are not those whose errors the displacement holds
        under = share[1:-1].unfold(0, self.lag - 1, 1).mean(dim=2)
        for number in (0, 1):
            mine = straight & (half == number)
            v, w, u = moved[mine].double(), under[mine].double(), direction[mine].to(torch.cdouble)
            self.spread[number] += v.T @ v
            # v is real: two real products, where half of a complex one would be wasted
            back = (w[:, :, None] * torch.view_as_real(u.conj().resolve_conj())[:, None]).movedim(2, 0)
            self.ahead[number] += (back.mT @ v).movedim(0, 2)
            # less than 1 where heading swayed on the way: |u|² weighs such a way as the fit does
            power = u.abs().square()
            self.shared[number] += w.T @ (power[:, None] * w)
            self.counted[number] += torch.stack([power.sum(), mine.sum()])

    def solve(self, place: PlaceCells) -> None:
        """Learn positions and offsets from the sums, if either half of the walk foretells the other."""
        # fewer displacements than cells leave offsets that nothing determines
        halves = [self._evidence(slice(number, number + 1)) for number in (0, 1)]
        if min(half.pairs for half in halves) < len(self.offsets):
            return
        whole = torch.eye(len(self.positions)).to(self.spread)
        learnt = partial(_Evidence.solve, prior=self.ridge * whole)
        foretold = _foretold(halves, learnt)
        if min(foretold) < self.least_r2:
            # a map that cannot bend would bend the compass in its place, which therefore stays as it is
            stiff = partial(
                _Evidence.without_offsets,
                prior=self.ridge * whole + self.stiffness * (whole - _affine(place)),
            )
            tried = ((foretold, learnt), (_foretold(halves, stiff), stiff))
            foretold, learnt = max(tried, key=lambda found: min(found[0]))
        self.cross_validated_r2 = self.cross_validated_r2.new_tensor(foretold)
        if not self.diagnosis():
            positions, turns = learnt(self._evidence(slice(0, 2)))
            self.positions = torch.view_as_real(positions).float()
            self.offsets = wrap_angle(self.offsets + turns.angle().float())

    def check(self) -> None:
        """Learn from the sums whether displacements are still those of the map as it is."""
        halves = [self._evidence(slice(number, number + 1)) for number in (0, 1)]
        if self.positions.isnan().any() or min(half.pairs for half in halves) < len(self.offsets):
            return
        positions = torch.view_as_complex(self.positions.double())
        turns = torch.ones_like(halves[0].ahead[:, 0])  # headings have been corrected already
        found = [half.cross_validated_r2(positions, turns) for half in halves]
        self.cross_validated_r2 = self.cross_validated_r2.new_tensor(found)

    def diagnosis(self) -> str:
        """Say why nothing is learnt, or nothing when it is."""
        if self.cross_validated_r2.isnan().any():
            return (
                f"{int(self.counted[:, 1].sum())} of {int(self.seen)} views were come to straight ahead, too "
                "few for a metric map; show it longer walks, in order"
            )
        share = float(self.cross_validated_r2.min())
        if share < self.least_r2:
            return (
                f"one half of the walk foretells {share:.2f} of the displacements of the other, "
                f"less than {self.least_r2}: what follows a view does not lie ahead of it; "
                "show it longer walks, in order"
            )
        return ""

    def begin_again(self) -> None:
        """Forget the sums: what follows is learnt on headings that are corrected by what is known by now."""
        for sums in (self.spread, self.ahead, self.shared, self.counted, self.seen):
            sums.zero_()

    def _offset(self, share: Float[Tensor, "views cells"]) -> Float[Tensor, "views"]:
        return torch.atan2(share @ self.offsets.sin(), share @ self.offsets.cos())

    def _directions(
        self, headings: Float[Tensor, "views"]
    ) -> tuple[Bool[Tensor, "ways"], Complex[Tensor, "ways"]]:
        """Tell for each view and the one `lag` later if the way is straight, and the mean heading on it."""
        heading = torch.polar(torch.ones_like(headings), headings)
        # as products of unit numbers, turns need no wrapping, and NaN after a jump is never below a bound
        turned = (heading[1:] * heading[:-1].conj()).angle().abs().unfold(0, self.lag, 1)
        steps = ((heading[1:] + heading[:-1]) / 2).unfold(0, self.lag, 1)
        return (turned < self.straight).all(dim=1), steps.mean(dim=1)

    def _evidence(self, halves: slice) -> "_Evidence":
        power, pairs = self.counted[halves].sum(dim=0).tolist()
        return _Evidence(
            self.spread[halves].sum(dim=0),
            torch.view_as_complex(self.ahead[halves].sum(dim=0)),
            self.shared[halves].sum(dim=0),
            power,
            pairs,
        )


_Learnt: TypeAlias = tuple[Complex[Tensor, "features"], Complex[Tensor, "cells"]]
"""β and f."""


class _Evidence(NamedTuple):
    """Sums over displacements: S, D, Σ |u|² w wᵀ, Σ |u|², and how many."""

    spread: Float[Tensor, "features features"]
    ahead: Complex[Tensor, "cells features"]
    shared: Float[Tensor, "cells cells"]
    power: float
    pairs: float

    def solve(self, prior: Float[Tensor, "features features"]) -> _Learnt:
        """Give β and f; the prior is relative to the mean square of a feature, as sums grow with the walk."""
        placing = self._placing(prior)
        turns = torch.ones_like(self.ahead[:, 0])
        agreement = self.ahead @ placing
        # fifty will do in a room; two that a door joins turn against each other for thousands
        for _ in range(MOST_ITERATIONS):
            # sgn(0) is 0: a cell without any displacement keeps out of it instead of turning NaN
            before, turns = turns, torch.sgn(agreement @ turns)
            if (turns - before).abs().max() < CONVERGED:
                break
        return placing @ turns, turns

    def without_offsets(self, prior: Float[Tensor, "features features"]) -> _Learnt:
        """Give β for a compass that is right everywhere, f = 1."""
        turns = torch.ones_like(self.ahead[:, 0])
        return self._placing(prior) @ turns, turns

    def _placing(self, prior: Float[Tensor, "features features"]) -> Complex[Tensor, "features cells"]:
        """Give S⁻¹ Dᴴ."""
        # cells that the walk never came by leave S singular
        prior = self.spread.diagonal().mean() * prior
        # S is real: two real right-hand sides cost half of a complex system
        parts = torch.view_as_real(self.ahead.mH.resolve_conj())
        solved = torch.linalg.solve(self.spread + prior, parts.flatten(1)).reshape(parts.shape)
        return torch.view_as_complex(solved.contiguous())

    def cross_validated_r2(
        self, positions: Complex[Tensor, "features"], turns: Complex[Tensor, "cells"]
    ) -> float:
        """Share of Σ |u f|² that is left when Σ |v·β − u f|² is taken away, for β and f learnt elsewhere."""
        # the square multiplied out, so that sums suffice and no view need be kept; real but for rounding
        moved = (positions.conj() @ self.spread.to(torch.cdouble) @ positions).real
        looked = (turns.conj() @ self.shared.to(torch.cdouble) @ turns).real
        both = (turns.conj() @ self.ahead @ positions).real
        return 1 - float(moved + looked - 2 * both) / self.power


def _foretold(halves: list[_Evidence], learn: Callable[[_Evidence], _Learnt]) -> tuple[float, float]:
    """Share of the displacements of either half that the map of the other foretells."""
    one, other = halves
    return one.cross_validated_r2(*learn(other)), other.cross_validated_r2(*learn(one))


def _affine(place: PlaceCells) -> Float[Tensor, "features features"]:
    """Project on what is one affine map for all: x_p = x_0 + B c_p, and B_p = B."""
    centres = place.centres.double()
    cells, odorants = centres.shape
    # columns are x_0 and, of B, one odorant after the other
    columns = centres.new_zeros(cells, odorants + 1, odorants + 1)
    columns[:, 0, 0] = 1
    columns[:, 0, 1:] = centres
    columns[:, 1:, 1:] = torch.eye(odorants).to(columns)
    basis: Tensor = torch.linalg.qr(columns.flatten(0, 1)).Q
    return basis @ basis.T


def _patches(
    place: PlaceCells, log_odours: Float[Tensor, "views odorants"]
) -> tuple[Float[Tensor, "views cells"], Float[Tensor, "views features"]]:
    """Give the share w_p of each place cell and the features w_p (1, o − c_p)."""
    share = place.share(log_odours)
    beside = nn.functional.pad(log_odours[:, None] - place.centres, (1, 0), value=1.0)
    return share, (share[:, :, None] * beside).flatten(1)
