"""From items to the lines of the output: verdicts, or what went wrong."""

from __future__ import annotations

import json
from collections.abc import Callable
from time import perf_counter
from typing import Any, Literal, NamedTuple, TypeVar

from fixture_design.batch.digest import input_hash, text_hash
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.outcome import outcome_of, smallest_margin
from fixture_design.batch.part_cache import PartCache
from fixture_design.batch.reading import layout_of, values_of
from fixture_design.errors import FixtureDesignError, InputError
from fixture_design.io import dumps, error_record, verdict_to_dict
from fixture_design.layout import Layout, Verdict
from fixture_design.verification import contacts_of, verify
from fixture_design.verification.found import FoundContacts
from fixture_design.version import VERSION

Record = dict[str, Any]
T = TypeVar("T")
#: How much a record says: answers alone; with witnesses, margins and contacts; with the admissible sets as well.
Detail = Literal["brief", "full", "sets"]

#: Digits of seconds in `run.time`: microseconds.
TIME_DIGITS = 6


class WorkerError(FixtureDesignError):
    """The process that looked at a layout died."""


class TimeLimitError(FixtureDesignError):
    """A layout took longer than it was given."""


class Looked(NamedTuple):
    """A layout whose contacts are known; ``input``: its hash; ``seconds``: what that took."""

    item: Item
    layout: Layout
    found: FoundContacts
    input: str
    seconds: float


def entry_of(item: Item, parts: PartCache, detail: Detail) -> Entry:
    """The record of one layout; an error is a record too."""
    looked = look_at(item, parts)
    return looked if isinstance(looked, Entry) else entry_of_looked(looked, parts, detail)


def look_at(item: Item, parts: PartCache) -> Looked | Entry:
    """A layout with its contacts; the record of the error where it has none."""
    return _or_failure(item, lambda placed: _looked(item, parts, placed))


def entry_of_looked(looked: Looked, parts: PartCache, detail: Detail) -> Entry:
    """The record of one layout whose contacts are known, by `verify`."""

    def entry(placed: bool) -> Entry:
        return _entry(_looked(looked.item, parts, True) if placed else looked, detail)

    return _or_failure(looked.item, entry)


def _or_failure(item: Item, work: Callable[[bool], T]) -> T | Entry:
    """What ``work`` gives; the record of its error. It is told whether places in the text are wanted, for a message."""
    try:
        try:
            return work(False)
        except InputError:
            return work(True)
    except InputError as error:
        return failure(item, error.within(item.source))
    except Exception as error:  # noqa: BLE001 - a fault of ours in one layout must not cost the others' verdicts
        return failure(item, error)


def _looked(item: Item, parts: PartCache, placed: bool) -> Looked:
    start = perf_counter()
    layout = layout_of(item, placed=placed)
    found = contacts_of(layout, parts.geometry_of(layout))
    digest = input_hash(item)
    return Looked(item, layout, found, digest, perf_counter() - start)


def _entry(looked: Looked, detail: Detail) -> Entry:
    start, (item, layout, found, digest, seconds) = perf_counter(), looked
    record = verdict_record(verify(layout, found=found, sets=detail == "sets"), detail)
    if item.variant is not None and layout.elements:
        record["run"] |= {"surface_gap": layout.surface_gap}
    seconds += perf_counter() - start
    record["run"] |= {"input": digest, "time": round(seconds, TIME_DIGITS)}
    return entry_of_record(record)


def verdict_record(verdict: Verdict, detail: Detail) -> Record:
    """A verdict as `io` writes it; what was not looked for is null or not there."""
    record: Record = verdict_to_dict(verdict, detail == "brief")
    if detail == "full":
        for group in record["groups"].values():
            del group["bidirectional"]
    return record


def detail_of(record: Record) -> Detail:
    """How much a record says."""
    if "contacts" not in record:
        return "brief"
    return "sets" if any("bidirectional" in group for group in record["groups"].values()) else "full"


def failure(item: Item, error: Exception) -> Entry:
    """The record of a layout that has no verdict; it too says what exactly it is about."""
    name = values_of(item).get("name")
    known = name if isinstance(name, str) and name else item.default_name
    record = error_record(item.source, error, item.named(known))
    return entry_of_record(record | {"run": {"version": VERSION, "input": input_hash(item)}})


def given_up(item: Item, error: Exception) -> Entry:
    """Likewise of a layout that nobody may read again, since that takes too long or kills: its text is hashed alone."""
    record = error_record(item.source, error, item.named(item.default_name))
    return entry_of_record(record | {"run": {"version": VERSION, "input": text_hash(item)}})


def was_given_up(record: Record) -> bool:
    """Whether a record is one of `given_up`."""
    return record.get("error", {}).get("kind") in {WorkerError.__name__, TimeLimitError.__name__}


def entry_of_record(record: Record) -> Entry:
    """A record as it stands in the output, with what the summary wants to know of it."""
    line = dumps(record).encode("utf-8", errors="backslashreplace") + b"\n"
    return Entry(line, outcome_of(record), smallest_margin(record))


def record_of(line: bytes) -> Record:
    """What a line of the output says.

    Raises:
        ValueError: it is no JSON object.
    """
    record = json.loads(line)
    if not isinstance(record, dict):
        raise ValueError("the line is no JSON object")
    return record
