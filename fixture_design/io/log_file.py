"""Logs of wrenches and displacements as CSV.

The first line names the columns, in any order: t, fx, fy, fz, mx, my, mz, and for displacements dx, dy, dz, rx, ry, rz;
in the plane t, fx, fy, mz, and dx, dy, rz, where the others may be there and are left out. Where displacements alone
are measured the wrenches may be left out. A name may be followed by
its unit in brackets, which must be that of the column: `fx [N]`, `mz [N m]`, `t [s]`, `dx [m]`, `rz [rad]`. Blank
lines, and lines that begin with #, are left out. A row's number counts the others from 1. A simulation adds a column
`truth`, the contacts that there really were: `apex 4 - facet 7; facet 2 - apex 1`, nothing for none.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from fixture_design.errors import FileFormatError, InputError
from fixture_design.io.documents import read_bytes
from fixture_design.recognition.log import Log
from fixture_design.recognition.signals import Measure
from fixture_design.tolerances import MOST_FORCE

_WRENCH = {2: ("fx", "fy", "mz"), 3: ("fx", "fy", "fz", "mx", "my", "mz")}
_TWIST = {2: ("dx", "dy", "rz"), 3: ("dx", "dy", "dz", "rx", "ry", "rz")}
_TRUTH = "truth"
_ALL = ("t", *_WRENCH[3], *_TWIST[3], _TRUTH)

#: Between the contacts of a row's truth.
_AND = ";"

#: The unit of a column by its first letter, and ways to write it.
_UNITS = {
    "t": ("s",),
    "f": ("N",),
    "m": ("N m", "Nm", "N*m", "N·m"),
    "d": ("m",),
    "r": ("rad",),
}

_HEADING = re.compile(r"\s*([^\s\[\](]+)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?\s*")


def read_log(path: str | Path, plane: int, measure: Measure = "force") -> Log:
    """The log in a CSV file.

    Args:
        plane: 2 in the plane, 3 in space.
        measure: "displacement": there need be no wrenches, but displacements; else wrenches must be there,
            and displacements may.

    Raises:
        FileFormatError: the file cannot be read, is empty, has not the columns, or other units, or a cell is no finite
            number of a plausible size; with line, row and column. Or time runs backwards.
    """
    path = Path(path)
    lines = _lines(path)
    header = next(lines, None)
    if header is None:
        raise FileFormatError("the log is empty", source=path, expected=_expected(plane, measure))
    columns = _columns(header[1], path, header[0], plane, measure)
    blocks = [names if names[0] in columns else () for names in (_WRENCH[plane], _TWIST[plane])]
    wanted = ["t", *blocks[0], *blocks[1]]
    places = [columns.index(name) for name in wanted]
    rows, truths = [], []
    for row, (line, cells) in enumerate(_checked(lines, len(columns), path), start=1):
        rows.append([_number(cells[k], name, path, line, row) for k, name in zip(places, wanted, strict=True)])
        if _TRUTH in columns:
            truths.append(tuple(filter(None, map(str.strip, cells[columns.index(_TRUTH)].split(_AND)))))
    if not rows:
        raise FileFormatError("the log has a header and no rows", source=path, expected="a row for each sample")
    size = len(blocks[0])
    wrenches = [row[1 : 1 + size] for row in rows] if size else None
    twists = [row[1 + size :] for row in rows] if blocks[1] else None
    try:
        found = Log.of([row[0] for row in rows], wrenches, twists, truths or None)
    except InputError as error:
        raise FileFormatError(error.problem, source=path, found=error.found, expected=error.expected) from error
    return replace(found, unused=tuple(name for name in columns if name not in (*wanted, _TRUTH)))


def write_log(log: Log, path: str | Path) -> None:
    """A log as CSV, with all digits; twists and truth where it has them.

    Raises:
        FileFormatError: the file cannot be written.
    """
    plane = 2 if log.wrenches.shape[1] == len(_WRENCH[2]) else 3
    names = ["t", *_WRENCH[plane], *(_TWIST[plane] if log.twists is not None else ())]
    numbers = [log.times[:, None], log.wrenches, *([log.twists] if log.twists is not None else [])]
    rows: list[list[object]] = [list(row) for row in np.hstack(numbers).tolist()]
    if log.truth is not None:
        names.append(_TRUTH)
        rows = [[*row, f"{_AND} ".join(contacts)] for row, contacts in zip(rows, log.truth, strict=True)]
    text = "\n".join(",".join(map(str, row)) for row in [names, *rows])
    try:
        Path(path).write_text(text + "\n", encoding="utf-8")
    except OSError as cause:
        raise FileFormatError(f"the log cannot be written: {cause.strerror}", source=path) from cause


def _lines(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Line numbers and cells of the lines that say something."""
    try:
        text = read_bytes(path).decode("utf-8-sig")
    except UnicodeDecodeError as cause:
        raise FileFormatError("the log is no text in UTF-8", source=path) from cause
    reader = csv.reader(text.splitlines())
    try:
        for cells in reader:
            stripped = [cell.strip() for cell in cells]
            if any(stripped) and not stripped[0].startswith("#"):
                yield reader.line_num, stripped
    except csv.Error as cause:
        raise FileFormatError(f"the log is no CSV: {cause}", source=path, place=f"line {reader.line_num}") from cause


