"""From an item of a batch to its layout."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from fixture_design.batch.item import Item
from fixture_design.batch.sweep import variant_count, variant_of
from fixture_design.errors import InputError
from fixture_design.io import Document, document_of, layout_from_data, line_document, read_document
from fixture_design.layout import Layout

#: Layouts kept for the variants of their sweeps: these come one after the other.
_KEPT = 4
#: What a line of a .jsonl need not say twice: the source names the line.
_FIRST_LINE = re.compile(r"^line 1(, |: |$)")


def layout_of(item: Item, *, placed: bool = True) -> Layout:
    """The layout of an item, a variant of its sweep where the item is one; it has the record's name and source.

    Args:
        placed: whether it and its errors know the places in the text, which take longer than all the rest.

    Raises:
        InputError: as `read_layout`; of a line the source is "lib.jsonl:12".
    """
    layout = _nominal(item.source, item.text, item.line, placed)
    if item.variant is None:
        if layout.sweep is not None:
            variant_count(layout)  # raises for a sweep that cannot be made
        return layout
    return replace(variant_of(layout, item.variant), name=item.named(layout.name), sweep=None)


def nominal_of(item: Item) -> Layout:
    """The layout whose sweep an item is a variant of, or the item's own.

    Raises:
        InputError: as `layout_of`.
    """
    return _nominal(item.source, item.text, item.line, placed=False)


def values_of(item: Item) -> Mapping[str, Any]:
    """The plain values of an item's text; none where it cannot be read."""
    return _values(item.source, item.text, item.line)


@lru_cache(maxsize=_KEPT)
def _values(source: str, text: bytes | None, line: int | None) -> Mapping[str, Any]:
    """Kept, since a text's layout and its hash want them one after the other: YAML is slow to read."""
    try:
        values = _quick(Item(source, text, line))
        return MappingProxyType(_document(source, text, line).values if values is None else values)
    except InputError:
        return MappingProxyType({})


@lru_cache(maxsize=_KEPT)
def _document(source: str, text: bytes | None, line: int | None) -> Document:
    if text is None:
        return read_document(source)
    if line is None:
        return document_of(text, source)
    return line_document(text, source)


def _quick(item: Item) -> dict[str, Any] | None:
    """The values of a JSON text without their places; None where anything is not plain, which reading it well tells."""
    is_json = item.line is not None or item.source.lower().endswith(".json")
    if not is_json or item.text is None or b"\\" in item.text:
        return None
    try:
        values = json.loads(item.text, object_pairs_hook=_once, parse_constant=_refused)
    except (ValueError, RecursionError):
        return None
    return values if isinstance(values, dict) else None


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) < len(pairs):
        raise ValueError("a key is given twice")
    return values


def _refused(word: str) -> float:
    raise ValueError(f"{word} is not JSON")


@lru_cache(maxsize=_KEPT)
def _nominal(source: str, text: bytes | None, line: int | None, placed: bool) -> Layout:
    item = Item(source, text, line)
    try:
        values = None if placed else _quick(item)
        document = _document(source, text, line) if values is None else Document(values, source)
        layout = layout_from_data({"name": item.default_name, **document.values}, source, document.place)
    except InputError as error:
        if line is not None and error.place is not None:
            error.place = _FIRST_LINE.sub("", error.place) or None
        error.within(Path(source))
        raise
    if line is None:
        return layout
    return replace(layout, places={key: _FIRST_LINE.sub("", place) for key, place in layout.places.items()})
