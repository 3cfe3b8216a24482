"""The sense of smell: what a noisy, slowly fluctuating nose makes of a concentration."""

from typing import Annotated

import numpy as np
from jaxtyping import Float, Float32
from pydantic import Field

from arena.errors import ArenaError
from arena.settings import Settings

_FLOAT32 = np.finfo(np.float32)


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

    def smell(
        self,
        concentrations: Float[np.ndarray, "views odorants"],
        times: Float[np.ndarray, " views"],
        rng: np.random.Generator,
    ) -> Float32[np.ndarray, "views odorants"]:
        """Smell the concentrations (> 0) met at these times (s, never decreasing).

        Raises
        ------
        ArenaError
            For concentrations that are not positive and finite, or times that run backwards.
        """
        if not (np.isfinite(concentrations) & (concentrations > 0)).all():
            raise ArenaError("a concentration is zero, negative, infinite or NaN; give positive numbers")
        lapse = np.diff(times)
        if not (lapse >= 0).all():
            raise ArenaError("the times of the views run backwards or are NaN; give them in order, in s")
        log_gain = self.noise * rng.standard_normal(concentrations.shape)
        if self.fluctuation:
            log_gain += self._drift(lapse, rng.standard_normal(concentrations.shape))
        smelt: np.ndarray = np.clip(concentrations * np.exp(log_gain), _FLOAT32.tiny, _FLOAT32.max)
        return smelt.astype(np.float32)

    def _drift(
        self, lapse: Float[np.ndarray, " lapses"], shock: Float[np.ndarray, "views odorants"]
    ) -> Float[np.ndarray, "views odorants"]:
        """Ornstein-Uhlenbeck paths from stationary starts, exact at any spacing of times."""
        memory = np.exp(-lapse / self.correlation_time)
        innovation = np.sqrt(-np.expm1(-2 * lapse / self.correlation_time))
        gain = self.fluctuation * shock
        for view in range(1, len(gain)):
            gain[view] = memory[view - 1] * gain[view - 1] + innovation[view - 1] * gain[view]
        return gain
