"""Names: unique where they are referred to, never a word that means something else, and known where they are used."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from difflib import get_close_matches

from fixture_design.contacts import ROLES
from fixture_design.io.places import KeyPath
from fixture_design.io.problems import Problem
from fixture_design.io.records import LayoutRecord
from fixture_design.layout import element_name

#: Groups that every layout has.
GROUPS = ("locators", "all")

_Named = list[tuple[KeyPath, str]]


def name_problems(layout: LayoutRecord) -> Iterator[Problem]:
    """Names given twice, reserved names, and references to nothing."""
    touching = [named for key in ("elements", "bodies", "contacts") for named in _names(layout, key)]
    loads, stages = _names(layout, "loads"), _names(layout, "stages")
    for names in (touching, _names(layout, "key_features"), loads, stages):
        yield from _repeated(names)
        yield from _unprintable(names)
    yield from _reserved(touching, ROLES, "a role, so that `active` could not tell it from one")
    yield from _reserved(stages, GROUPS, "a group that every layout has")
    known_loads = [name for _, name in loads]
    known_actives = [*ROLES, *(name for _, name in touching)]
    for index, stage in enumerate(layout.stages):
        path: KeyPath = ("stages", index)
        yield from _unknown(stage.loads, (*path, "loads"), "load", known_loads)
        yield from _unknown(stage.active, (*path, "active"), "role, element, body or contact", known_actives)


def _names(layout: LayoutRecord, key: str) -> _Named:
    return [((key, index, "name"), record.name) for index, record in enumerate(getattr(layout, key))]


def _repeated(names: _Named) -> Iterator[Problem]:
    first: dict[str, KeyPath] = {}
    for path, name in names:
        if name in first:
            yield Problem(path, f"the name {name!r} is given twice", expected="another name", also=first[name])
        first.setdefault(name, path)


def _unprintable(names: _Named) -> Iterator[Problem]:
    """Control characters would reach terminals with the report."""
    for path, name in names:
        if not name.isprintable():
            yield Problem(path, f"the name {name!r} has characters that do not print", expected="a printable name")


def _reserved(names: _Named, words: Iterable[str], meaning: str) -> Iterator[Problem]:
    for path, name in names:
        if name in words:
            yield Problem(path, f"the name {name!r} is that of {meaning}", expected="another name")


def _unknown(names: Iterable[str], path: KeyPath, kind: str, known: list[str]) -> Iterator[Problem]:
    for index, name in enumerate(names):
        if element_name(name) not in known:
            close = get_close_matches(name, known, n=1)
            hint = f" (did you mean {close[0]!r}?)" if close else ""
            there = ", ".join(known) or f"a {kind}, but the layout has none"
            yield Problem((*path, index), f"no {kind} is called {name!r}{hint}", expected=f"one of: {there}")
