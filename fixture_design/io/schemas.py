"""JSON Schemas (draft 2020-12) of our files, from the same classes that read and describe them."""

from __future__ import annotations

from typing import Any

from pydantic import TypeAdapter

from fixture_design.errors import UnknownNameError
from fixture_design.io.records import LayoutRecord
from fixture_design.io.task_records import TaskRecord

_DIALECT = "https://json-schema.org/draft/2020-12/schema"

_KINDS = ("assembly", "classifier", "graph", "hand", "layout", "task", "verdict")


def schema_names() -> list[str]:
    """The kinds of files that `json_schema` knows."""
    return sorted(_KINDS)


def json_schema(name: str) -> dict[str, Any]:
    """The JSON Schema of a kind of file: "assembly", "classifier", "graph", "hand", "layout", "task" or "verdict".

    A schema tells keys, types and ranges; what depends on several keys (numbers of coordinates, names) only reading
    a file tells.

    Raises:
        UnknownNameError: there is no such kind.
    """
    if name not in _KINDS:
        raise UnknownNameError("file kind", name, _KINDS)
    schema = TypeAdapter(_record(name)).json_schema(by_alias=True)
    if name != "verdict":
        schema = _without_nulls(schema)
    return {"$schema": _DIALECT, "$id": f"fixture_design/{name}/1", "title": f"fixture_design/{name}/1"} | {
        key: value for key, value in schema.items() if key != "title"
    }


def _record(name: str) -> Any:
    """The classes that describe a kind; those of verdicts only describe, so they are built only here."""
    if name == "layout":
        return LayoutRecord
    if name == "task":
        return TaskRecord

    if name == "assembly":
        from fixture_design.io.assembly_records import AssemblyRecord  # noqa: PLC0415 - only where asked for

        return AssemblyRecord
    if name == "classifier":
        from fixture_design.io.classifier_records import ClassifierRecord  # noqa: PLC0415 - as above

        return ClassifierRecord
    if name == "graph":
        from fixture_design.io.graph_records import GraphRecord  # noqa: PLC0415 - as above

        return GraphRecord
    if name == "hand":
        from fixture_design.io.hand_records import HandRecord  # noqa: PLC0415 - as above

        return HandRecord
    from fixture_design.io.verdict_schema import FailureRecord, VerdictRecord  # noqa: PLC0415 - 20 ms of any start

    return VerdictRecord | FailureRecord


def _without_nulls(schema: Any) -> Any:
    """Keys may be left out, but not be null: files are stricter there than the records they become."""
    if isinstance(schema, list):
        return [_without_nulls(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    kept = {key: _without_nulls(value) for key, value in schema.items() if not (key == "default" and value is None)}
    if "anyOf" in kept:
        options = [option for option in kept.pop("anyOf") if option != {"type": "null"}]
        kept |= options[0] if len(options) == 1 else {"anyOf": options}
    return kept
