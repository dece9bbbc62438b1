"""Layouts of one structure, decided and written together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import isnan
from time import perf_counter

import numpy as np

from fixture_design.batch.alike.decide import OPEN, Numbers, decide, numbers_of
from fixture_design.batch.alike.evidence import evidence_of
from fixture_design.batch.alike.findings import MARGINS, basis_texts, brief_findings, full_findings
from fixture_design.batch.alike.plan import QUESTIONS, Plan
from fixture_design.batch.alike.text import Marks, RecordText, as_json, record_text, texts_of
from fixture_design.batch.digest import input_hash
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.records import TIME_DIGITS, Detail
from fixture_design.contacts import Scale


@dataclass(eq=False)
class Kind:
    """Layouts of one plan, and the texts of their records by their answers.

    Attributes:
        swept: whether they are variants that elements touch, whose `surface_gap` the records tell.
    """

    plan: Plan
    detail: Detail
    swept: bool = False
    texts: dict[bytes, RecordText] = field(default_factory=dict)

    @property
    def full(self) -> bool:
        return self.detail == "full"


@dataclass(eq=False)
class Pile:
    """Items of one kind: their places in the chunk, the layouts' names and numbers.

    Attributes:
        reports: the scales of the reports, where they are not those of the contacts.
        words, values: further texts and numbers of the records, by the names of their marks.
        inputs: their hashes, where they are known.  seconds: what was spent on each before.
    """

    places: list[int] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    numbers: list[list[int | float]] = field(default_factory=list)
    reports: list[Scale] = field(default_factory=list)
    words: list[dict[str, str]] = field(default_factory=list)
    values: list[dict[str, float]] = field(default_factory=list)
    inputs: list[str] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)


@dataclass(eq=False)
class _Table:
    """What is known of the layouts of a pile: ``keys`` tell which have the same text but for their values.

    Attributes:
        keys: shape (n, k).  good: shape (n,).  values: by name, shape (n, j).  bases: by group, shape (n, d).
        margins: shape (n,), the smallest one that is required; NaN for none.
    """

    keys: np.ndarray
    good: np.ndarray
    values: dict[str, np.ndarray]
    bases: dict[int, np.ndarray]
    margins: np.ndarray


def entries_of(kind: Kind, pile: Pile, items: Sequence[Item]) -> list[tuple[int, Entry]]:
    """The entries of those of a pile that are decided here, by their places in the chunk."""
    start = perf_counter()
    try:
        given = np.array(pile.numbers, dtype=np.float64)
    except OverflowError:  # a whole number that no float holds
        return []
    table = _table(kind, numbers_of(kind.plan, given, pile.reports))
    for name in pile.values[0] if pile.values else ():
        table.values[name] = np.array([[values[name]] for values in pile.values])
    each = (perf_counter() - start) / max(int(table.good.sum()), 1)
    seconds = np.array(pile.seconds) if pile.seconds else np.zeros(len(given))
    table.values["time"] = np.round(seconds + each, TIME_DIGITS)[:, None]
    by_key: dict[bytes, list[int]] = {}
    for row in np.flatnonzero(table.good).tolist():
        by_key.setdefault(table.keys[row].tobytes(), []).append(row)
    found: list[tuple[int, Entry]] = []
    for key, rows in by_key.items():
        if key not in kind.texts:
            kind.texts[key] = _text(kind, table.keys[rows[0]].tolist())
        found += _filled(kind, key, rows, pile, items, table)
    return found


def _table(kind: Kind, numbers: Numbers) -> _Table:
    plan, count = kind.plan, len(numbers.points)
    values = {"reference": numbers.reference + 0.0, "length": numbers.length[:, None]}
    keys, bases, good = [], {}, numbers.fit.copy()
    if kind.full:
        values |= _contact_values(plan, numbers)
        good &= ~(numbers.frictions > 0).any(axis=1)
    for index, group in enumerate(plan.plans):
        decided = decide(plan, group, numbers, witnesses=kind.full)
        good &= (decided.answers != OPEN).all(axis=1)
        ranks = np.zeros((count, 1))
        if kind.full and len(group.contacts):
            with np.errstate(all="ignore"):
                evidence = evidence_of(group, numbers, decided)
            values |= {f"{index} {name}": value for name, value in evidence.values.items()}
            good &= evidence.good
            ranks, bases[index] = evidence.ranks[:, None], evidence.bases
        keys.append(np.concatenate([decided.answers, ranks], axis=1))
    return _Table(np.concatenate(keys, axis=1).astype(np.int8), good, values, bases, _margins(plan, values, count))


def _contact_values(plan: Plan, numbers: Numbers) -> dict[str, np.ndarray]:
    """What full records repeat of the contacts."""
    values = {}
    normal = 0
    for index, contact in enumerate(plan.layout.contacts):
        values[f"point {index}"] = numbers.points[:, index] + 0.0
        values[f"friction {index}"] = numbers.frictions[:, index, None] + 0.0
        for k in range(len(contact.normals)):
            values[f"normal {index} {k}"] = numbers.given_normals[:, normal] + 0.0
            normal += 1
    return values


def _margins(plan: Plan, values: dict[str, np.ndarray], count: int) -> np.ndarray:
    """The smallest margin that is required of each layout; NaN where there is none."""
    index_of = {name: index for index, group in enumerate(plan.plans) for name in group.names}
    named = {
        f"{index_of[group.name]} {MARGINS[require]}" for group in plan.groups for require in group.require
    } & values.keys()
    if not named:
        return np.full(count, np.nan)
    return np.concatenate([values[name] for name in sorted(named)], axis=1).min(axis=1)


def _text(kind: Kind, key: list[int]) -> RecordText:
    """The text of all records with these answers and ranks."""
    plan, mark, width = kind.plan, Marks(texts_of(kind.plan)), len(QUESTIONS) + 1
    findings = {}
    for index, group in enumerate(plan.plans):
        *answers, rank = key[index * width : (index + 1) * width]
        each = full_findings(plan, index, answers, rank, mark) if kind.full else brief_findings(answers)
        findings |= dict.fromkeys(group.names, each)
    return record_text(plan, findings, mark, kind.detail, kind.swept)


def _filled(
    kind: Kind, key: bytes, rows: list[int], pile: Pile, items: Sequence[Item], table: _Table
) -> list[tuple[int, Entry]]:
    """Entries of the layouts with one text."""
    text = kind.texts[key]
    slots = [blank for blank in text.blanks if isinstance(blank, tuple)]
    columns = np.stack([table.values[name][rows, column] for name, column in slots], axis=1).tolist()
    places = {index: basis_texts(kind.plan, kind.plan.plans[index]) for index in table.bases}
    found = []
    for row, numbers in zip(rows, columns, strict=True):
        item = items[pile.places[row]]
        words = (pile.words[row] if pile.words else {}) | {
            "name": as_json(pile.names[row]),
            "source": as_json(item.source),
            "input": f'"{pile.inputs[row] if pile.inputs else input_hash(item)}"',
        }
        for index, texts in places.items():
            words[f"{index} basis"] = "[" + ", ".join([texts[k] for k in table.bases[index][row].tolist()]) + "]"
        given = map(repr, numbers)
        line = text.between % tuple([words[blank] if isinstance(blank, str) else next(given) for blank in text.blanks])
        margin = float(table.margins[row])
        found.append(
            (
                pile.places[row],
                Entry(line.encode("utf-8", errors="backslashreplace"), text.outcome, None if isnan(margin) else margin),
            )
        )
    return found
