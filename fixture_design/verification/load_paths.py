"""Load paths: CSV files with one wrench a row, as a cutter's forces along its way.

The first line names the columns, in any order: x, y, z, fx, fy, fz and optionally mx, my, mz; planar x, y, fx, fy and
optionally m. The force [N] acts in the point, which is in W in the layout's unit of length; the moment [N m] is free.
Blank lines, and lines that begin with #, are left out. A row's number counts the others from 1.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from fixture_design.analysis.acting import LoadRow, load_wrench, wrench_at
from fixture_design.errors import FileFormatError, looking_at
from fixture_design.layout import Group, Layout, Load, Space
from fixture_design.tolerances import FARTHEST, MOST_FORCE

#: Columns there must be, and columns there may be.
COLUMNS: dict[Space, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "spatial": (("x", "y", "z", "fx", "fy", "fz"), ("mx", "my", "mz")),
    "planar": (("x", "y", "fx", "fy"), ("m",)),
}

#: Metres in a unit of length, as a divisor where that is exact.
_PER_METRE = {"m": 1.0, "mm": 1000.0, "in": 1 / 0.0254}

#: Rows of the longest path.
MOST_ROWS = 10_000


def load_rows(layout: Layout, group: Group) -> list[LoadRow]:
    """The wrenches of all loads that act on a group, in file order; without any, one of nothing.

    Raises:
        FileFormatError: a load path cannot be read, see `read_load_path`.
    """
    plane = 2 if layout.space == "planar" else 3
    rows: list[LoadRow] = []
    for load in (load for load in layout.loads if load.name in group.loads):
        if load.path is None:
            rows.append(LoadRow(load.name, None, load_wrench(load, plane)))
        else:
            with looking_at(layout.source, layout.places.get(("loads", load.name))):
                rows += read_load_path(load.path, load, layout)
    return rows or [LoadRow("no load", None, np.zeros(3 * (plane - 1)))]


def read_load_path(path: Path, load: Load, layout: Layout) -> list[LoadRow]:
    """The rows of a load path, about W's origin.

    Raises:
        FileFormatError: the file cannot be read, is empty, has not the columns or too many rows, or a cell is no finite
            number of a plausible size; with row and column.
    """
    lines = _lines(path)
    header = next(lines, None)
    if header is None:
        raise FileFormatError("the load path is empty", source=path, expected=_expected(layout.space))
    columns = _columns(header[1], path, header[0], layout.space)
    rows: list[LoadRow] = []
    for line, cells in lines:
        if len(rows) == MOST_ROWS:
            raise FileFormatError(f"the load path has more than {MOST_ROWS} rows", source=path)
        values = _values(cells, columns, path, line, len(rows) + 1)
        rows.append(LoadRow(load.name, len(rows) + 1, _wrench(values, layout)))
    if not rows:
        raise FileFormatError("the load path has a header and no rows", source=path, expected="a row for each load")
    return rows


def _lines(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Line numbers and cells of the lines that say something."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as cause:
        why = cause.strerror if isinstance(cause, OSError) and cause.strerror else "it is no text in UTF-8"
        raise FileFormatError(f"the load path cannot be read: {why}", source=path) from cause
    reader = csv.reader(text.splitlines())
    try:
        for cells in reader:
            stripped = [cell.strip() for cell in cells]
            if any(stripped) and not stripped[0].startswith("#"):
                yield reader.line_num, stripped
    except csv.Error as cause:
        raise FileFormatError(
            f"the load path is no CSV: {cause}", source=path, place=f"line {reader.line_num}"
        ) from cause


def _columns(names: Sequence[str], path: Path, line: int, space: Space) -> list[str]:
    needed, optional = COLUMNS[space]
    place = f"line {line}"
    if twice := [name for name in dict.fromkeys(names) if names.count(name) > 1]:
        raise FileFormatError(f"the column {twice[0]!r} is there twice", source=path, place=place)
    if missing := [name for name in needed if name not in names]:
        problem = f"the load path has no column {', '.join(map(repr, missing))}"
        raise FileFormatError(problem, source=path, place=place, expected=_expected(space))
    if unknown := [name for name in names if name not in (*needed, *optional)]:
        raise FileFormatError(f"unknown column {unknown[0]!r:.60}", source=path, place=place, expected=_expected(space))
    if 0 < sum(name in names for name in optional) < len(optional):
        given = ", ".join(repr(name) for name in optional if name in names)
        raise FileFormatError(
            f"moments have only the column {given}", source=path, place=place, expected=f"all of {', '.join(optional)}"
        )
    return list(names)


def _expected(space: Space) -> str:
    needed, optional = COLUMNS[space]
    return f"the columns {', '.join(needed)} and perhaps {', '.join(optional)}"


def _values(cells: Sequence[str], columns: Sequence[str], path: Path, line: int, row: int) -> dict[str, float]:
    if len(cells) != len(columns):
        problem = f"row {row} has {len(cells)} cells for {len(columns)} columns"
        raise FileFormatError(problem, source=path, place=f"line {line}")
    return {name: _number(cell, name, path, line, row) for name, cell in zip(columns, cells, strict=True)}


def _number(cell: str, column: str, path: Path, line: int, row: int) -> float:
    most = FARTHEST if column in ("x", "y", "z") else MOST_FORCE
    place = f"line {line}, row {row}, column {column}"
    try:
        value = float(cell) if "_" not in cell else math.nan
    except ValueError as cause:
        raise FileFormatError("a number is missing", source=path, place=place, found=f"{cell!r:.60}") from cause
    if not abs(value) <= most:
        wanted = f"a finite number up to {most:g}"
        raise FileFormatError("not a usable number", source=path, place=place, found=f"{cell!r:.60}", expected=wanted)
    return value


def _wrench(values: dict[str, float], layout: Layout) -> np.ndarray:
    axes = ("x", "y") if layout.space == "planar" else ("x", "y", "z")
    point = np.array([values[axis] / _PER_METRE[layout.units] for axis in axes])
    force = np.array([values[f"f{axis}"] for axis in axes])
    moment = np.array([values.get(name, 0.0) for name in COLUMNS[layout.space][1]])
    return wrench_at(point, force, moment)
