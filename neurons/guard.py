"""The guard of a map: which of its answers can be trusted, and in words why the others cannot."""

import math
from dataclasses import dataclass
from typing import NamedTuple


class Agreement(NamedTuple):
    """How well agrees what a map has learnt; NaN where it has not been tried."""

    signs: float
    """Of the heading axes on a direction of turning (`neurons.atlas.synchronisation.Compass`)."""
    phases: float
    """Eigenvalue of the synchronisation of headings."""
    connected: bool
    """Whether the phases agree only by what walking turns (`neurons.atlas.connection`)."""
    foretold: float
    """Share of one half of the walk that the metric map of the other foretells, the lesser of both."""
    ambiguous: float
    """Share of the charts most alike in smell and heading that are far apart (`neurons.atlas.ambiguity`)."""
    aliased: float
    """The same of the charts most alike to sight."""
    views_per_chart: float
    """Of an epoch."""
    dimension: int
    """What most charts say that the views of a neighbourhood spread in."""
    vote: float
    """Share of the charts that say so."""
    felt: float
    """How much charts agree that smell changes along the heading axes (`neurons.atlas.heading_axis`)."""


@dataclass(frozen=True)
class Guard:
    """Bounds of what is trusted, found on maps of rooms that were scored with true poses.

    Agreement of charts alone is no proof: a room that is the same when turned by half gives a map of half
    of it in which all charts agree. Its smells and headings then fit two places, and walking contradicts it.

    Attributes
    ----------
    least_eigenvalue
        Least agreement of the phases in an atlas to be trusted; at .998 headings have been seen 12° off.
    least_sign_agreement
        Least agreement of the heading axes on a direction of turning: one overlap in 400 may be reversed.
    confirmed_eigenvalue, confirmed_sign_agreement
        What will do where walking confirms the headings: 2 to 5° off from .998 up; at .994, 90° at one view
        in twenty.
    confirming_r2, least_r2
        Share that a half of the walk foretells of the other and that confirms, .9 to .98 in maps that are
        right; and without which headings are not taken to be right, as they have been seen 12° off below,
        unless the smell is to blame. Below 0 it contradicts them: −.3 to −3 in maps of half a room.
    most_ambiguous_heading, most_ambiguous_place
        Largest share of charts that fit elsewhere too: .35 to .49 in maps of half a room, .05 to .19 where
        odours come from one line and headings are right but places are not, at most .01 in maps that are
        right in both.
    most_aliased
        Largest share of charts that look like others far away: .03 to .35 in maps of which one view in twenty
        or more is told 90° off or from the other end of the room, at most .004 in maps that are right.
    most_felt
        Largest share of the change of smell along heading axes that neighbouring charts agree on: .10 to .21
        where smell leaves turning alone; .44 to .83 with a nose that smells heading, too, where what is taken
        for turning is whatever changes smell least.
    least_vote
        Share of the charts that must tell one dimension: .54 to .94 in maps of 17,000 views, .44 and more in
        those of 3,000 that were right; below .4, in maps too coarse, the next dimension has as many votes.
    most_views_per_chart
        With more, a map that takes poses for others is advised to use more charts before anything is changed
        in the room: as coarse a tiling joins places that do not look alike.
    """

    least_eigenvalue: float = 0.999
    least_sign_agreement: float = 0.995
    confirmed_eigenvalue: float = 0.9975
    confirmed_sign_agreement: float = 0.97
    confirming_r2: float = 0.9
    least_r2: float = 0.8
    most_ambiguous_heading: float = 0.25
    most_ambiguous_place: float = 0.025
    most_aliased: float = 0.012
    most_felt: float = 1 / 3
    least_vote: float = 0.4
    most_views_per_chart: float = 12.0

    def atlas(self, signs: float, phases: float) -> str:
        """Say in what the charts do not agree, or nothing when they do."""
        if not math.isfinite(phases):
            return "no loop of its charts closes after a turn; use more charts, more views or a landmark more"
        if phases < self.least_eigenvalue:
            return (
                f"the phases of its charts agree only to {phases:.4f}, below {self.least_eigenvalue}: the "
                "atlas is too coarse, or places look alike; use more charts, or a landmark more"
            )
        if signs < self.least_sign_agreement:
            return f"its heading axes agree only to {signs:.3f}; use more charts or more odour sources"
        return ""

    def poses(self, told: Agreement) -> str:
        """Say that poses have been taken for others, or nothing when none seem to have been."""
        if told.foretold < 0:
            return (
                "what follows a view lies anywhere but ahead of it: poses that look and smell alike are one "
                f"to it; {self._mend(told, 'set a landmark or an odour where they differ')}"
            )
        if told.ambiguous > self.most_ambiguous_heading:
            return (
                f"{told.ambiguous:.0%} of its charts smell and head like others far away: poses that look "
                "and smell alike are one to it; "
                f"{self._mend(told, 'set a landmark or an odour where they differ')}"
            )
        if told.aliased > self.most_aliased:
            return (
                f"{told.aliased:.1%} of its charts look like others far away, which sight alone does not "
                "tell apart; "
                f"{self._mend(told, 'set a landmark where they differ, or perceive with odours too')}"
            )
        return ""

    def directions(self, told: Agreement) -> str:
        """Say why the charts do not tell turning from walking, or nothing when they do."""
        if told.felt > self.most_felt:
            return (
                f"its charts agree on {told.felt:.0%} of how smell changes along their heading axes, more "
                f"than {self.most_felt:.0%}: of {told.dimension} directions smell should leave one alone, "
                "that of turning; give signals that know place but not heading"
            )
        if told.vote < self.least_vote:
            return (
                f"only {told.vote:.0%} of its charts tell {told.dimension} degrees of freedom, less than "
                f"{self.least_vote:.0%}: the atlas is too coarse to say how many there are; use more charts "
                "and more views"
            )
        return ""

    def heading(self, told: Agreement) -> str:
        """Say why headings are not to be trusted, or nothing when they are."""
        return self.poses(told) or self._unconfirmed(told) or self.directions(told)

    def _unconfirmed(self, told: Agreement) -> str:
        # where a smell means several places displacements are not foretold, whatever the headings are
        if told.foretold < self.least_r2 and told.ambiguous <= self.most_ambiguous_place:
            return (
                f"walking does not confirm its headings: one half of the walk foretells {told.foretold:.2f} "
                f"of the other, less than {self.least_r2}; show it longer walks, or more odour sources"
            )
        doubt = self.atlas(told.signs, told.phases)
        confirmed = told.foretold >= self.confirming_r2
        nearly = told.phases >= self.confirmed_eigenvalue and told.signs >= self.confirmed_sign_agreement
        if doubt and nearly and confirmed:
            return ""
        if not doubt and told.connected and not confirmed:
            return (
                "its charts agree only by a connection that was learnt, which walking does not confirm: one "
                f"half of the walk foretells {told.foretold:.2f} of the other, less than "
                f"{self.confirming_r2}; show it longer walks, in order, or a landmark more"
            )
        return doubt

    def place(self, told: Agreement) -> str:
        """Say why places are not to be trusted, or nothing when they are."""
        if reason := self.heading(told):
            return f"without headings nothing tells whether a smell means one place: {reason}"
        if told.ambiguous > self.most_ambiguous_place:
            return (
                f"{told.ambiguous:.0%} of its charts smell and head like others far away: a smell means "
                "several places; use more odour sources, not all on one line"
            )
        return ""

    def _mend(self, told: Agreement, otherwise: str) -> str:
        return "use more charts" if told.views_per_chart > self.most_views_per_chart else otherwise
