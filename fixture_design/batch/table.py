"""Records as a flat table: CSV, or Parquet where polars or pandas is installed."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from fixture_design.batch.outcome import outcome_of, smallest_margin
from fixture_design.batch.records import Record
from fixture_design.batch.results import records_in
from fixture_design.errors import FileFormatError, InputError
from fixture_design.io.text_file import write_pieces

#: Columns that every table has; then verdict and margin of every question of every group.
_FIRST = ("name", "source", "outcome", "smallest_margin", "error_kind", "error_message", "input", "time")
#: What may write Parquet, the first that is there.
_PARQUET = ("polars", "pandas")


def check_table(path: Path) -> None:
    """Before anything long begins: whether such a table can be written.

    Raises:
        InputError: another ending than .csv and .parquet, or nothing is installed that writes Parquet; a file that is
            no such table would be lost, maybe one of loads.
    """
    if path.suffix.lower() not in (".csv", ".parquet"):
        raise InputError(
            "a table of this kind is not known", source=path, expected="a name that ends in .csv or .parquet"
        )
    if path.suffix.lower() == ".parquet" and not any(map(find_spec, _PARQUET)):
        raise InputError("Parquet needs polars or pandas", source=path, expected="pip install polars, or a .csv")
    if path.suffix.lower() == ".csv" and path.is_file() and path.stat().st_size:
        begins = ",".join(_FIRST).encode()
        with path.open("rb") as opened:
            if opened.read(len(begins)) != begins:
                raise FileFormatError("this file is no table of a batch and would be lost", source=path,
                                      expected="another name")  # fmt: skip


def write_table(output: Path, path: Path) -> None:
    """Writes the records of an output file as a table with a row each; for Parquet all of it is in memory.

    Raises:
        InputError: as `check_table`.  FileFormatError: it cannot be written.
    """
    check_table(path)
    columns = _columns(records_in(output))
    if path.suffix.lower() == ".csv":
        write_pieces(path, _csv_lines(columns, map(row_of, records_in(output))))
        return
    rows = [{**dict.fromkeys(columns), **row_of(record)} for record in records_in(output)]
    by_column = {column: [row[column] for row in rows] for column in columns}
    try:
        _write_parquet(by_column, path)
    except (OSError, ImportError) as cause:  # pandas needs pyarrow or fastparquet
        raise FileFormatError(f"the table cannot be written: {cause}", source=path) from cause


class _Line:
    """A file of which `csv` only wants to know where a line goes: back to who asked for it."""

    def write(self, text: str) -> str:
        return text


def _csv_lines(columns: list[str], rows: Iterable[dict[str, Any]]) -> Iterator[str]:
    writer = csv.DictWriter(_Line(), columns, restval="", lineterminator="\n")
    yield writer.writerow(dict(zip(columns, columns, strict=True)))  # type: ignore[misc]
    for row in rows:
        yield writer.writerow(row)  # type: ignore[misc]


def _write_parquet(columns: dict[str, list[Any]], path: Path) -> None:
    if find_spec("polars"):
        import polars  # noqa: PLC0415 - whoever wants Parquet has it  # pyright: ignore[reportMissingImports]

        polars.DataFrame(columns, strict=False).write_parquet(path)
        return
    import pandas  # noqa: PLC0415  # pyright: ignore[reportMissingImports]

    pandas.DataFrame(columns).to_parquet(path)


def row_of(record: Record) -> dict[str, Any]:
    """A record as one row: plain values by column."""
    error, run = record.get("error", {}), record.get("run", {})
    row = {
        "name": record["name"], "source": record.get("source"), "outcome": outcome_of(record),
        "smallest_margin": smallest_margin(record), "error_kind": error.get("kind"),
        "error_message": error.get("message"), "input": run.get("input"), "time": run.get("time"),
    }  # fmt: skip
    for name, group in record.get("groups", {}).items():
        for claim, finding in group.items():
            if isinstance(finding, dict) and "verdict" in finding:
                row[f"{name}.{claim}"] = finding["verdict"]
                if "margin" in finding:
                    row[f"{name}.{claim}.margin"] = finding["margin"]
    return row


def _columns(records: Iterable[Record]) -> list[str]:
    """All columns, in the order they are met."""
    columns = dict.fromkeys(_FIRST)
    for record in records:
        columns |= dict.fromkeys(row_of(record))
    return list(columns)
