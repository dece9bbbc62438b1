"""Looks at the items of a chunk that are alike together; what is left over is for `verify`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from fixture_design.batch.alike.pile import Kind, Pile, entries_of
from fixture_design.batch.alike.plan import paths_of, plan_of, row_of
from fixture_design.batch.alike.structure import Cut, Path, Structure, Structures, cut, numbers_of, structure_of
from fixture_design.batch.alike.text import as_json
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.reading import layout_of
from fixture_design.batch.records import Detail, Looked
from fixture_design.contacts import Contact
from fixture_design.errors import InputError
from fixture_design.layout import Layout

#: Fewer layouts of one structure than this are sooner looked at one by one.
_FEW = 2
#: Forms of layouts on parts that are kept.
_MOST_FOUND = 256


class Alike:
    """Remembers the structures it has met; one for each worker."""

    def __init__(self, detail: Detail) -> None:
        self._detail: Detail = detail
        self._structures = Structures()
        self._found: dict[object, Kind | None] = {}
        self._swept: tuple[tuple[str, bytes | None] | None, Kind | None] = (None, None)

    def entries(self, items: Sequence[Item]) -> list[tuple[int, Entry]]:
        """The entries of those items that can be looked at together, by their places."""
        if self._detail == "sets":
            return []
        found: list[tuple[int, Entry]] = []
        for kind, pile in self._piles(items).items():
            if len(pile.places) >= _FEW:
                found += entries_of(kind, pile, items)
        return found

    def entries_of_found(self, waiting: Mapping[int, Looked], items: Sequence[Item]) -> list[tuple[int, Entry]]:
        """The entries of layouts whose contacts geometry has found, by their places; `verify` looks at what is missing.

        Contacts that are exact or as good as that, and have neither clearance nor torsion, are as those of a text.
        """
        piles: dict[Kind, Pile] = {}
        for place, looked in waiting.items():
            kind = self._kind_of_found(looked)
            if kind is not None:
                _put(piles.setdefault(kind, Pile()), place, looked)
        return [entry for kind, pile in piles.items() for entry in entries_of(kind, pile, items)]

    def _kind_of_found(self, looked: Looked) -> Kind | None:
        item, layout, found, *_ = looked
        contacts = found.contacts
        plain = not any(c.provenance.normal_error or c.torsion or c.clearance or c.linked for c in contacts)
        if self._detail == "sets" or not plain or not (layout.elements or layout.bodies):
            return None
        swept = item.variant is not None and bool(layout.elements)
        key = (swept, layout.space, layout.stages, tuple(layout.require.items()), found.notes, *map(_form, contacts))
        if key not in self._found:
            if len(self._found) >= _MOST_FOUND:
                self._found.clear()
            given = Layout("", layout.space, contacts=contacts, stages=layout.stages, require=layout.require)
            kind = self._kind(given, paths_of(contacts))
            self._found[key] = kind and replace(kind, plan=replace(kind.plan, notes=found.notes), swept=swept)
        return self._found[key]

    def _piles(self, items: Sequence[Item]) -> dict[Kind, Pile]:
        piles: dict[Kind, Pile] = {}
        for place, item in enumerate(items):
            known = self._of_variant(item) if item.variant is not None else self._of_line(item)
            if known is None:
                continue
            kind, name, numbers = known
            pile = piles.setdefault(kind, Pile())
            pile.places.append(place)
            pile.names.append(name or item.default_name)
            pile.numbers.append(numbers)
        return piles

    def _of_line(self, item: Item) -> tuple[Kind, str, list[int | float]] | None:
        """Kind, name and numbers of a line; None if it is not to be looked at here."""
        if item.text is None or item.line is None or (pieces := cut(item.text)) is None:
            return None
        numbers = numbers_of(pieces)
        if numbers is None:
            return None
        known = self._structures.find(pieces)
        if known is None:
            structure, kind = self._new(item, pieces)
            if structure is None:
                return None
            self._structures.add(structure, kind, pieces)
            known = self._structures.find(pieces)
        return None if known is None or known[1] is None else (known[1], known[2], numbers)

    def _new(self, item: Item, pieces: Cut) -> tuple[Structure | None, Kind | None]:
        """The structure of an item that is a good layout, with what is to be done; none of one that is not."""
        try:
            layout = layout_of(item)
            structure = structure_of(pieces)
            return structure, None if structure is None else self._kind(layout, structure.paths)
        except InputError:  # looked at by itself it gives the record of its error
            return None, None

    def _of_variant(self, item: Item) -> tuple[Kind, str, list[int | float]] | None:
        """Likewise of a variant of a sweep; the last sweep's kind is kept."""
        try:
            layout = layout_of(item, placed=False)
            if (item.source, item.text) != self._swept[0]:
                kind = self._kind(replace(layout, units="m"), paths_of(layout.contacts))
                self._swept = (item.source, item.text), kind
        except InputError:
            return None
        kind = self._swept[1]
        return None if kind is None else (kind, layout.name, list(row_of(layout.contacts)))

    def _kind(self, layout: Layout, paths: Sequence[Path]) -> Kind | None:
        plan = plan_of(layout, paths)
        if plan is None or (self._detail == "full" and any(len(group.owners) > 1 for group in plan.plans)):
            return None
        return Kind(plan, self._detail)


def _put(pile: Pile, place: int, looked: Looked) -> None:
    """One more layout of this pile's kind."""
    layout, found = looked.layout, looked.found
    pile.places.append(place)
    pile.names.append(layout.name)
    pile.numbers.append(list(row_of(found.contacts)))
    pile.reports.append(found.report)
    pile.inputs.append(looked.input)
    pile.seconds.append(looked.seconds)
    named = enumerate(found.contacts)
    pile.words.append({f"feature {k}": as_json(c.feature) for k, c in named if c.feature is not None})
    values = {f"distance {k}": c.distance + 0.0 for k, c in enumerate(found.contacts) if c.distance is not None}
    pile.values.append(values | {"surface gap": layout.surface_gap})


def _form(contact: Contact) -> tuple[object, ...]:
    """Everything about a contact but its numbers and what it touches."""
    sizes = tuple(len(clause) for clause in contact.clauses)
    kind, slip = contact.provenance.kind, contact.provenance.slip_error
    return contact.name, contact.role, sizes, kind, slip, contact.distance is None, contact.feature is None
