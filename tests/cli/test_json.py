"""--json is one JSON document and nothing else; schemas and versions are printed."""

import json
import math
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path

import pytest
from pydantic import TypeAdapter

from fixture_design.io.verdict_schema import FailureRecord, VerdictRecord
from fixture_design.version import VERSION
from tests.cli.layouts import FAILS, HOLDS

KEYS = {"schema", "name", "source", "space", "units", "satisfied", "groups", "contacts", "requirements", "loads"} | {
    "notes",
    "run",
}
QUESTIONS = {"deterministic", "accessible", "strongly_accessible", "form_closure", "force_closure"}
SETS = {"admissible_displacements", "admissible_forces", "bidirectional"}
FIGURE_8 = sorted((Path(__file__).resolve().parents[2] / "urdf" / "figure8").glob("*.layout.yaml"))


def parsed(text: str) -> object:
    """The document; NaN and Infinity, which Python would read, are none of JSON."""

    def refuse(constant: str) -> object:
        raise AssertionError(f"{constant} is not JSON")

    return json.loads(text, parse_constant=refuse)


def numbers(value: object) -> Iterator[float]:
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for item in value:
            yield from numbers(item)
    elif isinstance(value, int | float):
        yield value


@pytest.mark.parametrize("path", FIGURE_8, ids=lambda path: path.stem)
def test_a_verdict(command: Callable, path: Path) -> None:
    text = command("verify", "--json", path).out
    verdict = parsed(text)
    assert isinstance(verdict, dict)
    assert set(verdict) == KEYS
    assert verdict["source"] == str(path)
    assert (verdict["space"], verdict["units"]) == ("planar", "m")
    for group in verdict["groups"].values():
        assert set(group) == QUESTIONS | SETS | {"contacts"}
        for question in QUESTIONS:
            assert {"verdict", "margin", "witness", "residual"} <= set(group[question])
    assert {"version", "kernel", "tolerances", "reference", "length"} <= set(verdict["run"])
    found = list(numbers(verdict))
    assert len(found) > 50
    assert all(math.isfinite(number) for number in found)
    TypeAdapter(VerdictRecord).validate_json(text)


def test_several_are_an_array_in_order(command: Callable) -> None:
    verdicts = parsed(command("verify", "--json", *FIGURE_8).out)
    assert isinstance(verdicts, list)
    assert [verdict["source"] for verdict in verdicts] == [str(path) for path in FIGURE_8]


def test_error_records_follow_the_schema_too(command: Callable, tmp_path: Path) -> None:
    record = parsed(command("verify", "--json", tmp_path / "nothing.yaml").out)
    TypeAdapter(FailureRecord).validate_python(record)


def test_notes_and_answers_are_the_tables(command: Callable, tmp_path: Path) -> None:
    for text, satisfied in ((HOLDS, "yes"), (FAILS, "no")):
        path = tmp_path / "x.yaml"
        path.write_text(text)
        verdict = parsed(command("verify", "--json", path).out)
        assert isinstance(verdict, dict)
        assert verdict["satisfied"] == satisfied
        table = command("verify", path).out
        for row in verdict["requirements"]:
            assert f"required of {row['group']}: {row['require'].replace('_', ' ')}: {row['verdict']}" in table


@pytest.mark.parametrize("name", ["layout", "task", "verdict"])
def test_schemas(command: Callable, name: str) -> None:
    ran = command("schema", name)
    schema = parsed(ran.out)
    assert isinstance(schema, dict)
    assert schema["$id"] == f"fixture_design/{name}/1"
    assert (ran.code, ran.err) == (0, "")


def test_version_names_drake_and_the_kernel(command: Callable) -> None:
    from fixture_design.cones.kernel import NAME

    ran = command("--version")
    assert ran.out == f"fixture-design {VERSION}, Drake {version('drake')}, kernel {NAME}\n"
    assert (ran.code, ran.err) == (0, "")


def test_help(command: Callable) -> None:
    ran = command("--help")
    assert (ran.code, ran.err) == (0, "")
    assert "verify" in ran.out
    assert "schema" in ran.out
    ran = command("verify", "--help")
    assert ran.code == 0
    assert "--json" in ran.out
