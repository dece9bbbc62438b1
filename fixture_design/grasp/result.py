"""What the search for grasps found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from fixture_design.arrays import Point
from fixture_design.grasp.posture import Posture
from fixture_design.grasp.quality import Quality
from fixture_design.grasp.torques import Drives, Held
from fixture_design.grasp.weakest import Weakest
from fixture_design.layout import Answer, Layout, Verdict


@dataclass(frozen=True, eq=False)
class Grasp:
    """A hand on a part.

    Attributes:
        posture: where the hand is.  layout: its contacts, verified in ``verdict``.
        links: the link of each element or contact of the layout.
        features: what its fingertips touch; grasps of one family touch the same.
        center: the part's centre of mass in W [m].
        robust: share of pose errors at which it still closes; None where nobody asked.
        weakest: the direction in which a force through the centre of mass is held worst; None where nobody asked.
        held: the drives' torques for the load that was asked for; None without one, or where it is not held.
        tight: whether squeezing alone takes more of the friction than `tolerances.FRICTION_LEFT` leaves; such grasps
            are chosen last.
    """

    posture: Posture
    layout: Layout
    verdict: Verdict
    links: Mapping[str, str]
    features: tuple[str, ...]
    quality: Quality
    center: Point
    robust: float | None = None
    weakest: Weakest | None = None
    held: Held | None = None
    tight: bool = False
    notes: tuple[str, ...] = ()

    @property
    def closed(self) -> Answer:
        """Whether it is force closed."""
        return self.verdict.satisfied or Answer.UNDECIDED

    @property
    def doubt(self) -> str | None:
        """Why that is undecided, where it is and the verdict says so."""
        if self.closed is not Answer.UNDECIDED:
            return None
        # other findings of the verdict may be undecided without that anybody asked for them
        asked = [
            self.verdict.groups[one.group].findings[one.require]
            for one in self.verdict.requirements
            if one.answer is not Answer.YES
        ]
        return next((found.reason for found in asked if found.reason), None)

    def drives(self, friction: float = 1.0) -> Drives:
        """What the hand's drives do to the part, with a share ``friction`` of the contacts' friction [-]."""
        contacts = self.verdict.contacts
        if friction != 1:
            contacts = [replace(one, friction=friction * one.friction) for one in contacts]
        return Drives.of(self.posture, contacts, self.links, self.center)

    @property
    def others(self) -> tuple[str, ...]:
        """Links that count among what touches, though no fingertip is theirs."""
        of_tips = {tip.link for tip in self.posture.model.fingertips}
        return tuple(sorted(set(self.links.values()) - of_tips))


@dataclass(frozen=True, eq=False)
class FacingRegion:
    """Two features of the part that face each other, and whether the hand got there.

    Attributes:
        pairs: how many antipodal pairs of sampled points there are.  width: from and to [m].
        outcome: "closed", "undecided", or why not.
    """

    features: tuple[str, str]
    pairs: int
    width: tuple[float, float]
    outcome: str


@dataclass(frozen=True, eq=False)
class GraspResult:
    """The outcome of a search.

    Attributes:
        satisfied: yes: there is a grasp, proven closed (and it holds the load that was asked for); no: there can be
            none; undecided: none was found, or its verdict is.
        grasps: the best of each family, best first.
        regions: for hands that grasp with two fingertips, all antipodal regions.
        tried: how many sets of points were tried, and what became of them.
        reason: why there is none.
        notes: for people.
    """

    satisfied: Answer
    grasps: tuple[Grasp, ...]
    regions: tuple[FacingRegion, ...] = ()
    tried: Mapping[str, int] | None = None
    reason: str | None = None
    notes: tuple[str, ...] = ()
