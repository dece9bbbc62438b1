"""The contacts of a layout as a table that spreadsheets read."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from fixture_design.contacts import unit_normal
from fixture_design.io.text_file import write_text
from fixture_design.layout import Verdict

_AXES = ("x", "y", "z")


def write_csv(verdict: Verdict, path: str | Path) -> None:
    """Writes a line a normal: contact, role, point in W [m], the part's outward unit normal, what is touched.

    Raises:
        FileFormatError: the file cannot be written.
    """
    write_text(Path(path), csv_text(verdict))


def csv_text(verdict: Verdict) -> str:
    """The table's text; contacts with several normals have a line for each."""
    axes = _AXES[: len(verdict.reference)]
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(["name", "role", *axes, *(f"n{axis}" for axis in axes), "feature"])
    for contact in verdict.contacts:
        for normal in contact.normals:
            numbers = [repr(float(x)) for x in (*contact.point, *unit_normal(normal))]
            writer.writerow([contact.name, contact.role, *numbers, contact.feature or ""])
    return table.getvalue()
