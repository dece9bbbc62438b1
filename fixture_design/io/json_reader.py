"""JSON text into plain values, with the place of each.

A YAML parser does not do: it refuses tabs and the surrogate pairs of escaped characters. The standard library decides
whether the text is JSON; what then walks through the tokens may rely on it, and only keeps count of where it is.
"""

from __future__ import annotations

import json
import re
from bisect import bisect_right
from collections.abc import Iterator, Mapping

from fixture_design.errors import FileFormatError, InputError
from fixture_design.io.places import DEEPEST, Key, Place

_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[-+.\w]+|[\[\]{}:,]')


def parse_json(text: str, source: str | None = None) -> tuple[object, Place]:
    """The value in ``text``; (None, Place()) for an empty text.

    Raises:
        FileFormatError: not JSON (line and column), NaN and Infinity, repeated keys, nesting beyond any use.
    """
    if not text.strip():
        return None, Place()
    try:
        json.loads(text)
    except json.JSONDecodeError as cause:
        place = f"line {cause.lineno}, column {cause.colno}"
        raise FileFormatError(f"not valid JSON: {cause.msg}", source=source, place=place) from cause
    except RecursionError as cause:
        raise FileFormatError("lists and mappings are nested too deep", source=source) from cause
    except ValueError as cause:  # Python converts integers of some thousand digits no more
        raise FileFormatError("a number has thousands of digits", source=source) from cause
    try:
        return _Walk(text).value()
    except InputError as error:
        error.source = source
        raise


class _Walk:
    """Walks through the tokens of valid JSON."""

    def __init__(self, text: str) -> None:
        self._tokens: Iterator[re.Match[str]] = _TOKEN.finditer(text)
        self._starts = [0, *(match.end() for match in re.finditer("\n", text))]

    def value(self) -> tuple[object, Place]:
        return self._from(next(self._tokens), 0)

    def _from(self, token: re.Match[str], depth: int) -> tuple[object, Place]:
        if depth > DEEPEST:
            raise self._error(token, f"lists and mappings are nested more than {DEEPEST} deep")
        if token[0] == "{":
            return self._object(token, depth)
        if token[0] == "[":
            return self._array(token, depth)
        if token[0] in ("NaN", "Infinity", "-Infinity"):
            raise self._error(token, f"{token[0]} is not JSON", "a finite number")
        return json.loads(token[0]), self._place(token)

    def _object(self, start: re.Match[str], depth: int) -> tuple[object, Place]:
        values: dict[str, object] = {}
        inside: dict[Key, Place] = {}
        while (token := next(self._tokens))[0] != "}":
            if token[0] == ",":
                continue
            key = json.loads(token[0])
            if key in values:
                lines = f"lines {inside[key].line} and {self._place(token).line}"
                raise self._error(token, f"the key {key!r} is given twice, in {lines}", "each key once")
            next(self._tokens)  # the colon
            values[key], place = self._from(next(self._tokens), depth + 1)
            inside[key] = self._place(token, place.inside)
        return values, self._place(start, inside)

    def _array(self, start: re.Match[str], depth: int) -> tuple[object, Place]:
        values: list[object] = []
        inside: dict[Key, Place] = {}
        while (token := next(self._tokens))[0] != "]":
            if token[0] == ",":
                continue
            value, inside[len(values)] = self._from(token, depth + 1)
            values.append(value)
        return values, self._place(start, inside)

    def _error(self, token: re.Match[str], problem: str, expected: str | None = None) -> FileFormatError:
        place = self._place(token)
        return FileFormatError(problem, place=f"line {place.line}, column {place.column}", expected=expected)

    def _place(self, token: re.Match[str], inside: Mapping[Key, Place] | None = None) -> Place:
        line = bisect_right(self._starts, token.start())
        return Place(line, token.start() - self._starts[line - 1] + 1, inside or {})
