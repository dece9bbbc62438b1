"""Looks at the items of a chunk that are alike together; what is left over is for `verify`."""

from __future__ import annotations

from collections.abc import Sequence

from fixture_design.batch.alike.pile import Kind, Pile, entries_of
from fixture_design.batch.alike.plan import plan_of
from fixture_design.batch.alike.structure import Structure, Structures, cut, numbers_of, structure_of
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.reading import layout_of
from fixture_design.batch.records import Detail
from fixture_design.errors import InputError

#: Fewer layouts of one structure than this are sooner looked at one by one.
_FEW = 2


class Alike:
    """Remembers the structures it has met; one for each worker."""

    def __init__(self, detail: Detail) -> None:
        self._detail: Detail = detail
        self._structures = Structures()

    def entries(self, items: Sequence[Item]) -> list[tuple[int, Entry]]:
        """The entries of those items that can be looked at together, by their places."""
        if self._detail == "sets":
            return []
        found: list[tuple[int, Entry]] = []
        for kind, pile in self._piles(items).items():
            if len(pile.places) >= _FEW:
                found += entries_of(kind, pile, items)
        return found

    def _piles(self, items: Sequence[Item]) -> dict[Kind, Pile]:
        piles: dict[Kind, Pile] = {}
        for place, item in enumerate(items):
            if item.text is None or item.line is None or item.variant is not None:
                continue
            pieces = cut(item.text)
            numbers = None if pieces is None else numbers_of(pieces)
            if pieces is None or numbers is None:
                continue
            known = self._structures.find(pieces)
            if known is None:
                structure, kind = self._new(item)
                if structure is None:
                    continue
                self._structures.add(structure, kind, pieces)
                known = self._structures.find(pieces)
            if known is None or known[1] is None:
                continue
            pile = piles.setdefault(known[1], Pile())
            pile.places.append(place)
            pile.names.append(known[2] or item.default_name)
            pile.numbers.append(numbers)
        return piles

    def _new(self, item: Item) -> tuple[Structure | None, Kind | None]:
        """The structure of an item that is a good layout, with what is to be done; none of one that is not."""
        pieces = cut(item.text or b"")
        try:
            layout = layout_of(item)
            structure = None if pieces is None else structure_of(pieces)
            plan = None if structure is None else plan_of(layout, structure)
        except InputError:  # looked at by itself it gives the record of its error
            return None, None
        if plan is None or (self._detail == "full" and any(len(group.owners) > 1 for group in plan.plans)):
            return structure, None
        return structure, Kind(plan, self._detail)
