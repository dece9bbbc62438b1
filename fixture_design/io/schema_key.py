"""The key `schema`, which says what a file is."""

from __future__ import annotations

import re

from fixture_design.errors import FileFormatError
from fixture_design.io.documents import Document
from fixture_design.io.problems import show

#: Kind of file -> what it is called, and the command that takes it.
_KINDS = {
    "layout": ("a layout", "verify"),
    "task": ("a task", "design"),
    "assembly": ("an assembly", "states"),
    "graph": ("a contact-state graph", "classifier"),
    "classifier": ("a classifier", "recognize"),
    "hand": ("a hand", "grasp"),
    "verdict": ("a verdict, which is a result", "batch --against"),
}

_SCHEMA = re.compile(r"fixture_design/([a-z_]+)/([0-9]{1,9})")


def require_schema(document: Document, kind: str, version: int = 1) -> None:
    """Raises FileFormatError unless the document is a ``kind`` of this version, and says what it is instead."""
    wanted = f"fixture_design/{kind}/{version}"
    if "schema" not in document.values:
        raise FileFormatError(
            "the key 'schema' is missing", source=document.source, place=document.place.describe(()),
            expected=f"schema: {wanted}",
        )  # fmt: skip
    found = document.values["schema"]
    if found == wanted:
        return
    raise FileFormatError(
        f"this is not {_KINDS[kind][0]} that can be read: {_instead(found, kind, version)}",
        source=document.source,
        place=document.place.describe(("schema",)),
        found=show(found),
        expected=wanted,
    )


def _instead(found: object, kind: str, version: int) -> str:
    match = _SCHEMA.fullmatch(found) if isinstance(found, str) else None
    if match is None or match[1] not in _KINDS:
        return "unknown schema"
    if match[1] != kind:
        what, command = _KINDS[match[1]]
        return f"it is {what} (use `fixture-design {command}`)"
    newer = int(match[2]) > version
    return f"version {match[2]} needs a newer fixture-design" if newer else f"there was no version {match[2]}"