def _columns(headings: Sequence[str], path: Path, line: int, plane: int, measure: Measure) -> list[str]:
    place = f"line {line}"
    if len(headings) == 1 and (mark := next((mark for mark in ";\t|" if mark in headings[0]), None)):
        raise FileFormatError(f"cells are parted by {mark!r}", source=path, place=place, expected="commas")
    names = [_name(heading, path, place) for heading in headings]
    if twice := [name for name in dict.fromkeys(names) if names.count(name) > 1]:
        raise FileFormatError(f"the column {twice[0]!r} is there twice", source=path, place=place)
    needed = {_WRENCH[plane]: measure != "displacement", _TWIST[plane]: measure == "displacement"}
    # a block is whole, or not there
    blocks = [block for block, need in needed.items() if need or any(name in names for name in block)]
    missing = [name for name in ("t", *(name for block in blocks for name in block)) if name not in names]
    if missing:
        problem = f"the log has no column {', '.join(map(repr, missing))}"
        raise FileFormatError(problem, source=path, place=place, expected=_expected(plane, measure))
    return names


def _name(heading: str, path: Path, place: str) -> str:
    """The column's name; its unit, where one is given, must be the right one."""
    match = _HEADING.fullmatch(heading)
    name = match[1] if match else heading
    if match is None or name not in _ALL:
        raise FileFormatError(
            f"unknown column {heading!r:.60}", source=path, place=place, expected=f"some of {', '.join(_ALL)}"
        )
    units = _UNITS[name[0]] if name != _TRUTH else ()
    if match[2] is not None and match[2] not in units:
        raise FileFormatError(
            f"the column {name!r} is in another unit", source=path, place=place, found=match[2] or "no unit",
            expected=units[0] if units else "none",
        )  # fmt: skip
    return name


def _checked(lines: Iterator[tuple[int, list[str]]], count: int, path: Path) -> Iterator[tuple[int, list[str]]]:
    for row, (line, cells) in enumerate(lines, start=1):
        if len(cells) != count:
            problem = f"row {row} has {len(cells)} cells for {count} columns"
            raise FileFormatError(problem, source=path, place=f"line {line}")
        yield line, cells


def _number(cell: str, column: str, path: Path, line: int, row: int) -> float:
    place = f"line {line}, row {row}, column {column}"
    try:
        value = float(cell) if "_" not in cell else math.nan
    except ValueError as cause:
        raise FileFormatError("a number is missing", source=path, place=place, found=f"{cell!r:.60}") from cause
    if not abs(value) <= MOST_FORCE:
        wanted = f"a finite number up to {MOST_FORCE:g}"
        raise FileFormatError("not a usable number", source=path, place=place, found=f"{cell!r:.60}", expected=wanted)
    return value


def _expected(plane: int, measure: Measure) -> str:
    if measure == "displacement":
        return f"the columns t, {', '.join(_TWIST[plane])} and perhaps {', '.join(_WRENCH[plane])}"
    return f"the columns t, {', '.join(_WRENCH[plane])} and perhaps {', '.join(_TWIST[plane])}"
