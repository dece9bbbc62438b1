"""The core schema of YAML 1.2: what is a number, and what only looks like one to YAML 1.1."""

import math

import pytest

from fixture_design.errors import FileFormatError
from fixture_design.io.yaml_reader import parse_yaml


def value_of(word: str) -> object:
    values, _ = parse_yaml(f"key: {word}")
    assert isinstance(values, dict)
    return values["key"]


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("1e-3", 1e-3), ("1E3", 1000.0), ("1.", 1.0), (".5", 0.5), ("-0.0", 0.0), ("+1.5e+2", 150.0), ("12", 12),
        ("-7", -7), ("+7", 7), ("012", 12), ("0o12", 10), ("0x1F", 31), ("true", True), ("False", False),
        ("null", None), ("~", None), ("", None), (".inf", math.inf), ("-.INF", -math.inf),
        ("!!float 3", 3.0), ("!!int 0x10", 16), ("!!str 12", "12"), ("! 12", "12"), ("'12'", "12"), ('"true"', "true"),
    ],
)  # fmt: skip
def test_words_of_the_core_schema(word: str, value: object) -> None:
    assert value_of(word) == value
    assert type(value_of(word)) is type(value)


@pytest.mark.parametrize(
    "word", ["yes", "no", "on", "off", "y", "1_000", "0b11", "12:30", "2020-01-01", "0o8", "0xG", "1e", ".", "e3",
             "NaN", "inf", "nULL", "tRUE", "1,5", "="],
)  # fmt: skip
def test_everything_else_is_text(word: str) -> None:
    assert value_of(word) == word


@pytest.mark.parametrize("word", [".nan", ".NaN", ".NAN"])
def test_not_a_number(word: str) -> None:
    found = value_of(word)
    assert isinstance(found, float)
    assert math.isnan(found)


@pytest.mark.parametrize(
    ("word", "problem"),
    [
        ("!!int abc", "line 1, column 6: the tag !!int does not fit; found 'abc'"),
        ("!!float true", "line 1, column 6: the tag !!float does not fit; found 'true'"),
        ("!mine 1", "line 1, column 6: unknown tag '!mine'; expected no tag"),
        ("!!set {a}", "line 1, column 6: unknown tag 'tag:yaml.org,2002:set'; expected no tag"),
        ("9" * 5000, "line 1, column 6: an integer of 5000 digits; expected a number that a float can hold"),
    ],
)
def test_refused(word: str, problem: str) -> None:
    with pytest.raises(FileFormatError) as caught:
        value_of(word)
    assert str(caught.value) == problem
