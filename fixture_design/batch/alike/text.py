"""Records as texts with blanks: the writer of verdicts fills in marks once, and values go in their places afterwards.

So a record has the form that `io` gives it, whatever that is, at the cost of putting a few numbers between strings.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from fixture_design.batch.alike.plan import Plan
from fixture_design.batch.records import Detail, entry_of_record, verdict_record
from fixture_design.cones.kernel import NAME as KERNEL
from fixture_design.contacts import Contact
from fixture_design.io import dumps
from fixture_design.layout import Answer, Finding, GroupVerdict, RequirementVerdict, Verdict
from fixture_design.tolerances import DEFAULT
from fixture_design.verification.checker import sum_up
from fixture_design.version import VERSION

#: Whole parts of marks that are numbers: small enough to be a coefficient of friction.
_WHOLE = range(123, 1000)


class Marks:
    """Numbers that stand for values until these are known: `mark("motion", 6)` are six of them; and words for texts.

    They are none that the layout's own texts have: a contact may be called "123.000007" or "@source".
    """

    def __init__(self, texts: Iterable[str] = ()) -> None:
        """``texts``: all that the records repeat of the layout, such as names."""
        said = "\n".join(texts)
        self._whole = next(whole for whole in _WHOLE if f"{whole}." not in said)
        self._sign = "@"
        while self._sign in said:
            self._sign += "@"
        number = rf"{self._whole}\.(\d{{5}})7"
        word = rf"{self._sign}([a-z0-9 ]+)"
        #: Marks as they stand in a text.
        self.pattern = re.compile(rf'{number}|"{word}"|\[\["{word}", 0\]\]')
        self._meaning: list[tuple[str, int]] = []

    def __call__(self, name: str, count: int) -> list[float]:
        first = len(self._meaning)
        self._meaning += [(name, column) for column in range(count)]
        return [float(f"{self._whole}.{number:05d}7") for number in range(first, first + count)]

    def word(self, name: str) -> str:
        """Stands for a text."""
        return self._sign + name

    def meaning(self, number: int) -> tuple[str, int]:
        """The name and column that a mark stands for."""
        return self._meaning[number]


@dataclass(frozen=True, eq=False)
class RecordText:
    """The text of a record with its blanks.

    Attributes:
        between: a format with one %s for each blank.
        blanks: what goes into each: a column of the values as (name, column), or the name of a text.
        outcome: of the record.
    """

    between: str
    blanks: tuple[tuple[str, int] | str, ...]
    outcome: str


def record_text(
    plan: Plan, findings: Mapping[str, Mapping[str, Finding]], mark: Marks, detail: Detail, swept: bool
) -> RecordText:
    """The text of records whose groups have these findings, with marks in the place of numbers."""
    groups = {
        group.name: GroupVerdict(group.name, tuple(c.name for c in group.contacts), findings[group.name])
        for group in plan.groups
    }
    requirements = tuple(
        RequirementVerdict(group.name, require, groups[group.name].findings[require].answer)
        for group in plan.groups
        for require in group.require
    )
    notes = [
        f"{row.group}: {row.require} is required of a group without contacts: not satisfied"
        for row in requirements
        if row.answer is None
    ]
    plane = plan.points.shape[1]
    verdict = Verdict(
        name=mark.word("name"),
        source=mark.word("source"),
        space=plan.layout.space,
        satisfied=sum_up([requirement.answer for requirement in requirements]),
        groups=groups,
        contacts=() if detail == "brief" else tuple(_marked(plan.layout.contacts, mark)),
        requirements=requirements,
        notes=(*plan.notes, *notes),
        reference=np.array(mark("reference", plane)),
        length=mark("length", 1)[0],
        run={"version": VERSION, "kernel": KERNEL, "tolerances": DEFAULT.as_dict(), "input": mark.word("input")},
    )
    record = verdict_record(verdict, detail)
    run = record["run"]
    # these come last, as `records` has them
    last = ({"surface_gap": mark("surface gap", 1)[0]} if swept else {}) | {
        "input": mark.word("input"),
        "time": mark("time", 1)[0],
    }
    record["run"] = {key: value for key, value in run.items() if key != "input"} | last
    entry = entry_of_record(record)
    return _cut(dumps(record) + "\n", mark, entry.outcome)


def texts_of(plan: Plan) -> Iterator[str]:
    """Everything that records repeat of a layout's texts."""
    yield from (contact.name for contact in plan.layout.contacts)
    yield from (stage.name for stage in plan.layout.stages)
    yield from (group.name for group in plan.groups)
    yield from plan.notes


def _marked(contacts: tuple[Contact, ...], mark: Marks) -> list[Contact]:
    marked = []
    for index, contact in enumerate(contacts):
        plane = len(contact.point)
        point = np.array(mark(f"point {index}", plane))
        clauses, count = [], 0
        for clause in contact.clauses:
            clauses.append(tuple(np.array(mark(f"normal {index} {count + k}", plane)) for k in range(len(clause))))
            count += len(clause)
        friction = mark(f"friction {index}", 1)[0]
        given = replace(contact, point=point, clauses=tuple(clauses), friction=friction, slips=())
        if contact.distance is not None:
            given = replace(given, distance=mark(f"distance {index}", 1)[0])
        if contact.feature is not None:
            given = replace(given, feature=mark.word(f"feature {index}"))
        marked.append(given)
    return marked


def _cut(text: str, mark: Marks, outcome: str) -> RecordText:
    between, blanks, end = [], [], 0
    for found in mark.pattern.finditer(text):
        between.append(text[end : found.start()].replace("%", "%%"))
        number, word, basis = found.groups()
        blanks.append(mark.meaning(int(number)) if number is not None else word or basis)
        end = found.end()
    between.append(text[end:].replace("%", "%%"))
    return RecordText("%s".join(between), tuple(blanks), outcome)


def as_json(text: str) -> str:
    """A text in quotes."""
    return json.dumps(text, ensure_ascii=False)


def answer_of(number: int) -> Answer | None:
    """The answer that a number of `decide` stands for."""
    return {1: Answer.YES, 0: Answer.NO, -1: Answer.UNDECIDED}.get(number)
