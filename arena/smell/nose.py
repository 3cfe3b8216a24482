"""The nose, noisy and slowly fluctuating: what it makes of a concentration."""

import math
import typing
from collections.abc import Sequence
from typing import Annotated

import numpy as np
from jaxtyping import Float, Float32, Int
from pydantic import Field

from arena.errors import ArenaError
from arena.kernels import kernel
from arena.settings import Settings

Concentrations = Float[np.ndarray, "views odorants"]
Smells = Float32[np.ndarray, "views odorants"]
Times = Float[np.ndarray, " views"]


class Nose(Settings):
    r"""A nose whose gain jitters from view to view and, if told so, drifts.

    .. math:: s_t = c_t \exp(\sigma \xi_t + g_t), \qquad
        g_{t + \Delta} = e^{-\Delta / \tau} g_t + \phi \sqrt{1 - e^{-2 \Delta / \tau}} \, \eta_t

    with independent standard normal ξ and η for every odorant. The median of the smell is the concentration.

    Parameters
    ----------
    noise
        σ, the relative error of one sniff; 0.1 is about 10 %.
    fluctuation
        φ, the standard deviation of the slow log gain.
    correlation_time
        τ in s, over which the slow gain forgets itself.

    Raises
    ------
    ArenaError
        For negative, non-finite or enormous parameters.
    """

    noise: Annotated[float, Field(ge=0, le=10)] = 0.1
    fluctuation: Annotated[float, Field(ge=0, le=10)] = 0.0
    correlation_time: Annotated[float, Field(gt=0)] = 60.0

    def smell(self, concentrations: Concentrations, times: Times, rng: np.random.Generator) -> Smells:
        """Smell the concentrations (> 0) met at these times (s, never decreasing).

        Raises
        ------
        ArenaError
            For concentrations that are not positive and finite, or times that run backwards.
        """
        return self.sniffer(concentrations.shape[1], rng).smell(concentrations, times)

    def sniffer(self, odorants: int, rng: np.random.Generator) -> "Sniffer":
        """Begin to smell this many odorants, a few views at a time."""
        return Sniffer(self, odorants, rng)


class Sniffer:
    """A nose at work; `Nose.sniffer` makes one. It remembers how its gain has drifted and since when."""

    def __init__(self, nose: Nose, odorants: int, rng: np.random.Generator) -> None:
        self._constants = nose.noise, nose.fluctuation, nose.correlation_time
        self._rng = rng
        self._draws = 2 if nose.fluctuation else 1
        self._gain = np.zeros(odorants)
        # All is forgotten since then, so that the first gain comes from the stationary distribution.
        self._time = np.array([-np.inf])

    def smell(self, concentrations: Concentrations, times: Times) -> Smells:
        """Go on smelling; views smelt in several calls are the same, bit by bit, as in one.

        Raises
        ------
        ArenaError
            For concentrations that are not positive and finite, or times that run backwards.
        """
        normals = self._rng.standard_normal((len(times), self._draws, len(self._gain)))
        state = self._time, self._gain
        smelt: np.ndarray = _smell(concentrations, times, normals, self._constants, state)
        return smelt


class Sniffers:
    """Noses of one kind at work side by side, each with a generator of its own."""

    def __init__(self, nose: Nose, count: int, odorants: int) -> None:
        self._constants = nose.noise, nose.fluctuation, nose.correlation_time
        self._draws = 2 if nose.fluctuation else 1
        self._gain, self._time = np.zeros((count, odorants)), np.full(count, -np.inf)

    def begin(self, which: Int[np.ndarray, " noses"]) -> None:
        """Forget what these have smelt."""
        self._gain[which], self._time[which] = 0.0, -np.inf

    def smell(
        self,
        which: Int[np.ndarray, " noses"],
        concentrations: Float[np.ndarray, "noses odorants"],
        times: Float[np.ndarray, " noses"],
        rngs: Sequence[np.random.Generator],
    ) -> Float32[np.ndarray, "noses odorants"]:
        """Smell once with each of these, as its own `Sniffer` would, bit by bit; raises like it."""
        shape = self._draws, self._gain.shape[1]
        normals = np.array([rng.standard_normal(shape) for rng in rngs]).reshape(len(rngs), *shape)
        state = self._time, self._gain
        smelt: np.ndarray = _smell_all(which, concentrations, times, normals, self._constants, state)
        return smelt


@kernel()
@typing.no_type_check
def _smell(
    concentrations: np.ndarray,
    times: np.ndarray,
    normals: np.ndarray,
    constants: tuple[float, float, float],
    state: tuple[np.ndarray, np.ndarray],
) -> np.ndarray:
    noise, fluctuation, correlation_time = constants
    time, gain = state
    last = time[0]
    # All is checked before the gain drifts: what is refused leaves the nose as it was.
    for view in range(len(times)):
        for odorant in range(len(gain)):
            if not 0 < concentrations[view, odorant] < np.inf:
                raise ArenaError("a concentration is zero, negative, infinite or NaN; give positive numbers")
        if not times[view] >= last:
            raise ArenaError("the times of the views run backwards or are NaN; give them in order, in s")
        last = times[view]
    smelt = np.empty(concentrations.shape, np.float32)
    for view in range(len(times)):
        # Without fluctuation no second number was drawn: a draw more would change all that follow.
        if normals.shape[1] == 2:
            lapse = (times[view] - time[0]) / correlation_time
            # 1 - exp(-x) would lose its digits for views much closer than the correlation time.
            memory, innovation = math.exp(-lapse), math.sqrt(-math.expm1(-2 * lapse))
            for odorant in range(len(gain)):
                gain[odorant] = memory * gain[odorant] + fluctuation * innovation * normals[view, 1, odorant]
        time[0] = times[view]
        for odorant in range(len(gain)):
            log_gain = noise * normals[view, 0, odorant] + gain[odorant]
            scent = concentrations[view, odorant] * math.exp(log_gain)
            # The smallest normal and the largest number of float32: its logarithm exists.
            smelt[view, odorant] = min(max(scent, 1.1754943508222875e-38), 3.4028234663852886e38)
    return smelt


@kernel()
@typing.no_type_check
def _smell_all(
    which: np.ndarray,
    concentrations: np.ndarray,
    times: np.ndarray,
    normals: np.ndarray,
    constants: tuple[float, float, float],
    states: tuple[np.ndarray, np.ndarray],
) -> np.ndarray:
    smelt = np.empty(concentrations.shape, np.float32)
    for k in range(len(which)):
        one, its = slice(k, k + 1), which[k]
        state = states[0][its : its + 1], states[1][its]
        smelt[k] = _smell(concentrations[one], times[one], normals[one], constants, state)[0]
    return smelt
