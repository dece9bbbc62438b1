"""A part that is looked at again and again while a few elements of its layout change: what has not changed is not
worked out again, and every answer is that of `verify`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from fixture_design.contacts import Contact, Scale
from fixture_design.geometry import contacts_of_elements
from fixture_design.layout import Element, Group, GroupVerdict, Layout, Part, Verdict
from fixture_design.tolerances import Tolerances
from fixture_design.verification.found import FoundContacts
from fixture_design.verification.surface import CandidateWishes, PartSurface
from fixture_design.verification.verify import group_verdict, verify
from fixture_design.viewing.session.sliding import Ground

if TYPE_CHECKING:
    from fixture_design.geometry import SurfacePoints

#: Answers about groups that are kept: of the last few layouts, so that undoing is quick [-].
_KEPT = 64


class Workpiece(PartSurface):
    """The part of a session, in the pose it has, with all that is known about it.

    Layouts that are asked about have this part, and the same bodies, friction and ``surface_gap``.
    """

    def __init__(self, layout: Layout, part: Part) -> None:
        super().__init__(part, layout.surface_gap)
        self._elements: dict[Element, tuple[Contact, ...]] = {}  # by identity: they are values
        self._of_bodies: tuple[tuple[Contact, ...], tuple[str, ...]] | None = None
        self._groups: dict[tuple[object, ...], tuple[GroupVerdict, list[str], tuple[Contact, ...]]] = {}
        self._spots_found: dict[int, SurfacePoints] = {}

    @property
    def ground(self) -> Ground:
        """What elements slide over."""
        return Ground(self.geometry, self.part.pose, self.surface_gap)

    def found(self, layout: Layout) -> FoundContacts:
        """The contacts of a layout, as `contacts_of` finds them; possibly none.

        Raises:
            InputError: an element or a body cannot touch as it should.
        """
        new = tuple(element for element in layout.elements if element not in self._elements)
        known = {e: self._elements[e] for e in layout.elements if e in self._elements}
        for element in new:
            only = replace(layout, elements=(element,), bodies=())
            known[element] = contacts_of_elements(only, self.geometry).contacts
        self._elements = known
        if self._of_bodies is None:
            self._of_bodies = self._touching(layout)
        of_elements = [contact for element in layout.elements for contact in known[element]]
        bodies, notes = self._of_bodies
        return FoundContacts((*of_elements, *bodies, *layout.contacts), self.scale(), notes, self.geometry)

    def _touching(self, layout: Layout) -> tuple[tuple[Contact, ...], tuple[str, ...]]:
        found = contacts_of_elements(replace(layout, elements=()), self.geometry)
        return found.contacts, found.notes

    def contacts(self, layout: Layout) -> Sequence[Contact]:
        return self.found(layout).contacts

    def verify(self, layout: Layout) -> Verdict:
        """The verdict of a layout, which may have no contacts at all, without admissible sets."""
        return verify(layout, found=self.found(layout), sets=False, judge=self._judged)

    def _judged(
        self, group: Group, report: Scale, notes: list[str], tolerances: Tolerances, sets: bool
    ) -> GroupVerdict:
        """As `group_verdict`, which depends on nothing but a group's contacts."""
        key = (group.name, sets, *map(id, group.contacts))
        if key not in self._groups:
            if len(self._groups) >= _KEPT:
                del self._groups[next(iter(self._groups))]
            noted: list[str] = []
            verdict = group_verdict(group, report, noted, tolerances, sets)
            self._groups[key] = verdict, noted, group.contacts  # which keeps their identities taken
        verdict, noted, _ = self._groups[key]
        notes += noted
        return verdict

    def spots(self, rules: CandidateWishes, seed: int) -> SurfacePoints:
        if any(getattr(rules, name) not in (None, ()) for name in _WISHES):
            return super().spots(rules, seed)
        if seed not in self._spots_found:
            self._spots_found[seed] = super().spots(rules, seed)
        return self._spots_found[seed]


#: What may be wished of candidates; those without any are found once.
_WISHES = ("spacing", "edge_margin", "facets", "keep_out", "points", "grid")
