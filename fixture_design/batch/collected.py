"""What the page tells of all records, from one look at each: memory must not grow with the file."""

from __future__ import annotations

import heapq
from array import array
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from fixture_design.batch.outcome import OUTCOMES, outcome_of, required_margins, smallest_margin
from fixture_design.batch.records import Record
from fixture_design.batch.worst import Worst

#: Rows of a table: more make a page slow, and the worst come first.
MOST_ROWS = 2000


@dataclass(frozen=True)
class Row:
    """One record in a table."""

    number: int
    name: str
    source: str | None
    outcome: str
    margin: float | None
    why: str
    seconds: float | None


@dataclass
class Collected:
    """Attributes:
    rows: of the worst records, the worst first.  worst: those that are drawn.
    margins: of everything that is required, by its name: eight bytes each.
    errors: how many of each kind.
    """

    rows: list[Row] = field(default_factory=list)
    worst: Worst = field(default_factory=Worst)
    margins: dict[str, array[float]] = field(default_factory=dict)
    errors: Counter[str] = field(default_factory=Counter)


def collected(records: Iterable[Record]) -> Collected:
    """Everything that is told of some records."""
    found = Collected()
    found.rows = [row for _, row in heapq.nsmallest(MOST_ROWS, _looked_through(records, found))]
    return found


def _looked_through(records: Iterable[Record], found: Collected) -> Iterator[tuple[tuple[int, float, int], Row]]:
    """Each record's row, with how bad it is: no two are equally bad. On the way all else is noted."""
    for number, record in enumerate(records):
        outcome, margin = outcome_of(record), smallest_margin(record)
        if "error" in record:
            found.errors[record["error"]["kind"]] += 1
        found.worst.add(number, record.get("source"), outcome, margin)
        for what, known in required_margins(record):
            if known is not None:
                found.margins.setdefault(what, array("d")).append(known)
        bad = OUTCOMES.index(outcome), float("inf") if margin is None else margin, number
        seconds = record.get("run", {}).get("time")
        yield bad, Row(number, record["name"], record.get("source"), outcome, margin, _why(record), seconds)


def _why(record: Record) -> str:
    """What is open, or what went wrong."""
    if "error" in record:
        return f"{record['error']['kind']}: {record['error']['message']}"
    rows = [row for row in record.get("requirements", []) if row["verdict"] != "yes"]
    return ", ".join(
        f"{row['group']}: {row['require'].replace('_', ' ')} {row['verdict'] or 'no contacts'}" for row in rows
    )
