"""Rooms: pieces of one atlas, a network each, and which of them a view is of."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import deepcopy
from math import exp
from typing import NamedTuple, cast

import torch
from jaxtyping import Bool, Float, Int
from torch import Tensor, nn

from neurons.dividing import divided
from neurons.errors import NeuronsError
from neurons.layers.charts import NearestCharts
from neurons.layers.readout import Recalled
from neurons.layers.sanger import Sanger
from neurons.merging import forked, merge
from neurons.network import Network

NOWHERE = -1
"""In place of a room, where a view is of none that is known."""
ASKED = 64
"""Views of a batch by which its room is told."""
Begin = Callable[..., Network]
"""Makes the network of a room that nothing is known of, on a code that others have learnt, if any."""


class Recognised(NamedTuple):
    """Of which rooms views are."""

    room: Int[Tensor, "views"]
    """By number, in the order in which they were learnt; −1 where it is none of them."""
    confidence: Float[Tensor, "views"]
    """From 0 to 1: how much less like the view every other room is."""
    nearest: Int[Tensor, "views"]
    """The room that is most like it, also where it is none of them."""
    strange: Bool[Tensor, "views"]
    """Whether it is less like that room than most views of it are."""


class Rooms(nn.Module):
    """One map of many rooms: the pieces into which its atlas falls, each a network.

    All see by one code. Where a room is new, the code grows by what its views have beside those known
    (`neurons.layers.sanger.Sanger.grown`), and a network on it begins: it learns charts, compass, cells and
    metric map of its own, while whatever was learnt stays as it is. Both populations are shared: cell i is
    the same cell everywhere, and has a field, or a preferred heading, in each room. Where rooms are learnt
    mixed, their charts part when they have tiled the views (`neurons.dividing`).

    A view z is of the room with the chart that is most like it: with E = |x − mean|² what a view differs from
    the mean by, the square of what separates it from a chart of a room whose code has n components is

        d_k² = |z_{1…n} − C_k|² + E − |z_{1…n}|²,        ν² = min_k d_k² / (m² + ℓ²),

    m² the usual misfit of views to their charts there and ℓ² what the code leaves of them. It is of none of
    them where the novelty ν is above a bound; with the smell, also where the misfit of that, over the usual
    one, is above another.

    Parameters
    ----------
    begin
        Makes the network of a new room.
    first
        That of a room which is known already, in place of a new one.
    novel, novel_smell
        From which novelty on a single view, or smell, is of no room that is known.
    strange, strange_smell
        Those that most views of a new room exceed, and few of a known one.
    majority
        Share of strange views from which on a room is new.
    window
        Views that the share is taken over.
    sharpness
        By how much the confidence in a room falls with the squared novelty of others.
    """

    def __init__(
        self,
        begin: Begin,
        *,
        first: Network | None = None,
        novel: float = 2.2,
        novel_smell: float = 4.0,
        strange: float = 1.65,
        strange_smell: float = 2.5,
        majority: float = 2 / 3,
        window: float = 64.0,
        sharpness: float = 4.0,
    ) -> None:
        super().__init__()
        self.novel, self.novel_smell, self.majority = novel, novel_smell, majority
        self.strange, self.strange_smell = strange, strange_smell
        self.window, self.sharpness = window, sharpness
        self._begin = begin
        self.networks = nn.ModuleList([begin(None) if first is None else first])
        self.present: Tensor = nn.Buffer(torch.zeros((), dtype=torch.int64))
        self.strangeness: Tensor = nn.Buffer(torch.zeros(()))

    def __len__(self) -> int:
        return len(self.networks)

    def __getitem__(self, room: int) -> Network:
        return cast("Network", self.networks[room])

    def __iter__(self) -> Iterator[Network]:
        return (self[room] for room in range(len(self)))

    @property
    def known(self) -> list[int]:
        """Rooms whose charts have tiled their views."""
        return [room for room in range(len(self)) if self[room].charted]

    @property
    def _asked(self) -> list[int]:
        """Rooms that are asked about a view: before any is known the first, which tells nothing yet."""
        return self.known or [0]

    @property
    def growing(self) -> int | None:
        """The room whose charts are still to tile its views; None where there is none."""
        return next((room for room in range(len(self)) if not self[room].charted), None)

    @property
    def code(self) -> Sanger:
        """The code as far as it has grown: that of each room is the first components of it."""
        return max((self[room].code for room in range(len(self))), key=len)

    def recognise(
        self,
        strips: Float[Tensor, "views features"],
        log_odours: Float[Tensor, "views odorants"] | None = None,
    ) -> Recognised:
        """Tell of which room each view is, by sight, or by sight and smell."""
        return self._compare([look.misfit for look in self._look(strips, log_odours)])

    def recall(
        self,
        strips: Float[Tensor, "views features"],
        log_odours: Float[Tensor, "views odorants"] | None = None,
    ) -> tuple[Recognised, list[tuple[int, Int[Tensor, "_"], Recalled]]]:
        """Tell of which room each view is, and what its charts recall: room, views and what is recalled."""
        looks = self._look(strips, log_odours)
        found = self._compare([look.misfit for look in looks])
        recalled = []
        for room, look in zip(self._asked, looks, strict=True):
            views = (found.nearest == room).nonzero()[:, 0]
            if len(views):
                network = self[room]
                excited = network.readout.activity(look.nearest).of(views)
                recalled.append((room, views, network.readout(network.charts, look.codes[views], excited)))
        return found, recalled

    def _look(
        self,
        strips: Float[Tensor, "views features"],
        log_odours: Float[Tensor, "views odorants"] | None,
    ) -> list["_Look"]:
        """Look at views with the charts of every room."""
        code = self.code
        codes = code(strips)
        energy = (strips - code.mean).square().sum(dim=1)
        told = code.orthonormal(codes).square().cumsum(dim=1)
        looks = []
        for room in self._asked:
            components = len(self[room].code)  # the first ones
            off = (energy - told[:, components - 1]).clamp(min=0)
            looks.append(_Look.by(self[room], codes[:, :components], off, log_odours))
        return looks

    def sniff(self, log_odours: Float[Tensor, "views odorants"]) -> Recognised:
        """Tell of which room smells are, in the dark."""
        asked = (self[room].charts for room in self._asked)
        apart = [
            torch.cdist(log_odours, charts.smells).amin(dim=1).square() / charts.misfits[1].clamp(min=1e-12)
            for charts in asked
        ]
        return self._compare([_Misfit(torch.zeros_like(smell), smell) for smell in apart])

    def _compare(self, misfits: list["_Misfit"]) -> Recognised:
        sight, smell = (torch.stack(part) for part in zip(*misfits, strict=True))
        both = sight + smell / self.strange_smell**2
        best = both.argmin(dim=0, keepdim=True)
        sight, smell = (misfit.gather(0, best)[0].sqrt() for misfit in (sight, smell))
        novel = (sight > self.novel) | (smell > self.novel_smell)
        rooms = torch.tensor(self._asked, device=best.device)[best[0]]
        return Recognised(
            room=torch.where(novel, NOWHERE, rooms),
            confidence=torch.softmax(-self.sharpness / 2 * both, dim=0).amax(dim=0),
            nearest=rooms,
            strange=(sight > self.strange) | (smell > self.strange_smell),
        )

    def learn(
        self,
        strips: Float[Tensor, "views features"],
        log_odours: Float[Tensor, "views odorants"],
        *,
        jump: bool = False,
    ) -> None:
        """Let the room that a batch of a walk is in learn from it; a new one begins where it is in none.

        Views that are of no known room are of the one that is still growing, if there is one. `jump` says
        that they do not follow those of the last call.
        """
        self.settle()
        room = self._enter(strips, log_odours, jump=jump)
        if jump or room != int(self.present):
            self[room].break_sequence()
        self.present.fill_(room)
        self[room].learn(strips, log_odours)

    def only(self, room: int) -> "Rooms":
        """Give one of the rooms as if there were no other; its network is the same, not a copy."""
        other = Rooms(self._begin, first=self[room])
        return other.to(self.present.device)

    @property
    def sizes(self) -> list[dict[str, int]]:
        """Sizes of the rooms' networks, by which `restore` makes them again."""
        return [
            {
                "epoch": network.epoch,
                "components": len(network.code),
                "charts": len(network.charts),
                "most_charts": network.most_charts,
                "tangents": network.charts.dimensions,
            }
            for network in self
        ]

    def restore(self, sizes: Sequence[Mapping[str, int]]) -> None:
        """Make rooms of these sizes, to be filled with what has been saved of them."""
        features = self[0].code.weight.shape[1]
        drawn = torch.Generator().manual_seed(0)
        self.networks = nn.ModuleList(
            [
                self._begin(
                    Sanger(features, size["components"], generator=drawn), **{**size, "components": 0}
                )
                for size in sizes
            ]
        ).to(self.present.device)

    def add(self) -> Network:
        """Begin a further room, and give its network."""
        network = self._begin(self.code)
        # one population: a heading cell that prefers a direction in one room prefers it in the next, too
        preferred = self[0].heading.preferred
        if preferred.isfinite().all():  # not where the first room has no compass
            network.heading.preferred.copy_(preferred)
        self.networks.append(network.to(self.present.device))
        return network

    def settle(self) -> None:
        """Part the charts that have just tiled their views by the pieces of their atlas."""
        room = self.growing
        if room is None:
            return
        self[room].advance_stage()
        if self[room].charted:
            self.networks[room], *others = (part.network for part in divided(self[room]))
            self.networks.extend(others)

    def are_new(
        self, strips: Float[Tensor, "views features"], log_odours: Float[Tensor, "views odorants"]
    ) -> bool:
        """Whether views, by themselves, are of no room that is known."""
        return bool(self.known) and self._strange(strips, log_odours)[0] >= self.majority

    def break_sequence(self) -> None:
        """Forget the last views everywhere: the next one does not follow them."""
        for network in self:
            network.break_sequence()

    def forked(self) -> "Rooms":
        """Copy the rooms, but for what they have summed up in their present stages (`neurons.merging`)."""
        other = deepcopy(self)
        other.networks = nn.ModuleList([forked(network) for network in self])
        return other

    def merge(self, other: "Rooms") -> None:
        """Add what others, grown from the same charts, have learnt in their present stages.

        Raises
        ------
        NeuronsError
            When they differ in anything but the sums of these stages.
        """
        if len(self) != len(other):
            raise NeuronsError(
                f"these maps know {len(self)} and {len(other)} rooms; merge them before either learns another"
            )
        for mine, its in zip(self, other, strict=True):
            merge(mine, its)

    def _strange(
        self, strips: Float[Tensor, "views features"], log_odours: Float[Tensor, "views odorants"]
    ) -> tuple[float, int]:
        """Tell the share of views that are of no known room, and the room that most are most like."""
        # some of a batch will do, and so telling takes little beside learning
        some = slice(None, None, max(1, len(strips) // ASKED))
        found = self.recognise(strips[some], log_odours[some])
        return float(found.strange.float().mean()), int(found.nearest.mode().values)

    def _enter(
        self,
        strips: Float[Tensor, "views features"],
        log_odours: Float[Tensor, "views odorants"],
        *,
        jump: bool,
    ) -> int:
        """Tell which room to learn in."""
        if not self.known:
            return 0
        strange, nearest = self._strange(strips, log_odours)
        kept = 0.0 if jump else exp(-len(strips) / self.window)
        self.strangeness.lerp_(self.strangeness.new_tensor(strange), 1 - kept)
        if float(self.strangeness) < self.majority:
            return nearest
        present = int(self.present)
        if not jump and self[present].stage.follows:
            self[present].stage.doubt(self[present])
            return present
        growing = self.growing
        if growing is None:
            self.add()
            growing = len(self) - 1
        return growing


class _Misfit(NamedTuple):
    """Squared misfits to the nearest chart of a room, over the usual ones there."""

    sight: Float[Tensor, "views"]
    smell: Float[Tensor, "views"]


class _Look(NamedTuple):
    """Views as a room's charts see them."""

    codes: Float[Tensor, "views components"]
    nearest: NearestCharts
    misfit: _Misfit

    @classmethod
    def by(
        cls,
        network: Network,
        codes: Float[Tensor, "views components"],
        off: Float[Tensor, "views"],
        log_odours: Float[Tensor, "views odorants"] | None,
    ) -> "_Look":
        """Look at codes that leave so much of their views, squared."""
        charts = network.charts
        nearest = charts.excite(codes, network.readout.winners, log_odours)
        first = nearest.chart[:, :1]
        sight = charts.residuals(codes, first)[:, 0].square().sum(dim=1) + off
        usual_sight, usual_smell = charts.misfits
        smell = torch.zeros_like(sight)
        if log_odours is not None:
            smell = (log_odours - charts.smells[first[:, 0]]).square().sum(dim=1)
        misfit = _Misfit(sight / (usual_sight + network.code.left), smell / usual_smell.clamp(min=1e-12))
        return cls(codes, nearest, misfit)
