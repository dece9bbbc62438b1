"""Places of a layout's parts in its file, for what goes wrong after reading."""

from __future__ import annotations

from collections.abc import Iterator

from fixture_design.io.layout_rules import PARTS, given_keys
from fixture_design.io.places import KeyPath, Place
from fixture_design.io.records import LayoutRecord

#: Lists of things with names.
_NAMED = ("elements", "bodies", "contacts", "loads", "stages")


def layout_places(record: LayoutRecord, place: Place) -> dict[tuple[str, ...], str]:
    """What messages call the places of the part and of everything that has a name, as in `Layout.places`.

    Example:
        ``{("part",): "line 3, part.mesh", ("elements", "L1"): "line 5, elements[0]"}``
    """
    described = ((key, place.describe(path)) for key, path in _paths(record))
    return {key: text for key, text in described if text}


def _paths(record: LayoutRecord) -> Iterator[tuple[tuple[str, ...], KeyPath]]:
    if record.part is not None:
        yield ("part",), ("part", *given_keys(record.part, PARTS))
    for key in _NAMED:
        for index, named in enumerate(getattr(record, key)):
            yield (key, named.name), (key, index)
