"""How a record came out, in one word, and by how much."""

from __future__ import annotations

from functools import cache
from typing import Any

from fixture_design.errors import InputError

#: Outcomes of one layout, the worst first; "nothing required" is satisfied as "yes" is.
OUTCOMES = ("internal error", "bad input", "no", "undecided", "nothing required", "yes")
#: The requirement whose margin may be 0 where all is well.
_SLIDES = ": loadable"
#: Outcomes of layouts that have no verdict.
FAILURES = frozenset({"internal error", "bad input"})


def outcome_of(record: dict[str, Any]) -> str:
    """One of OUTCOMES."""
    if "error" in record:
        return "bad input" if record["error"].get("kind") in _input_errors() else "internal error"
    return record.get("satisfied") or "nothing required"


def smallest_margin(record: dict[str, Any]) -> float | None:
    """The smallest margin of the findings that are required; None where none is known.

    That of a straight way out does not count where there is one: it is 0 where the part slides along locators, which is
    as good as leaving them.
    """
    margins = [m for what, m in required_margins(record) if m is not None and not (what.endswith(_SLIDES) and m >= 0)]
    return min(margins, default=None)


def required_margins(record: dict[str, Any]) -> list[tuple[str, float | None]]:
    """ "all: form closure" with its margin, for everything that is required."""
    groups = record.get("groups", {})
    found = []
    for row in record.get("requirements", []):
        finding = groups.get(row["group"], {}).get(row["require"]) or {}
        found.append((f"{row['group']}: {row['require'].replace('_', ' ')}", finding.get("margin")))
    return found


@cache
def _input_errors() -> frozenset[str]:
    """Names of all exceptions that say that the input is at fault."""

    def below(kind: type) -> set[str]:
        return {kind.__name__, *(name for sub in kind.__subclasses__() for name in below(sub))}

    return frozenset(below(InputError))
