"""The core schema of YAML 1.2: which unquoted words are null, booleans and numbers.

YAML 1.1, which PyYAML resolves by itself, takes 1e-3 for text, `no` for false and 012 for ten; 1.2 does none of this.
"""

from __future__ import annotations

import re

from fixture_design.errors import InputError

Scalar = None | bool | int | float | str

_NULL = {"", "~", "null", "Null", "NULL"}
_BOOLEAN = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}
_INTEGER = re.compile(r"[-+]?[0-9]+")
_OCTAL = re.compile(r"0o[0-7]+")
_HEXADECIMAL = re.compile(r"0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_INFINITE = re.compile(r"[-+]?\.(inf|Inf|INF)")
_NOT_A_NUMBER = {".nan", ".NaN", ".NAN"}

#: More digits than this are no measurement; Python refuses to convert some thousands of them.
_LONGEST_INTEGER = 400

_TAG = "tag:yaml.org,2002:"
_TYPES: dict[str, tuple[type, ...]] = {
    "null": (type(None),),
    "bool": (bool,),
    "int": (int,),
    "float": (float, int),
}


def resolve(text: str) -> Scalar:
    """The value of an unquoted word.

    Raises:
        InputError: an integer of hundreds of digits.

    Example:
        >>> [resolve(word) for word in ("1e-3", "012", "0o12", "no", "~")]
        [0.001, 12, 10, 'no', None]
    """
    if text in _NULL:
        return None
    if text in _BOOLEAN:
        return _BOOLEAN[text]
    if _INTEGER.fullmatch(text):
        if len(text) > _LONGEST_INTEGER:
            raise InputError(f"an integer of {len(text)} digits", expected="a number that a float can hold")
        return int(text)
    if _OCTAL.fullmatch(text):
        return int(text, 8)
    if _HEXADECIMAL.fullmatch(text):
        return int(text, 16)
    if _FLOAT.fullmatch(text):
        return float(text)
    if _INFINITE.fullmatch(text):
        return float("-inf" if text.startswith("-") else "inf")
    return float("nan") if text in _NOT_A_NUMBER else text


def resolve_tagged(tag: str, text: str) -> Scalar:
    """The value of a word with an explicit tag: `!!str 12` is text.

    Raises:
        InputError: a tag that is not one of the core schema's, or a word that its tag does not fit.
    """
    kind = tag.removeprefix(_TAG)
    if tag == "!" or kind == "str":
        return text
    if kind not in _TYPES:
        raise InputError(f"unknown tag {tag!r}", expected="no tag")
    value = resolve(text)
    fits = isinstance(value, _TYPES[kind]) and not (isinstance(value, bool) and kind != "bool")
    if not fits:
        raise InputError(f"the tag !!{kind} does not fit", found=repr(text))
    return float(value) if kind == "float" and isinstance(value, int) else value
