"""A batch's output read again, record by record: for comparisons, tables and reports."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from fixture_design.batch.records import Record, record_of
from fixture_design.errors import FileFormatError
from fixture_design.io.verdict_record import VERDICT_SCHEMA


def records_in(path: Path) -> Iterator[Record]:
    """The records of an output file, one at a time; a last line that is cut short is none.

    Raises:
        FileFormatError: the file cannot be read, or has a line that is no record.
    """
    try:
        opened = path.open("rb")
    except OSError as cause:
        raise FileFormatError(f"the file cannot be read: {cause.strerror or cause}", source=path) from cause
    with opened:
        for number, line in enumerate(opened, start=1):
            if not line.endswith(b"\n"):
                return
            try:
                record = record_of(line)
            except ValueError as cause:
                raise FileFormatError("the line is no record", source=path, place=f"line {number}") from cause
            if record.get("schema") != VERDICT_SCHEMA or not isinstance(record.get("name"), str):
                raise FileFormatError(
                    "the line is no record", source=path, place=f"line {number}", found=repr(record.get("schema")),
                    expected=f"schema {VERDICT_SCHEMA}, as `batch -o` writes them",
                )  # fmt: skip
            yield record


def key_of(record: Record) -> tuple[str, str]:
    """What a layout is found again by: source and name."""
    return str(record.get("source")), record["name"]
