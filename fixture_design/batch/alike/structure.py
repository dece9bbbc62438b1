"""A line of JSON as a structure and its numbers: lines of one structure differ in numbers and in the layout's name.

The text is cut at its quotes; what is outside of them and can be part of a number is a number. Filled into the
structure again the numbers must give the text, to the byte, so that nothing else can be different; a JSON parser reads
the numbers, so that they are none but JSON's.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

#: Bytes that numbers consist of, and a table that makes all others blanks.
_NUMBER = b"0123456789.-+eE"
_BLANKED = bytes(byte if byte in _NUMBER else 32 for byte in range(256))
_RUN = re.compile(rb"[0-9.eE+-]+")
#: Words outside of quotes have letters that numbers have; they are put aside as bytes that no text has.
_WORDS = ((b"true", b"\1"), (b"false", b"\2"), (b"null", b"\3"))
_ASIDE = re.compile(rb"[\1\2\3\\]")
#: Stands for number k while a structure is made.
_MARKED = 10_000_000
_MARKED_NAME = "\ufffc"
#: Structures kept for the same texts in quotes, and in all.
_MOST_ALIKE, _MOST = 4, 256

#: A way to a value: ("contacts", 0, "point", 2).
Path = tuple[str | int, ...]


@dataclass(frozen=True, eq=False)
class Structure:
    """What lines have in common.

    Attributes:
        paths: where each number stands.
        filled: the text outside of quotes, as a format of the numbers.
        quoted: the texts in quotes, the layout's name as None.
        named: which of the quoted texts is the layout's name; None if it has none.
    """

    paths: tuple[Path, ...]
    filled: bytes
    quoted: tuple[bytes | None, ...]
    named: int | None

    def name_in(self, quoted: list[bytes]) -> str | None:
        """The layout's name, where these are the texts in quotes of a line that is alike; None if it is not."""
        if self.named is None:
            return "" if tuple(quoted) == self.quoted else None
        name = quoted[self.named]
        quoted[self.named] = None  # type: ignore[call-overload]
        alike = tuple(quoted) == self.quoted
        quoted[self.named] = name
        text = name.decode("ascii", errors="replace")
        return text if alike and text and text.isascii() and text.isprintable() else None


@dataclass(frozen=True)
class Cut:
    """A line cut at its quotes and numbers."""

    outside: bytes
    quoted: list[bytes]
    numbers: tuple[bytes, ...]

    @property
    def key(self) -> tuple[int, int]:
        return len(self.quoted), len(self.numbers)


class Structures:
    """The structures met so far, each with what was made of it."""

    def __init__(self) -> None:
        self._known: dict[tuple[object, ...], list[tuple[Structure, Any]]] = {}
        self._places: dict[tuple[int, int], dict[int | None, None]] = {}
        self._last: tuple[Structure, Any] | None = None
        self._count = 0

    def find(self, cut: Cut) -> tuple[Structure, Any, str] | None:
        """The structure of a line, what was made of it, and the layout's name ("" if it has none)."""
        if self._last is not None and (name := self._name_in(self._last[0], cut)) is not None:
            return *self._last, name
        for place in self._places.get(cut.key, ()):
            for structure, made in self._known.get(_key(cut, place), ()):
                name = self._name_in(structure, cut)
                if name is not None:
                    self._last = structure, made
                    return structure, made, name
        return None

    @staticmethod
    def _name_in(structure: Structure, cut: Cut) -> str | None:
        if len(cut.quoted) != len(structure.quoted) or len(cut.numbers) != len(structure.paths):
            return None
        name = structure.name_in(cut.quoted)
        return name if name is not None and structure.filled % cut.numbers == cut.outside else None

    def add(self, structure: Structure, made: Any, cut: Cut) -> None:
        """Remembers a structure; the oldest one of the same texts in quotes is forgotten where there are many."""
        self._places.setdefault(cut.key, {})[structure.named] = None
        alike = self._known.setdefault(_key(cut, structure.named), [])
        if len(alike) == _MOST_ALIKE:
            alike.pop()
        elif self._count >= _MOST:
            return
        else:
            self._count += 1
        alike.insert(0, (structure, made))


def _key(cut: Cut, named: int | None) -> tuple[object, ...]:
    """What lines of one structure share: how much there is of it, and the texts in quotes but for the name."""
    texts = cut.quoted if named is None else [*cut.quoted[:named], *cut.quoted[named + 1 :]]
    return cut.key, named, b'"'.join(texts)


def cut(text: bytes) -> Cut | None:
    """A line cut to pieces; None if it has escapes, which are rare and left to a parser."""
    if _ASIDE.search(text):
        return None
    pieces = text.split(b'"')
    outside = b'"'.join(pieces[::2])
    for word, aside in _WORDS:
        outside = outside.replace(word, aside)
    return Cut(outside, pieces[1::2], tuple(outside.translate(_BLANKED).split()))


def numbers_of(cut: Cut) -> list[int | float] | None:
    """The numbers of a line; None if one is none."""
    try:
        return json.loads(b"[" + b",".join(cut.numbers) + b"]")
    except ValueError:
        return None


def structure_of(cut: Cut) -> Structure | None:
    """The structure of a line that is known to be a good layout; None if its values cannot be told from their text."""
    filled = b"%b".join(part.replace(b"%", b"%%") for part in _RUN.split(cut.outside))
    marked = filled % tuple(b"%d" % (_MARKED + k) for k in range(len(cut.numbers)))
    paths = _paths(_parsed(marked, cut.quoted))
    if sorted(paths) != [_MARKED + k for k in range(len(cut.numbers))]:
        return None
    named = next((k for k in range(1, len(cut.quoted)) if _is_name(marked, cut.quoted, k)), None)
    quoted = tuple(None if k == named else text for k, text in enumerate(cut.quoted))
    return Structure(tuple(paths[_MARKED + k] for k in range(len(cut.numbers))), filled, quoted, named)


def _is_name(marked: bytes, quoted: list[bytes], k: int) -> bool:
    if quoted[k - 1] != b"name":
        return False
    changed = [*quoted[:k], _MARKED_NAME.encode(), *quoted[k + 1 :]]
    return _parsed(marked, changed).get("name") == _MARKED_NAME


def _parsed(marked: bytes, quoted: list[bytes]) -> dict[str, Any]:
    for word, aside in _WORDS:
        marked = marked.replace(aside, word)
    outside = marked.split(b'"')
    pieces = [piece for pair in zip(outside, [*quoted, b""], strict=True) for piece in pair]
    parsed = json.loads(b'"'.join(pieces[:-1]))
    return parsed if isinstance(parsed, dict) else {}


def _paths(values: dict[str, Any]) -> dict[int, Path]:
    return {value: path for path, value in _numbers(values, ())}


def _numbers(values: Any, path: Path) -> Iterator[tuple[Path, int]]:
    if isinstance(values, dict):
        for key, value in values.items():
            yield from _numbers(value, (*path, key))
    elif isinstance(values, list):
        for index, value in enumerate(values):
            yield from _numbers(value, (*path, index))
    elif isinstance(values, int) and not isinstance(values, bool):
        yield path, values
