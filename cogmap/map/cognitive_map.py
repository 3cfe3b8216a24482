"""The cognitive map: from views and odours to place cells and head-direction cells."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from copy import copy
from dataclasses import KW_ONLY, dataclass, fields, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

from cogmap.errors import CogmapError, UntrustedMapWarning
from cogmap.inputs import (
    AnyArray,
    Whole,
    check_choice,
    checked_count,
    checked_number,
    checked_views,
    log_odours,
)
from cogmap.map.activity import Activity
from cogmap.map.development import Development
from cogmap.map.device import checked_device
from cogmap.map.diagnosis import Counted, Diagnosis, Verdict, combined, topology_verdict
from cogmap.map.eyes import RETINAS, found_eye
from cogmap.map.perception import joined, recognised, seen, smelt
from cogmap.map.storage import read_state, write_state
from cogmap.threads import in_order, one_thread
from neurons.errors import NeuronsError
from neurons.layers.retina import Retina
from neurons.layers.sanger import Sanger
from neurons.network import Network
from neurons.renewal import RenewalStage
from neurons.rooms import Rooms
from neurons.stages import SIGHT_ALONE, SMELL_FIRST, STAGES

if TYPE_CHECKING:
    from cogmap.map.relaxed_places import RelaxedPlaces

BATCH = 256
"""Views learnt together; fixed, so that the same seed gives the same map."""
RELAXED = "relaxed_places."
"""How what `refine` has learnt is called among the weights of a saved map."""


@dataclass(eq=False, repr=False)
class CognitiveMap:
    """A map of a place, learnt from sight and smell alone.

    It is given images and concentrations and nothing else: no poses, no motor signals, no times. Afterwards
    sight alone tells the recalled smell (hence place) and the heading, through place cells and head-direction
    cells. Where views come in the order of a walk, it also learns where places lie, as a metric map, and
    takes a slow offset out of heading; shuffled views do no harm, but teach neither.

    The second sense may be any that knows place but not heading. Without one it is a map still: `encode`
    gives the space of the view manifold, to localise, plan and count holes in, and `dimension_` its degrees
    of freedom. But nothing then tells place from heading, so that both populations are silent, and `reason_`
    says so.

    Parameters
    ----------
    charts
        Local charts of the view manifold; about a fifth as many as views.
    components
        Principal components of the view code.
    most_charts
        How many charts it may come to when their number is doubled, again and again, until they agree; None
        adds none.
    place_cells, heading_cells
        Sizes of the two populations.
    smell
        How much smell counts beside sight where charts compete for views while they form, so that places
        that look alike get charts of their own; 0 lets sight alone compete. Sight alone perceives afterwards.
    smell_first
        Whether place cells learn from what is smelt before anything is seen; else later, from what sight
        recalls of it.
    time_constant
        Views in which what a room has taught is forgotten to 1/e once its map is grown, where rooms change
        for good (`neurons.renewal`); about as many as it has learnt from. What is new is then a change of
        the room unless it comes after a jump. None forgets nothing.
    eye
        "panorama" for views all around, or "perspective" for any with borders; told from the views themselves
        when None (`cogmap.features.seam`), and a warning where it is told and they speak against it.
    epoch
        Views per epoch when learning from a stream with `partial_fit`; `fit` sets it to the views it is
        given.
    seed
        Of the initial weights and the order of views; the same seed gives the same bits.
    device
        Where it learns and perceives, as PyTorch names devices; it must know double precision. The same seed
        gives the same bits on the same device, and on another one a map as good, of other last digits.
        Arrays come from and go to the processor's memory, and a saved map loads on any device.

    Attributes
    ----------
    trusted_
        Whether heading and place are to be trusted; `diagnosis` says more.
    reason_
        Why not, in words; empty when trusted.
    metric_reason_
        Why there is no metric map, in words; empty when there is one.
    relaxed_places_, refine_reason_
        What `refine` has learnt, or None and why there is none.
    seconds_
        Time spent per stage of development in this process, s.
    view_shape_, odorants_
        (height, width, 3) of the views and number of odorants it was fitted to, 0 for sight alone.
    eye_
        By which eye the views were taken, told or found.

    Raises
    ------
    CogmapError
        For views or odours of the wrong shape, type or range, counts below 1, or a device that is not there.
    """

    charts: Whole = 3000
    components: Whole = 60
    _: KW_ONLY
    most_charts: Whole | None = None
    place_cells: Whole = 150
    heading_cells: Whole = 60
    smell: float | Whole | np.floating = 0.5
    smell_first: bool | np.bool = False
    time_constant: float | Whole | np.floating | None = None
    eye: str | None = None
    epoch: Whole = 17_000
    seed: Whole = 0
    device: str = "cpu"

    def __repr__(self) -> str:
        told = ((field.name, getattr(self, field.name), field.default) for field in fields(self))
        unusual = (f"{name}={value!r}" for name, value, usual in told if value != usual)
        blank = f"CognitiveMap({', '.join(unusual)})"
        if not hasattr(self, "_rooms"):
            return blank
        height, width, _ = self.view_shape_
        verdict = self._rooms[0].unfinished or self.reason_
        return (
            f"<{blank} that has learnt from views of {height}×{width} pixels and {self.odorants_} odorants: "
            f"{verdict or 'trusted'}>"
        )

    def get_params(self, *, deep: bool = True) -> dict[str, Any]:
        """Give the parameters by name; `sklearn.base.clone` makes a map of them that has learnt nothing."""
        del deep  # none of them has parameters of its own
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def set_params(self, **params: Any) -> CognitiveMap:
        """Change parameters of a map that has learnt nothing yet.

        Raises
        ------
        CogmapError
            For a parameter that there is not, or a map that has learnt with others.
        """
        known = self.get_params()
        for name in params:
            check_choice("parameter", name, tuple(known))
        if params and hasattr(self, "_rooms"):
            raise CogmapError("this map has learnt with other parameters; change those of a blank one")
        for name, value in params.items():
            setattr(self, name, value)
        return self

    def fit(
        self, views: Any, odours: AnyArray | None = None, *, further: bool = False, progress: bool = False
    ) -> CognitiveMap:
        """Learn a map from scratch, as epochs of `partial_fit` over the views; or a further room.

        Their order is random in every epoch but those of stages that learn from it, as the metric map does.

        Parameters
        ----------
        views
            (views, height, width, 3) uint8; an array, a tensor, a list of images, or anything lazy whose
            slices are arrays.
        odours
            (views, odorants) concentrations > 0; None for sight alone.
        further
            Whether to keep what was learnt, and learn a further room beside it. Which views are of rooms that
            are known is found out: these are learnt there, as by `partial_fit`.
        progress
            Whether to show a bar on stderr.

        Raises
        ------
        CogmapError
            For fewer views than charts, none of them of a known room.
        """
        known = further and hasattr(self, "_rooms")
        views = checked_views(views, self.view_shape_ if known else None)
        logs = self._smelt(odours, views.shape[0], self.odorants_ if known else None)
        if not known:
            self._check_enough(views.shape[0])
            self._begin(tuple(views.shape[1:]), logs.shape[1], found_eye(self.eye, views))
        rooms, smells = self._rooms, self._here(logs)
        growing = Development(self.seconds_, batch=BATCH, seed=int(self.seed), progress=progress)
        with one_thread(self._device):
            with growing.timed("retina"):
                strips = smells.new_empty(views.shape[0], self._retina.features)
                for rows, strip in self._strips(views):
                    strips[rows] = strip
            if known:
                fresh = growing.of_known(rooms, strips, smells, least=int(self.charts))
                if not len(fresh):
                    return self
                self._check_enough(len(fresh))
                rooms.add()
                strips, smells = strips[fresh], smells[fresh]
            rooms.networks[-1], *others = growing.of(rooms[len(rooms) - 1], strips, smells)
            rooms.networks.extend(others)
        return self

    def partial_fit(self, views: Any, odours: AnyArray | None = None, *, jump: bool = False) -> CognitiveMap:
        """Learn from the next views of a stream.

        Time and memory per view do not depend on how many came before. See `neurons.network.Network` for what
        is learnt when.

        Parameters
        ----------
        views, odours
            As for `fit`, in the order of a walk if there is one. The first views tell the eye, and whether
            there are odours.
        jump
            Whether these views do not follow the last ones, as where another walk begins.
        """
        fresh = not hasattr(self, "_rooms")
        views = checked_views(views, None if fresh else self.view_shape_)
        logs = self._smelt(odours, views.shape[0], None if fresh else self.odorants_)
        if fresh:
            self._begin(tuple(views.shape[1:]), logs.shape[1], found_eye(self.eye, views))
        with one_thread(self._device):
            smells = self._here(logs)
            for rows, strip in self._strips(views):
                self._rooms.learn(strip, smells[rows], jump=jump)
                jump = False
        return self

    def fork(self) -> CognitiveMap:
        """Give another explorer a map of the same charts, which has learnt nothing yet in the present stage.

        So what it learns is not what this one has learnt already, and `merge` adds it. Stages whose work can
        be shared in this way are those that learn sums (`neurons.stages.Stage.sums`): olfaction, metric map
        and afferents.

        Raises
        ------
        CogmapError
            In a stage in which units compete for views, so that learning depends on their order.
        """
        rooms = self._learnt
        other: CognitiveMap = copy(self)
        other.seconds_ = {}
        with one_thread(self._device), _at_the_edge():
            other._rooms = rooms.forked()
        return other

    def merge(self, other: CognitiveMap) -> CognitiveMap:
        """Add what another map, grown from the same charts, has learnt in the present stage.

        Two maps that each learnt half of the views are then as one that learnt them all, but for rounding.
        The other is left as it is, and the next view follows the last one of this map.

        Raises
        ------
        CogmapError
            When the other differs in its charts, in what it learnt in earlier stages, in its stage or its
            sizes, or when the stage is one in which units compete.

        Examples
        --------
        Two explorers share the third stage and all that follows but the fourth:

        >>> cmap = CognitiveMap(epoch=3000)
        >>> cmap.partial_fit(views, odours)  # 10 epochs: code and charts
        >>> away = cmap.fork()  # or many; `save` and `load` take them to other machines
        >>> cmap.partial_fit(views_here, odours_here, jump=True)
        >>> away.partial_fit(views_there, odours_there, jump=True)
        >>> cmap.merge(away)  # as if it had seen both
        """
        with one_thread(self._device), _at_the_edge():
            self._learnt.merge(other._learnt)
        return self

    def perceive(self, views: Any = None, *, odours: AnyArray | None = None) -> Activity:
        """Let the map look at views, smell odours in the dark, which tells place only, or both at once.

        With both, smell picks among the charts that look alike; what they recall is told from sight as ever.

        Raises
        ------
        CogmapError
            When the map is not grown yet, when given neither, or more of one than of the other.
        """
        rooms = self._learnt
        if views is None:
            if odours is None:
                raise CogmapError("give views, odours for a look in the dark, or both")
            self._check_nose()
            with one_thread(self._device):
                return smelt(rooms, self._here(log_odours(odours, odorants=self.odorants_)))
        views = checked_views(views, self.view_shape_)
        logs = None
        if odours is not None:
            self._check_nose()
            logs = self._here(log_odours(odours, views=views.shape[0], odorants=self.odorants_))
        with one_thread(self._device):
            if not self.trusted_:
                warnings.warn(
                    f"this map is not to be trusted: {self.reason_}", UntrustedMapWarning, stacklevel=2
                )
            plain = joined(
                [
                    seen(rooms, strip, None if logs is None else logs[rows])
                    if self.odorants_
                    else recognised(rooms, strip)
                    for rows, strip in self._strips(views)
                ]
            )
        if self.relaxed_places_ is None:
            return plain
        there = self.relaxed_places_.locate(views, plain.position)
        finer = {name: part.astype(np.float32) for name, part in there._asdict().items()}
        return replace(plain, **finer, plain=plain)

    def refine(self, views: Any) -> CognitiveMap:
        """Relax places and headings of panoramas, so that what is perceived is fine enough to act on.

        Best the views that were learnt, in the order of the walk. From then on `perceive` gives positions and
        phases by `cogmap.map.relaxed_places.RelaxedPlaces`, and beside them those of the charts alone
        (`Activity.plain`). The map remembers 2.7 KB of each view. Where it cannot be done, `refine_reason_`
        and a warning say why, and all stays as it was.

        Parameters
        ----------
        views
            (views, height, width, 3) uint8, more than 60.
        """
        # who only learns waits for nothing that plans need
        from cogmap.map.relaxed_places import RelaxedPlaces  # noqa: PLC0415

        self.relaxed_places_: RelaxedPlaces | None = None
        reason = self.reason_ or self.metric_reason_
        if not reason:
            known = self.perceive(views)
            with one_thread():
                try:
                    self.relaxed_places_ = RelaxedPlaces.learn(views, known.position, known.phase)
                except CogmapError as error:
                    reason = str(error)
        self.refine_reason_ = reason
        if reason:
            warnings.warn(f"this map's places are not relaxed: {reason}", UntrustedMapWarning, stacklevel=2)
        return self

    def encode(self, views: Any) -> Float[np.ndarray, "views components"]:
        """Give the principal components of views, the space of the view manifold, float32."""
        code = self._learnt.code
        views = checked_views(views, self.view_shape_)
        with one_thread(self._device):
            return torch.cat([code(strip) for _, strip in self._strips(views)]).cpu().numpy()

    def diagnosis(self, homology: Mapping[str, Counted] | None = None) -> Diagnosis:
        """Say of heading, place, metric map and topology whether each is to be trusted, and why not.

        Parameters
        ----------
        homology
            Betti numbers that topology is judged by, as of `cogmap.evaluation.homologies`; without, those of
            the charts are measured, as seen and as seen and smelt, which takes some seconds.
        """
        if self.rooms_ > 1:
            return combined({room: self.room(room).diagnosis() for room in range(self.rooms_)})
        network = self._grown
        topology = Verdict(network.unfinished or self._sees_alone)
        if topology.trusted:
            if homology is None:
                # what counts holes is as heavy as all that a map needs otherwise
                from cogmap.map.topology import homology_of_charts  # noqa: PLC0415

                homology = homology_of_charts(network.charts)
            topology = topology_verdict(homology, turned=math.isfinite(self.phase_eigenvalue_))
        return Diagnosis(
            heading=Verdict(network.heading_diagnosis()),
            place=Verdict(network.place_diagnosis()),
            metric_map=Verdict(network.position_diagnosis()),
            topology=topology,
        )

    @property
    def trusted_(self) -> bool:
        """Whether heading and place are to be trusted (`diagnosis`)."""
        return not self.reason_

    @property
    def reason_(self) -> str:
        """Why this map is not trusted; empty when it is."""
        return self._of_rooms(lambda network: network.heading_diagnosis() or network.place_diagnosis())

    @property
    def metric_reason_(self) -> str:
        """Why this map tells no positions, whatever it tells of heading; empty when it does."""
        return self._of_rooms(lambda network: network.metric_diagnosis())

    @property
    def phase_eigenvalue_(self) -> float:
        """How well the charts agree on phase, 1 at best; NaN before they have tried."""
        return float(self._grown.agreement[1])

    @property
    def dimension_(self) -> int:
        """Degrees of freedom, of which most charts see so many; 0 before they have learnt."""
        return self._grown.dimension[0]

    @property
    def vote_(self) -> float:
        """Share of the charts that tell so many degrees of freedom; NaN before they have learnt."""
        return self._grown.dimension[1]

    @property
    def spectrum_(self) -> Float[np.ndarray, "directions"]:
        """Shares of what a chart sees along its tangents, before those are cut to `dimension_`; medians."""
        return self._grown.spectrum.cpu().numpy()

    @property
    def rooms_(self) -> int:
        """How many rooms it knows, the one that it is learning included."""
        return len(self._learnt)

    def room(self, room: Whole) -> CognitiveMap:
        """Give the map of one of its rooms, numbered as in `Activity.room`; what it learns both have learnt.

        Raises
        ------
        CogmapError
            When there is no such room.
        """
        rooms = self._learnt
        if not 0 <= room < len(rooms):
            raise CogmapError(f"room is {room}; this map knows {len(rooms)}, give 0 to {len(rooms) - 1}")
        other: CognitiveMap = copy(self)
        other._rooms = rooms.only(int(room))
        return other

    def state_dict(self) -> dict[str, Tensor]:
        """Give all that it has learnt, by the names it is saved under; as in PyTorch, not a copy.

        Those of the first room are named as in a map of one, those of others begin with `room_1.` and so on.
        """
        state, *others = (network.state_dict() for network in self._learnt)
        for room, learnt in enumerate(others, start=1):
            state |= {f"room_{room}.{name}": weight for name, weight in learnt.items()}
        return {**state, "present": self._rooms.present, "strangeness": self._rooms.strangeness}

    def save(self, path: str | Path) -> None:
        """Write the map to a new folder: `weights.safetensors` and `map.json`.

        Raises
        ------
        CogmapError
            When something is at the path already, or it cannot be written.
        """
        learnt = {
            "view_shape": self.view_shape_,
            "odorants": self.odorants_,
            "eye": self.eye_,
            "rooms": self._learnt.sizes,
        }
        settings = self.get_params()
        del settings["device"]
        weights = self.state_dict()
        if self.relaxed_places_ is not None:
            state = self.relaxed_places_.state()
            weights |= {RELAXED + name: torch.from_numpy(array) for name, array in state.items()}
        write_state(path, weights, settings, learnt)

    @classmethod
    def load(cls, path: str | Path, *, device: str = "cpu") -> CognitiveMap:
        """Read a map that `save` wrote; on the device it was learnt on it perceives the same bits.

        Raises
        ------
        CogmapError
            When it is missing, damaged or of another version, or the device is not there.
        """
        weights, settings, learnt = read_state(path)
        try:
            loaded = cls(**settings, device=device)
            loaded._begin(tuple(learnt["view_shape"]), learnt["odorants"], learnt["eye"])
            loaded._rooms.restore(learnt["rooms"])
            state = loaded.state_dict()
            relaxed = {
                name.removeprefix(RELAXED): weights.pop(name).numpy()
                for name in list(weights)
                if name.startswith(RELAXED)
            }
            for name in state.keys() | weights.keys():
                # as many numbers, or it is refused
                state[name].copy_(weights[name].reshape(state[name].shape))
            if relaxed:
                from cogmap.map.relaxed_places import RelaxedPlaces  # noqa: PLC0415

                loaded.relaxed_places_, loaded.refine_reason_ = RelaxedPlaces.from_state(relaxed), ""
        except (KeyError, TypeError, RuntimeError) as error:
            raise CogmapError(f"{path} does not hold a whole map: {error}") from None
        return loaded

    def _begin(self, view_shape: tuple[int, ...], odorants: int, eye: str) -> None:
        self._device = checked_device(self.device)
        self._retina = Retina(*view_shape[:2], **RETINAS[eye]).to(self._device)
        self.view_shape_, self.odorants_, self.eye_ = view_shape, odorants, eye
        self.seconds_: dict[str, float] = {}
        self.relaxed_places_ = None
        self.refine_reason_ = "it was shown no views to relax places by; call refine"
        charts = checked_count("charts", self.charts)
        most = self.most_charts
        if not isinstance(self.smell_first, bool | np.bool):
            raise CogmapError(f"smell_first is {self.smell_first!r}; give True or False")
        stages = SMELL_FIRST if self.smell_first else STAGES
        if self.time_constant is not None:
            lasting = checked_number("time_constant", self.time_constant, 1.0)
            stages = *stages, RenewalStage(time_constant=lasting)
        begin = partial(
            _begun,
            self._retina.features,
            odorants,
            charts=charts,
            most_charts=charts if most is None else checked_count("most_charts", most, charts),
            components=checked_count("components", self.components, 4),
            place_cells=checked_count("place_cells", self.place_cells),
            heading_cells=checked_count("heading_cells", self.heading_cells),
            smell=checked_number("smell", self.smell),
            epoch=checked_count("epoch", self.epoch),
            stages=stages if odorants else SIGHT_ALONE,
            seed=checked_count("seed", self.seed, 0),
        )
        with one_thread():
            self._rooms = Rooms(begin).to(self._device)

    def _check_enough(self, views: int) -> None:
        if views < checked_count("charts", self.charts):
            raise CogmapError(
                f"there are {views} views for {self.charts} charts; "
                "record more views or use fewer charts: about a fifth as many as views"
            )

    @staticmethod
    def _smelt(
        odours: AnyArray | None, views: int, odorants: int | None
    ) -> Float[np.ndarray, "views odorants"]:
        """Give log odours to learn from; of no odorants where there are none."""
        if odours is None and not odorants:
            return np.empty((views, 0), np.float32)
        if odorants == 0:
            raise CogmapError(
                f"this map was begun by sight alone, and gets odours of shape {np.asarray(odours).shape}; "
                "give none, or begin another map with both"
            )
        return log_odours(odours, views=views, odorants=odorants)

    def _of_rooms(self, diagnosis: Callable[[Network], str]) -> str:
        """Say what a diagnosis has against rooms; of several by number, without the one still growing."""
        rooms = self._learnt
        if len(rooms) == 1:
            return diagnosis(rooms[0])
        told = {room: diagnosis(rooms[room]) for room in rooms.known}
        return "; ".join(f"room {room}: {reason}" for room, reason in told.items() if reason)

    def _check_nose(self) -> None:
        if not self.odorants_:
            raise CogmapError(f"this map knows no odours: {self._grown.noseless}")

    @property
    def _sees_alone(self) -> str:
        """Why holes that sight alone counts are not those of the room for sure; empty with a second sense."""
        if self.odorants_:
            return ""
        return (
            "by sight alone places that look alike are one, and no count of its loops can tell; give a "
            "second sense, or count those of `encode` where nothing looks alike"
        )

    @property
    def _learnt(self) -> Rooms:
        """The rooms, or a refusal where nothing is learnt yet."""
        if not hasattr(self, "_rooms"):
            raise CogmapError("this map has learnt nothing yet; call fit or partial_fit first")
        return self._rooms

    @property
    def _grown(self) -> Network:
        """The network of the first room, or a refusal."""
        return self._learnt[0]

    def _here(self, array: np.ndarray) -> Tensor:
        """Take an array to where the map learns."""
        return torch.from_numpy(array).to(self._device)

    def _strips(self, views: Any) -> Iterator[tuple[slice, Float[Tensor, "views features"]]]:
        """Pass views through the retina in fixed batches, ahead of who takes the strips."""

        def batches() -> Iterator[tuple[slice, Tensor]]:
            for first in range(0, views.shape[0], BATCH):
                rows = slice(first, first + BATCH)
                yield rows, torch.from_numpy(np.ascontiguousarray(views[rows]))

        # read by one thread alone: whatever lazy views are made of need not bear several
        return in_order(lambda batch: (batch[0], self._retina(batch[1].to(self._device))), batches())


def _begun(features: int, odorants: int, code: Sanger | None = None, *, seed: int, **sizes: Any) -> Network:
    """Begin the network of a room, on a code that others have learnt, if any."""
    # even the initial weights, orthonormal by QR, depend on the number of threads; and they are drawn on the
    # processor: the same on every device
    with one_thread():
        generator = torch.Generator().manual_seed(seed)
        grown = None if code is None else code.grown(sizes["components"], generator=generator)
        return Network(features, odorants, code=grown, generator=generator, **sizes)


@contextmanager
def _at_the_edge() -> Iterator[None]:
    """Refuse in the same words what the layers refuse."""
    try:
        yield
    except NeuronsError as error:
        raise CogmapError(str(error)) from None
