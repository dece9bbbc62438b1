"""Plain values as YAML that people like to read: a line a key, a line an item, brackets inside.

Numbers are written with all their digits, and so that readers of YAML 1.1 see numbers too (1.0e-05, not 1e-05); text is
quoted wherever any reader could take it for something else.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

_PLAIN_TEXT = re.compile(r"[A-Za-z_./][\w./+-]*(?: [\w./+-]+)*", re.ASCII)
_WORDS_WITH_MEANING = {"true", "false", "yes", "no", "on", "off", "y", "n", "null", "nan", "inf"}
_NUMBER_LIKE = re.compile(r"\.([0-9].*|inf|nan)", re.IGNORECASE)
_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def yaml_text(data: Mapping[str, object]) -> str:
    """YAML text of a mapping of None, bool, int, float, str, lists and mappings."""
    return "".join(_entry(key, value) for key, value in data.items())


def _entry(key: str, value: object) -> str:
    if isinstance(value, list) and any(isinstance(item, Mapping) for item in value):
        return f"{_text(key)}:\n" + "".join(f"  - {_flow(item)}\n" for item in value)
    return f"{_text(key)}: {_flow(value)}\n"


def _flow(value: object) -> str:
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_text(key)}: {_flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, Sequence):
        return "[" + ", ".join(map(_flow, value)) + "]"
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    return _number(value)


def _number(value: object) -> str:
    text = repr(float(value) if isinstance(value, float) else value)
    return text.replace("e", ".0e") if "e" in text and "." not in text else text


def _text(text: str) -> str:
    plain = _PLAIN_TEXT.fullmatch(text) and not _NUMBER_LIKE.fullmatch(text)
    if plain and text.lower() not in _WORDS_WITH_MEANING:
        return text
    return '"' + "".join(map(_escaped, text)) + '"'


def _escaped(character: str) -> str:
    if character in _ESCAPES:
        return _ESCAPES[character]
    if character == " " or character.isprintable():
        return character
    return f"\\U{ord(character):08x}"
