"""YAML text into plain values, with the place of each: strict, and safe with files of any origin.

libyaml splits the text into events; the values are built here, since its Python binding resolves words as YAML 1.1
does, lets the last of two equal keys win and forgets where things were. An alias shares its anchor's value, so that
ten lines of nested aliases ("a billion laughs") take ten lines' memory, and are refused by their size when written out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import yaml

from fixture_design.errors import FileFormatError, InputError
from fixture_design.io.places import DEEPEST, Key, Place
from fixture_design.io.scalars import Scalar, resolve, resolve_tagged
from fixture_design.io.yaml_errors import syntax_error

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

#: Most values that a file with aliases may have once they are written out.
MOST_EXPANDED = 1_000_000


@dataclass(frozen=True)
class _Built:
    """A value, its place, and how many values it has when its aliases are written out."""

    value: object
    place: Place
    size: int


def parse_yaml(text: str, source: str | None = None) -> tuple[object, Place]:
    """The single document in ``text``; (None, Place()) if there is nothing but comments.

    Raises:
        FileFormatError: does not parse, several documents, a key that is repeated or no text, merge keys, unknown
            tags, aliases that are undefined, recursive or too large when written out, nesting beyond any use.
    """
    try:
        return _Builder(text).document()
    except InputError as error:
        error.source = source
        raise
    except yaml.YAMLError as cause:
        raise syntax_error(cause, text, source) from cause


class _Builder:
    """Builds the document from events, depth first."""

    def __init__(self, text: str) -> None:
        self._events: Iterator[yaml.Event] = yaml.parse(text, Loader=_LOADER)
        #: None while the anchor's own value is being built
        self._anchors: dict[str, _Built | None] = {}
        self._has_aliases = False

    def document(self) -> tuple[object, Place]:
        next(self._events)
        if isinstance(next(self._events), yaml.StreamEndEvent):
            return None, Place()
        built = self._node(next(self._events), 0)
        next(self._events)
        after = next(self._events)
        if not isinstance(after, yaml.StreamEndEvent):
            raise _error(after, "a second document starts here ('---')", expected="one document in a file")
        return built.value, built.place

    def _node(self, event: yaml.Event, depth: int) -> _Built:
        if depth > DEEPEST:
            raise _error(event, f"lists and mappings are nested more than {DEEPEST} deep")
        if isinstance(event, yaml.AliasEvent):
            return self._alias(event)
        anchor = getattr(event, "anchor", None)
        if anchor:
            self._anchors[anchor] = None
        if isinstance(event, yaml.ScalarEvent):
            built = _Built(_scalar(event), _place(event), 1)
        elif isinstance(event, yaml.SequenceStartEvent):
            built = self._sequence(event, depth)
        elif isinstance(event, yaml.MappingStartEvent):
            built = self._mapping(event, depth)
        else:
            raise AssertionError(f"a value cannot start with {event!r}")
        if self._has_aliases and built.size > MOST_EXPANDED:
            raise _error(event, f"with its aliases written out this has more than {MOST_EXPANDED} values")
        if anchor:
            self._anchors[anchor] = built
        return built

    def _alias(self, event: yaml.AliasEvent) -> _Built:
        self._has_aliases = True
        if event.anchor not in self._anchors:
            raise _error(event, f"the alias *{event.anchor} has no anchor &{event.anchor} before it")
        built = self._anchors[event.anchor]
        if built is None:
            raise _error(event, f"the alias *{event.anchor} contains itself")
        return built

    def _sequence(self, start: yaml.SequenceStartEvent, depth: int) -> _Built:
        _require_tag(start, "seq")
        items: list[_Built] = []
        places: dict[Key, Place] = {}
        while not isinstance(event := next(self._events), yaml.SequenceEndEvent):
            item = self._node(event, depth + 1)
            places[len(items)] = _place(event, item.place)
            items.append(item)
        size = 1 + sum(item.size for item in items)
        return _Built([item.value for item in items], _with_inside(start, places), size)

    def _mapping(self, start: yaml.MappingStartEvent, depth: int) -> _Built:
        _require_tag(start, "map")
        values: dict[str, object] = {}
        places: dict[Key, Place] = {}
        size = 1
        while not isinstance(event := next(self._events), yaml.MappingEndEvent):
            key = self._key(event)
            if key in values:
                lines = f"lines {places[key].line} and {event.start_mark.line + 1}"
                raise _error(event, f"the key {key!r} is given twice, in {lines}", expected="each key once")
            item = self._node(next(self._events), depth + 1)
            values[key], places[key] = item.value, _place(event, item.place)
            size += item.size
        return _Built(values, _with_inside(start, places), size)

    def _key(self, event: yaml.Event) -> str:
        if isinstance(event, yaml.ScalarEvent):
            if event.value == "<<" and event.implicit[0]:
                raise _error(event, "merge keys ('<<') are not part of YAML 1.2", expected="the keys written out")
            key = _scalar(event)
            if isinstance(key, str):
                return key
            raise _error(event, f"a key must be text, not {event.value!r}", expected=f"quotes: '{event.value}'")
        raise _error(event, "a key must be text, not a list, mapping or alias")


def _scalar(event: yaml.ScalarEvent) -> Scalar:
    try:
        if event.tag:
            return resolve_tagged(event.tag, event.value)
        return resolve(event.value) if event.implicit[0] else event.value
    except InputError as error:
        raise _error(event, error.problem, found=error.found, expected=error.expected) from error


def _require_tag(event: yaml.CollectionStartEvent, kind: str) -> None:
    if event.tag not in (None, "!", f"tag:yaml.org,2002:{kind}"):
        raise _error(event, f"unknown tag {event.tag!r}", expected="no tag")


def _place(event: yaml.Event, of: Place | None = None) -> Place:
    """Where an event starts, with what is inside the value ``of``, which may be elsewhere (an alias)."""
    return Place(event.start_mark.line + 1, event.start_mark.column + 1, of.inside if of else {})


def _with_inside(event: yaml.Event, inside: dict[Key, Place]) -> Place:
    return Place(event.start_mark.line + 1, event.start_mark.column + 1, inside)


def _error(event: yaml.Event, problem: str, **details: str | None) -> FileFormatError:
    mark = event.start_mark
    return FileFormatError(problem, place=f"line {mark.line + 1}, column {mark.column + 1}", **details)
