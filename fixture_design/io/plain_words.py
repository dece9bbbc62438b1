"""What pydantic found wrong, in plain sentences.

pydantic tells the kind of error, the key path and the value; the classes tell which keys and words there could have
been. None of its own wording reaches a user.
"""

from __future__ import annotations

import types
from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin

from pydantic import ValidationError

from fixture_design.io.documents import Document
from fixture_design.io.places import Key, KeyPath, key_path_text
from fixture_design.io.problems import Problem, content_error, either, show
from fixture_design.io.record_types import Record

R = TypeVar("R", bound=Record)

#: What the words of a list or key are called in messages, where the key itself is no good name for one.
_NOUNS = {"require": "requirement", "locators": "requirement", "all": "requirement", "units": "unit"}

#: Kind of error -> what is said of the value; all others are wrong types.
_WRONG = {
    "finite_number": "is not finite",
    "string_pattern_mismatch": "is not usable as a name",
    "string_too_short": "is empty",
    "too_short": "has too few values",
    "too_long": "has too many values",
    "greater_than": "is out of range",
    "greater_than_equal": "is out of range",
    "less_than_equal": "is out of range",
}

#: Kind of error -> what would have been right, with pydantic's limits filled in.
_EXPECTED = {
    "finite_number": "a finite number",
    "int_type": "a whole number",
    "bool_type": "true or false",
    "string_pattern_mismatch": "a name in one line, without '#' (it numbers contacts) and without blanks around it",
    "string_too_short": "text that is not empty",
    "too_short": "{min_length} or more",
    "too_long": "{max_length} or fewer",
    "greater_than": "a number > {gt:g}",
    "greater_than_equal": "a number >= {ge:g}",
    "less_than_equal": "a number <= {le:g}",
}

_NO_NULL = "a value; leave the key out where there is none"


def validated(model: type[R], document: Document) -> R:
    """The document as a record.

    Raises:
        FileFormatError: the first problem in the file, and how many more there are.
    """
    empty = [
        Problem(path, f"{key_path_text(path[-1:])} has no value", expected=_NO_NULL) for path in _nulls(document.values)
    ]
    if empty:
        raise content_error(empty, document)
    try:
        return model.model_validate(document.values)
    except ValidationError as cause:
        problems = [_problem(model, error) for error in cause.errors(include_url=False) if not _is_echo(error)]
        raise content_error(_without_echoes(problems), document) from cause


def _is_echo(error: Any) -> bool:
    """A list whose items are wrong is not too short as well, though pydantic counts its valid items only."""
    return error["type"] == "too_short" and len(error["input"]) >= error["ctx"]["min_length"]


def _nulls(values: object, path: KeyPath = ()) -> Iterator[KeyPath]:
    """Keys and items without a value: most often something was to be filled in, so it is not taken for a default."""
    if values is None:
        yield path
    items: Iterable[tuple[Key, object]] = ()
    if isinstance(values, dict):
        items = values.items()
    elif isinstance(values, list | tuple):
        items = enumerate(values)
    for key, value in items:
        yield from _nulls(value, (*path, key))


def known_keys(model: type[Record]) -> list[str]:
    """The keys of a record as they stand in a file."""
    return [field.alias or name for name, field in model.model_fields.items()]


def _problem(model: type[Record], error: Any) -> tuple[Problem, str | None]:
    """The problem, and the known key that an unknown one was probably meant to be."""
    path: KeyPath = tuple(error["loc"])
    if error["type"] == "extra_forbidden":
        return _unknown_key(model, path)
    if error["type"] == "missing":
        owner = _type_at(model, path[:-1])
        wanted = owner.WANTED if isinstance(owner, type) and issubclass(owner, Record) else None
        return Problem(path[:-1], f"the key {path[-1]!r} is missing", expected=wanted), None
    if error["type"] == "literal_error":
        return _unknown_word(path, error["input"], [str(word) for word in get_args(_type_at(model, path))]), None
    found = error["input"]
    expected = _expected(error["type"], error.get("ctx", {}), found, _type_at(model, path))
    return Problem(path, _wrong(path, error["type"]), show(found), expected), None


