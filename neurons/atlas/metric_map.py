"""The metric map of places, and by how much the compass is off, learnt from the order of views alone."""

from typing import NamedTuple

import torch
from jaxtyping import Bool, Complex, Float
from torch import Tensor, nn

from neurons.angles import mean_angle, wrap_angle
from neurons.layers.heading_cells import HeadDirectionCells
from neurons.layers.place_cells import PlaceCells

MOST_ITERATIONS, CONVERGED = 20_000, 1e-9
"""Of the power iteration, and the change of a unit number that ends it."""
SUMS = ("spread", "ahead", "shared", "facing", "faced", "counted", "seen")
"""Buffers of a metric map that views add to."""


class MetricReading(NamedTuple):
    """What the metric map makes of smells, and of the headings that were recalled with them."""

    position: Float[Tensor, "views 2"]
    """In the map's own frame, in steps from view to view; NaN before it is learnt."""
    heading: Float[Tensor, "views"]
    """Corrected by what the compass is off there, rad in (−π, π]; as recalled before it is learnt."""


class MetricMap(nn.Module):
    """Places get positions, and the compass its errors, so that views follow each other ahead.

    The place cells share a smell o out as w(o), Σ w = 1, and the head-direction cells a heading θ̂ as q(θ̂).
    Each place cell holds an affine map of its surroundings and an offset of heading f_p, |f_p| = 1, both as
    complex numbers, and each head-direction cell a deviation a_i (rad): as a magnetic compass, this one errs
    by where it is and by where it points.

        x(o) = Σ_p w_p (x_p + B_p (o − c_p)) = b(o)·β,        θ = θ̂ + arg Σ_p w_p f_p + Σ_i q_i a_i.

    Where a body looks it goes: for views t and t + 4 with no turn between them, v = b(o_{t+4}) − b(o_t) and u
    the mean of e^{iθ̂} on the way, v·β should be u f. With the sums S = Σ v vᵀ + R, R the prior on β, and
    D = Σ w ū vᵀ least squares gives β = S⁻¹ Dᴴ f, and the displacements that agree best with the compass give
    f, in turn the phases of

        f ← phase(D S⁻¹ Dᴴ f + λ),

    again a synchronisation, of places connected by walking; λ holds back where displacements are noisy.
    Deviations are small: they are the least squares
    a = (Σ |u|² q qᵀ − Re E S⁻¹ Eᴴ + Λ)⁻¹ Im E β, E = Σ q ū vᵀ, in which positions give way to them. The sums
    are kept for two halves of the walk, alternating; unless the map of either foretells the displacements of
    the other, nothing is learnt, and `diagnosis` says so. Sums can be added to by a stream and merged between
    maps of the same cells; in double precision, as S⁻¹ makes much of little.

    The prior R lets the affine maps of neighbours agree where either has its middle, and costs a map that is
    one affine map in o nothing. It counts as much as so many displacements, however many are seen: without,
    patches follow the errors of recall, and offsets follow the patches.

    Parameters
    ----------
    cells, headings, odorants
        Place cells, head-direction cells, and odorants.
    lag
        Steps from view to view in a displacement: long against the error of recall, short against the room.
    straight
        Largest turn per step of a displacement, rad; a look around turns more.
    ridge
        Prior on β, as a fraction of the mean square of a feature's displacement.
    smoothness
        Displacements that the prior on the bending of the map counts as much as.
    noisy
        Share of displacements not foretold at which it takes one more in each place cell to believe half of
        the offset that they say, and twice as many of a deviation; it grows with the eighth power. Clear
        smells leave .01 to .03, of which even the few ways through a door are to be believed; smells that
        hardly change over half a room .1 and noisy signals .2, whose errors offsets would follow.
    steadiness
        Λ, how many clear displacements in a head-direction cell it takes to believe half of what they say.
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
        headings: int,
        odorants: int,
        *,
        lag: int = 4,
        straight: float = 0.25,
        ridge: float = 1e-4,
        smoothness: float = 6e3,
        noisy: float = 0.08,
        steadiness: float = 30.0,
        least_r2: float = 0.8,
    ) -> None:
        super().__init__()
        self.lag, self.straight, self.ridge, self.least_r2 = lag, straight, ridge, least_r2
        self.smoothness, self.noisy, self.steadiness = smoothness, noisy, steadiness
        features = cells * (odorants + 1)
        self.spread: Tensor = nn.Buffer(torch.zeros(2, features, features, dtype=torch.double))
        self.ahead: Tensor = nn.Buffer(torch.zeros(2, cells, features, 2, dtype=torch.double))
        self.shared: Tensor = nn.Buffer(torch.zeros(2, cells, cells, dtype=torch.double))
        self.facing: Tensor = nn.Buffer(torch.zeros(2, headings, features, 2, dtype=torch.double))
        self.faced: Tensor = nn.Buffer(torch.zeros(2, headings, headings, dtype=torch.double))
        self.counted: Tensor = nn.Buffer(torch.zeros(2, 2, dtype=torch.double))
        self.seen: Tensor = nn.Buffer(torch.zeros((), dtype=torch.int64))
        self.recent: Tensor = nn.Buffer(torch.full((lag, odorants + 1), torch.nan))
        self.cross_validated_r2: Tensor = nn.Buffer(torch.full((2,), torch.nan))
        self.positions: Tensor = nn.Buffer(torch.full((features, 2), torch.nan))
        self.offsets: Tensor = nn.Buffer(torch.zeros(cells))
        self.deviations: Tensor = nn.Buffer(torch.zeros(headings))

    def forward(
        self,
        place: PlaceCells,
        heading: HeadDirectionCells,
        log_odours: Float[Tensor, "views odorants"],
        headings: Float[Tensor, "views"],
    ) -> MetricReading:
        """Tell the position of smells, and correct the headings (rad) that were recalled with them."""
        share, patches = _patches(place, log_odours)
        corrected = self._corrected(share, heading.share(headings), headings)[:, None]
        return MetricReading(patches @ self.positions, mean_angle(corrected, torch.ones_like(corrected)))

    def locate(
        self, place: PlaceCells, log_odours: Float[Tensor, "views odorants"]
    ) -> Float[Tensor, "views 2"]:
        """Tell the position of smells alone, as in the dark."""
        return _patches(place, log_odours)[1] @ self.positions

    def partial_fit(
        self,
        place: PlaceCells,
        heading: HeadDirectionCells,
        log_odours: Float[Tensor, "views odorants"],
        headings: Float[Tensor, "views"],
    ) -> None:
        """Add the next views of a walk, in order; they follow those of the last call."""
        walk = torch.cat([self.recent, torch.cat([log_odours, headings[:, None]], dim=1)])
        self.recent = walk[-self.lag :].clone()
        share, patches = _patches(place, walk[:, :-1])
        faced = heading.share(walk[:, -1])
        straight, direction = self._directions(self._corrected(share, faced, walk[:, -1]))
        # blocks of many times the lag, as displacements that overlap are not independent; short against a
        # walk, so that both halves see all of the room
        half = (self.seen + torch.arange(len(straight), device=straight.device)) // 128 % 2
        self.seen += len(straight)
        moved = patches[self.lag :] - patches[: -self.lag]
        # the middle of the way: its views are not those whose errors the displacement holds
        under, towards = (
            part[1:-1].unfold(0, self.lag - 1, 1).mean(dim=2).double() for part in (share, faced)
        )
        for number in (0, 1):
            mine = straight & (half == number)
            v, u = moved[mine].double(), direction[mine].to(torch.cdouble)
            self.spread[number] += v.T @ v
            # less than 1 where heading swayed on the way: |u|² weighs such a way as the fit does
            power = u.abs().square()
            w, q = under[mine], towards[mine]
            self.ahead[number] += _agreement(w, u, v)
            self.facing[number] += _agreement(q, u, v)
            self.shared[number] += w.T @ (power[:, None] * w)
            self.faced[number] += q.T @ (power[:, None] * q)
            self.counted[number] += torch.stack([power.sum(), mine.sum()])

    def solve(self, place: PlaceCells) -> None:
        """Learn positions and the errors of the compass, if either half of the walk foretells the other."""
        # fewer displacements than cells leave offsets that nothing determines
        halves = [self._evidence(slice(number, number + 1)) for number in (0, 1)]
        if min(half.pairs for half in halves) < len(self.offsets):
            return
        prior = _Prior(self.ridge, self.smoothness, _bending(place), 0.0, self.steadiness)
        one, other = (half.solve(prior) for half in halves)
        foretold = (
            halves[0].cross_validated_r2(other.positions, other.turns),
            halves[1].cross_validated_r2(one.positions, one.turns),
        )
        self.cross_validated_r2 = self.cross_validated_r2.new_tensor(foretold)
        if not self.diagnosis():
            doubt = ((1 - sum(foretold) / 2) / self.noisy) ** 8
            found = self._evidence(slice(0, 2)).solve(prior._replace(doubt=doubt))
            self.positions = torch.view_as_real(found.positions).float()
            self.offsets = wrap_angle(self.offsets + found.turns.angle().float())
            self.deviations = self.deviations + found.deviations.float()

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
        for name in SUMS:
            self.get_buffer(name).zero_()

    def _corrected(
        self,
        share: Float[Tensor, "views cells"],
        faced: Float[Tensor, "views headings"],
        headings: Float[Tensor, "views"],
    ) -> Float[Tensor, "views"]:
        offset = torch.atan2(share @ self.offsets.sin(), share @ self.offsets.cos())
        return headings + offset + faced @ self.deviations

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
            torch.view_as_complex(self.facing[halves].sum(dim=0)),
            self.faced[halves].sum(dim=0),
            power,
            pairs,
        )


class _Prior(NamedTuple):
    """What is held before anything is seen: a ridge, how little maps bend, how little a compass is off."""

    ridge: float
    smoothness: float
    bending: Float[Tensor, "features features"]
    doubt: float
    """Displacements that no offset counts as much as in each place cell,"""
    steadiness: float
    """and no deviation in each head-direction cell, where displacements are clear."""

    def of(self, evidence: "_Evidence") -> Float[Tensor, "features features"]:
        """Give R, in the unit of S: the ridge grows with the walk, and smoothness does not."""
        ridge = self.ridge * torch.eye(len(self.bending)).to(self.bending)
        bending = self.smoothness / evidence.pairs * self.bending
        return evidence.spread.diagonal().mean() * (ridge + bending)


class _Learnt(NamedTuple):
    """β, f and a."""

    positions: Complex[Tensor, "features"]
    turns: Complex[Tensor, "cells"]
    deviations: Float[Tensor, "headings"]


class _Evidence(NamedTuple):
    """Sums over displacements: S, D, Σ |u|² w wᵀ, E, Σ |u|² q qᵀ, Σ |u|², and how many."""

    spread: Float[Tensor, "features features"]
    ahead: Complex[Tensor, "cells features"]
    shared: Float[Tensor, "cells cells"]
    facing: Complex[Tensor, "headings features"]
    faced: Float[Tensor, "headings headings"]
    power: float
    pairs: float

    def solve(self, prior: _Prior) -> _Learnt:
        """Give positions, offsets and deviations."""
        by_place, by_heading = self._placing(prior)
        turns = torch.ones_like(self.ahead[:, 0])
        agreement = self.ahead @ by_place
        # fifty will do in a room; two that a door joins turn against each other for thousands
        for _ in range(MOST_ITERATIONS):
            # sgn(0) is 0: a cell without any displacement keeps out of it instead of turning NaN
            before, turns = turns, torch.sgn(agreement @ turns + prior.doubt)
            if (turns - before).abs().max() < CONVERGED:
                break
        positions = by_place @ turns
        left = self.faced - (self.facing @ by_heading).real
        left = left + prior.steadiness * (1 + prior.doubt) * torch.eye(len(left)).to(left)
        return _Learnt(positions, turns, torch.linalg.solve(left, (self.facing @ positions).imag))

    def _placing(
        self, prior: _Prior
    ) -> tuple[Complex[Tensor, "features cells"], Complex[Tensor, "features headings"]]:
        """Give S⁻¹ Dᴴ and S⁻¹ Eᴴ."""
        # S is real: two real right-hand sides cost half of a complex system
        both = torch.cat([self.ahead, self.facing]).mH
        parts = torch.view_as_real(both.resolve_conj())
        # cells that the walk never came by leave S singular without its prior
        solved = torch.linalg.solve(self.spread + prior.of(self), parts.flatten(1)).reshape(parts.shape)
        placing = torch.view_as_complex(solved.contiguous())
        return placing[:, : len(self.ahead)], placing[:, len(self.ahead) :]

    def cross_validated_r2(
        self, positions: Complex[Tensor, "features"], turns: Complex[Tensor, "cells"]
    ) -> float:
        """Share of Σ |u f|² that is left when Σ |v·β − u f|² is taken away, for β and f learnt elsewhere."""
        # the square multiplied out, so that sums suffice and no view need be kept; real but for rounding
        moved = (positions.conj() @ self.spread.to(torch.cdouble) @ positions).real
        looked = (turns.conj() @ self.shared.to(torch.cdouble) @ turns).real
        both = (turns.conj() @ self.ahead @ positions).real
        return 1 - float(moved + looked - 2 * both) / self.power


def _agreement(
    share: Float[Tensor, "ways cells"],
    direction: Complex[Tensor, "ways"],
    moved: Float[Tensor, "ways features"],
) -> Float[Tensor, "cells features 2"]:
    """Give Σ w ū vᵀ, real and imaginary part."""
    # v is real: two real products, where half of a complex one would be wasted
    back = share[:, :, None] * torch.view_as_real(direction.conj().resolve_conj())[:, None]
    return (back.movedim(2, 0).mT @ moved).movedim(0, 2)


def _bending(place: PlaceCells) -> Float[Tensor, "features features"]:
    """Give the quadratic form of how much the affine maps of neighbours differ where either has its middle.

    Σ_pq W_pq |x_p + B_p (c_q − c_p) − x_q|², W how much of a cell's middle is shared out to the other; 1 for
    a feature on average.
    """
    centres = place.centres.double()
    near = place.share(place.centres).double()
    near = near + near.T
    cells, odorants = centres.shape
    # the map of p at the middle of q
    there = nn.functional.pad(centres - centres[:, None], (1, 0), value=1.0)
    form = centres.new_zeros(cells, odorants + 1, cells, odorants + 1)
    own = torch.einsum("pq,pqi,pqj->pij", near, there, there)
    own[:, 0, 0] += near.sum(dim=0)
    each = torch.arange(cells)
    form[each, :, each] = own
    across = near[:, :, None] * there
    form[:, :, :, 0] -= across.mT
    form[:, 0] -= across.transpose(0, 1)
    flat = form.reshape(centres.shape[0] * (odorants + 1), -1)
    return flat / flat.diagonal().mean()


def _patches(
    place: PlaceCells, log_odours: Float[Tensor, "views odorants"]
) -> tuple[Float[Tensor, "views cells"], Float[Tensor, "views features"]]:
    """Give the share w_p of each place cell and the features w_p (1, o − c_p)."""
    share = place.share(log_odours)
    beside = nn.functional.pad(log_odours[:, None] - place.centres, (1, 0), value=1.0)
    return share, (share[:, :, None] * beside).flatten(1)
