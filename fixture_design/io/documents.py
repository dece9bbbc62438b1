"""A file of ours as plain values with their places, whether it is YAML or JSON."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from fixture_design.errors import FileFormatError
from fixture_design.io.json_reader import parse_json
from fixture_design.io.places import KeyPath, Place
from fixture_design.io.yaml_reader import parse_yaml

#: Characters that no text file has.
_NOT_TEXT = re.compile("[^\t\n\r -~\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

_SURROGATE = re.compile("[\ud800-\udfff]")


@dataclass(frozen=True)
class Document:
    """The mapping that a file holds.

    Attributes:
        values: of None, bool, int, float, str, list and dict only.
        source: the file's name as it was given, for messages.
        place: of every value.
    """

    values: dict[str, object]
    source: str
    place: Place = field(default_factory=Place)


def read_document(path: str | Path) -> Document:
    """Reads a file: JSON if its name ends in .json, else YAML 1.2.

    Raises:
        FileFormatError: missing, a folder, a pipe or device, not permitted, not text, empty, not valid, or not a
            mapping.
    """
    return document_of(read_bytes(Path(path)), path)


def document_of(raw: bytes, path: str | Path) -> Document:
    """What `read_document` makes of a file that holds ``raw``; ``path`` tells whether it is JSON, and is for messages.

    Raises:
        FileFormatError: not text, empty, not valid, or not a mapping.
    """
    parse = parse_json if Path(path).suffix.lower() == ".json" else parse_yaml
    return as_document(*parse(_decode(raw, Path(path)), str(path)), str(path))


def line_document(raw: bytes, source: str) -> Document:
    """A JSON object in one line of a file, as a document; ``source`` is what messages call that line.

    Raises:
        FileFormatError: not text, not JSON, or not an object.
    """
    return as_document(*parse_json(_decode(raw, Path(source)), source), source)


def as_document(values: object, place: Place, source: str) -> Document:
    """A parsed value as a document: it must be a mapping."""
    if values is None:
        raise FileFormatError("the file is empty", source=source, expected="a mapping that starts with `schema:`")
    if not isinstance(values, dict):
        kind = "a list" if isinstance(values, list) else f"the single value {values!r:.60}"
        raise FileFormatError(
            "the file holds no mapping",
            source=source,
            place=place.describe(()),
            found=kind,
            expected="`key: value` lines",
        )
    document = Document(values, source, place)
    for path, text in _texts(values):
        if _SURROGATE.search(text):
            raise FileFormatError(
                "an escape stands for half a character (a lone surrogate)",
                source=source, place=place.describe(path), found=ascii(text)[:60], expected="whole characters",
            )  # fmt: skip
    return document


def _texts(values: object, path: KeyPath = ()) -> Iterator[tuple[KeyPath, str]]:
    """All texts, keys too; a key's place is that of its mapping, whose path can be printed."""
    if isinstance(values, str):
        yield path, values
    elif isinstance(values, dict):
        for key, value in values.items():
            yield path, key
            yield from _texts(value, (*path, key))
    elif isinstance(values, list):
        for index, value in enumerate(values):
            yield from _texts(value, (*path, index))


def read_bytes(path: Path) -> bytes:
    """What a file holds.

    Raises:
        FileFormatError: missing, a folder, a pipe or device, not permitted.
    """
    try:
        if path.exists() and not (path.is_file() or path.is_dir()):  # a pipe may never end, or never begin
            raise FileFormatError("this is no regular file", source=path, expected="a YAML or JSON file")
        return path.read_bytes()
    except FileNotFoundError as cause:
        raise FileFormatError("there is no such file", source=path, expected=_neighbours(path)) from cause
    except IsADirectoryError as cause:
        raise FileFormatError("this is a folder", source=path, expected="a file") from cause
    except PermissionError as cause:
        raise FileFormatError("the file may not be read (permission denied)", source=path) from cause
    except FileFormatError:
        raise
    except (OSError, ValueError) as cause:  # ValueError: a NUL in the name
        raise FileFormatError(f"the file cannot be read: {cause}", source=path) from cause


def _decode(raw: bytes, path: Path) -> str:
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff") or raw[:4] == b"\0\0\xfe\xff":
        bits = 32 if b"\0\0" in raw[:4] else 16
        raise FileFormatError(f"the file is UTF-{bits} text", source=path, expected="UTF-8: save it with that encoding")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as cause:
        line = raw.count(b"\n", 0, cause.start) + 1
        raise FileFormatError(
            "the file is not UTF-8 text", source=path, place=f"line {line}", found=f"byte 0x{raw[cause.start]:02x}",
            expected="a YAML or JSON file in UTF-8",
        ) from cause  # fmt: skip
    if match := _NOT_TEXT.search(text):
        line = text.count("\n", 0, match.start()) + 1
        raise FileFormatError(
            "the file is not text", source=path, place=f"line {line}", found=f"the character U+{ord(match[0]):04X}",
            expected="a YAML or JSON file",
        )  # fmt: skip
    return text


def _neighbours(path: Path) -> str | None:
    """Files nearby with the same stem, which is what a wrong suffix or folder usually misses."""
    if not path.parent.is_dir():
        return f"an existing folder: {str(path.parent)!r} is not there"
    near = sorted(other.name for other in path.parent.glob("*") if other.is_file() and other.stem == path.stem)
    return f"one of {', '.join(near)}" if near and path.stem else None