def _wrong(path: KeyPath, kind: str) -> str:
    """What is wrong with the value of a key, or with an item of it."""
    keys = [key for key in path if isinstance(key, str)]
    item = "an item of " if isinstance(path[-1], int) else ""
    return f"{item}{keys[-1]!r} {_WRONG.get(kind, 'is of the wrong kind')}"


def _unknown_key(model: type[Record], path: KeyPath) -> tuple[Problem, str | None]:
    owner = _type_at(model, path[:-1])
    known = known_keys(owner)
    close = get_close_matches(str(path[-1]), known, n=1)
    hint = f" (did you mean {close[0]!r}?)" if close else ""
    problem = Problem(path, f"unknown key {path[-1]!r}{hint}", expected=f"one of: {', '.join(known)}")
    return problem, close[0] if close else None


def _unknown_word(path: KeyPath, found: object, known: list[str]) -> Problem:
    key = next((key for key in reversed(path) if isinstance(key, str)), "value")
    close = get_close_matches(found, known, n=1) if isinstance(found, str) else []
    hint = f" (did you mean {close[0]!r}?)" if close else ""
    return Problem(path, f"unknown {_NOUNS.get(key, key)} {show(found)}{hint}", expected=either(known))


def _expected(kind: str, limits: dict[str, Any], found: object, wanted: Any) -> str:
    """What would have been right."""
    if kind in _EXPECTED:
        return _EXPECTED[kind].format(**limits)
    match kind:
        case "float_type":
            return _number_wanted(found)
        case "string_type":
            return f"text in quotes: '{show(found)}'" if isinstance(found, int | float) else "text"
        case "tuple_type":
            return _list_wanted(wanted)
        case "dict_type":
            return "a mapping: {name: number}"
        case "model_type":
            return wanted.WANTED
    raise AssertionError(f"no words for pydantic's error {kind!r}")


def _number_wanted(found: object) -> str:
    if isinstance(found, int) and not isinstance(found, bool):
        return "a number that a float can hold"
    if isinstance(found, str):
        try:
            float(found)
        except ValueError:
            return "a number such as 0.2 or 1.0e-5"
        return "a number, without quotes"
    return "a number"


def _list_wanted(wanted: Any) -> str:
    item = _stripped(get_args(wanted)[0])
    if item is float:
        return "a list of numbers: [x, y, z]"
    if isinstance(item, type) and issubclass(item, Record):
        return f"a list; each item {item.WANTED}"
    return "a list: [...]"


def _without_echoes(problems: list[tuple[Problem, str | None]]) -> list[Problem]:
    """Leaves out 'the key role is missing' where the same mapping has 'unknown key rol, did you mean role'."""
    meant = {(problem.path[:-1], f"the key {key!r} is missing") for problem, key in problems if key}
    return [problem for problem, _ in problems if (problem.path, problem.text) not in meant]


def _type_at(model: Any, path: KeyPath) -> Any:
    """The type that a record's classes give for a key path, without Optional and Annotated."""
    wanted = _stripped(model)
    for key in path:
        if isinstance(key, int):
            wanted = _stripped(get_args(wanted)[0])
        elif get_origin(wanted) is dict:
            wanted = _stripped(get_args(wanted)[1])
        else:
            fields = {field.alias or name: field for name, field in wanted.model_fields.items()}
            wanted = _stripped(fields[key].annotation)
    return wanted


def _stripped(wanted: Any) -> Any:
    if get_origin(wanted) is Annotated:
        return _stripped(get_args(wanted)[0])
    if get_origin(wanted) in (Union, types.UnionType):
        return _stripped(next(_not_none(wanted)))
    return wanted


def _not_none(union: Any) -> Iterator[Any]:
    return (option for option in get_args(union) if option is not type(None))
