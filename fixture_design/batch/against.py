"""The same library against an earlier run: what changed its verdict, what lost margin, what is new or gone."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import zip_longest
from pathlib import Path
from typing import Any

from fixture_design.batch.outcome import OUTCOMES, outcome_of, required_margins
from fixture_design.batch.records import Record, detail_of
from fixture_design.batch.results import key_of, records_in
from fixture_design.errors import FileFormatError
from fixture_design.tolerances import DEFAULT

#: Margins that are smaller by this part of what they were, and by more than ties are apart, are said to be lost [-]:
#: less is rounding, or nobody's worry.
LOST = 0.01


@dataclass(frozen=True)
class Change:
    """One layout that is not what it was.

    Attributes:
        what: "verdict", or the requirement whose margin was lost.
        before, after: outcomes or margins.
    """

    name: str
    source: str
    what: str
    before: str | float
    after: str | float


@dataclass
class Comparison:
    """Everything that differs between two runs of a library.

    Attributes:
        changed: layouts of another outcome, what became worse first.  lost: margins, the largest loss first.
        new, gone: names of the layouts that only one of them has.  same: how many layouts are in both.
        unlike: how many of these have margins in only one of the runs, which was brief: they cannot be compared.
    """

    changed: list[Change] = field(default_factory=list)
    lost: list[Change] = field(default_factory=list)
    new: list[str] = field(default_factory=list)
    gone: list[str] = field(default_factory=list)
    same: int = 0
    unlike: int = 0

    def add(self, now: _Known, was: _Known) -> None:
        """A layout that is in both."""
        self.same += 1
        if now.outcome != was.outcome:
            self.changed.append(Change(now.name, now.source, "verdict", was.outcome, now.outcome))
        self.unlike += None not in (now.brief, was.brief) and now.brief != was.brief
        self.lost += _losses(now, was.margins)

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        lists = {key: [vars(change) for change in getattr(self, key)] for key in ("changed", "lost")}
        return {**lists, "new": self.new, "gone": self.gone, "same": self.same, "unlike": self.unlike}


@dataclass(frozen=True)
class _Known:
    """What is compared of one layout."""

    source: str
    name: str
    outcome: str
    margins: tuple[tuple[str, float | None], ...]
    brief: bool | None

    @classmethod
    def of(cls, record: Record) -> _Known:
        source, name = key_of(record)
        brief = None if "error" in record else detail_of(record) == "brief"
        return cls(source, name, outcome_of(record), tuple(required_margins(record)), brief)


class _Waiting:
    """Layouts of one of the outputs that were not met in the other one yet, in order."""

    def __init__(self) -> None:
        self._by_key: dict[tuple[str, str], deque[_Known]] = {}

    def put(self, known: _Known) -> None:
        self._by_key.setdefault((known.source, known.name), deque()).append(known)

    def take(self, like: _Known) -> _Known | None:
        """The first one of this source and name."""
        key = like.source, like.name
        if key not in self._by_key:
            return None
        found = self._by_key[key].popleft()
        if not self._by_key[key]:
            del self._by_key[key]
        return found

    def all(self) -> list[_Known]:
        return [known for some in self._by_key.values() for known in some]


def losses_in_words(found: Comparison) -> str:
    """ "3 margins were lost"; where one of the runs was brief, that nobody knows."""
    lost = f"{len(found.lost)} margin{' was' if len(found.lost) == 1 else 's were'} lost"
    if not found.unlike:
        return lost
    which = "all" if found.unlike == found.same else str(found.unlike)
    return f"{lost}, not compared for {which}, since one of the runs was brief"


def compare(new: Path, old: Path) -> Comparison:
    """What the output ``new`` says otherwise than the output ``old``.

    Both are read side by side: what waits to be met again is few where the library kept its order.

    Raises:
        FileFormatError: a file cannot be read, or they have no layout in common.
    """
    found, later, earlier = Comparison(), _Waiting(), _Waiting()
    for record, was in zip_longest(records_in(new), records_in(old)):
        if was is not None:
            known = _Known.of(was)
            if (now := later.take(known)) is not None:
                found.add(now, known)
            else:
                earlier.put(known)
        if record is not None:
            known = _Known.of(record)
            if (before := earlier.take(known)) is not None:
                found.add(known, before)
            else:
                later.put(known)
    _meet_moved(found, later.all(), earlier.all())
    if not found.same and (found.new or found.gone):
        raise FileFormatError(
            "no layout of this batch is among these records, by source or name", source=old,
            expected="the output of an earlier batch of the same library",
        )  # fmt: skip
    found.changed.sort(key=lambda change: OUTCOMES.index(str(change.after)) - OUTCOMES.index(str(change.before)))
    found.lost.sort(key=lambda change: float(change.after) - float(change.before))
    return found


def _meet_moved(found: Comparison, new: list[_Known], old: list[_Known]) -> None:
    """A library may have moved, and a broken layout has lost its name: one of the two tells where only one has it."""
    for key in ("name", "source"):
        mine, theirs = _by(new, key), _by(old, key)
        pairs = [(mine[word][0], theirs[word][0]) for word in mine if len(mine[word]) == len(theirs.get(word, ())) == 1]
        for one, other in pairs:
            found.add(one, other)
        met = {id(known) for pair in pairs for known in pair}
        new, old = ([known for known in some if id(known) not in met] for some in (new, old))
    found.new += [known.name for known in new]
    found.gone += [known.name for known in old]


def _by(some: Iterable[_Known], key: str) -> dict[str, list[_Known]]:
    found: dict[str, list[_Known]] = {}
    for known in some:
        found.setdefault(getattr(known, key), []).append(known)
    return found


def _losses(known: _Known, before: Iterable[tuple[str, float | None]]) -> Iterator[Change]:
    were = dict(before)
    for what, margin in known.margins:
        was = were.get(what)
        if was is not None and margin is not None and was - margin > max(LOST * abs(was), DEFAULT.tie):
            yield Change(known.name, known.source, what, was, margin)
