"""Where values stand in a file: line, column and key path, so that every message can point there."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

#: A way from the top of a document to one of its values: ("elements", 2, "role").
Key = str | int
KeyPath = tuple[Key, ...]

#: Deepest nesting of lists and mappings that is read: the formats here need 8.
DEEPEST = 100

_PLAIN_KEY = re.compile(r"[\w-]+")


@dataclass(frozen=True)
class Place:
    """Where a value starts, and the places of what is inside it.

    The place of a mapping's entry is that of its key, which is where a reader looks for it.

    Attributes:
        line, column: counted from 1; None for values that came from no file.
        inside: by key or index; shared between aliases of one anchor.
    """

    line: int | None = None
    column: int | None = None
    inside: Mapping[Key, Place] = field(default_factory=dict)

    def at(self, path: KeyPath) -> Place:
        """The place of the value at ``path``, or of the innermost value around it that is there."""
        place = self
        for key in path:
            if key not in place.inside:
                break
            place = place.inside[key]
        return place

    def describe(self, path: KeyPath) -> str | None:
        """In words: "line 12, elements[2].role"; None if nothing can be said."""
        line = self.at(path).line
        parts = [f"line {line}" if line else "", key_path_text(path)]
        return ", ".join(filter(None, parts)) or None


def key_path_text(path: KeyPath) -> str:
    """("elements", 2, "role") as elements[2].role; keys that are not plain words in quotes."""
    text = ""
    for key in path:
        if isinstance(key, int):
            text += f"[{key}]"
        else:
            text += ("." if text else "") + (key if _PLAIN_KEY.fullmatch(key) else repr(key))
    return text
