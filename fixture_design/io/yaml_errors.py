"""What the YAML parser complains of, in plain words."""

from __future__ import annotations

import yaml

from fixture_design.errors import FileFormatError

#: What the parser says (the start of it) -> what that means for somebody who writes a layout.
_WORDS = {
    "mapping values are not allowed": "a ':' where none can be; check the indentation, and put quotes around text "
    "that contains ': '",
    "did not find expected ',' or ']'": "a list opened with '[' is not continued with ',' or closed with ']'",
    "expected ',' or ']'": "a list opened with '[' is not continued with ',' or closed with ']'",
    "did not find expected ',' or '}'": "a mapping opened with '{' is not continued with ',' or closed with '}'",
    "expected ',' or '}'": "a mapping opened with '{' is not continued with ',' or closed with '}'",
    "did not find expected node content": "a value is missing, or a bracket is not closed",
    "expected the node content": "a value is missing, or a bracket is not closed",
    "found unexpected end of stream": "a quote is opened and not closed",
    "could not find expected ':'": "a key without a ':' after it",
    "did not find expected key": "a line that is neither a key nor part of the value before; check the indentation",
    "expected <block end>": "a line that is neither a key nor part of the value before; check the indentation",
    "did not find expected '-' indicator": "a line that is not an item ('- ...') of the list before it; check the "
    "indentation",
    "did not find expected <document start>": "text after the end of the document; check brackets and indentation",
    "expected '<document start>'": "text after the end of the document; check brackets and indentation",
    "found unknown escape character": "an unknown escape in double quotes; use single quotes, or write \\\\",
    "found invalid Unicode character escape": "an escape that is no character (write the character itself)",
}


def syntax_error(cause: yaml.YAMLError, text: str, source: str | None) -> FileFormatError:
    """The parser's error, with its place and its meaning."""
    mark = getattr(cause, "problem_mark", None) or getattr(cause, "context_mark", None)
    if mark is None:
        return FileFormatError(f"this is not YAML ({cause})", source=source)
    said = getattr(cause, "problem", None) or str(cause)
    meaning = next((words for start, words in _WORDS.items() if said.startswith(start)), None)
    if said.startswith("found character") and "start any token" in said:
        meaning = _stray_character(text, mark.line, mark.column)
    return FileFormatError(
        f"not valid YAML: {meaning or said}{_opened(cause, mark.line)}",
        source=source,
        place=f"line {mark.line + 1}, column {mark.column + 1}",
    )


def _opened(cause: yaml.YAMLError, line: int) -> str:
    """Where the list, mapping or quote started that is not right, if that is another line."""
    start = getattr(cause, "context_mark", None)
    return f" (it starts in line {start.line + 1})" if start is not None and start.line != line else ""


def _stray_character(text: str, line: int, column: int) -> str:
    lines = text.splitlines()
    character = lines[line][column : column + 1] if line < len(lines) else ""
    if character == "\t":
        return "a tab in the indentation; YAML wants spaces"
    return f"text cannot start with {character!r}; put quotes around it"
