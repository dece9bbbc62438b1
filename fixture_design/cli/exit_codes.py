"""What the process tells its caller."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum

from fixture_design.layout import Answer


class ExitCode(IntEnum):
    """Exit codes of every command."""

    HOLDS = 0
    FAILS = 1
    BAD_INPUT = 2
    UNDECIDED = 3
    INTERNAL_ERROR = 4
    HUNG_UP = 129
    INTERRUPTED = 130
    BROKEN_PIPE = 141
    TERMINATED = 143


_WORST_FIRST = (
    ExitCode.INTERNAL_ERROR,
    ExitCode.BAD_INPUT,
    ExitCode.FAILS,
    ExitCode.UNDECIDED,
    ExitCode.HOLDS,
)


def of_answer(satisfied: Answer | None) -> ExitCode:
    """The code of one layout: 0 also where nothing is required."""
    return {Answer.NO: ExitCode.FAILS, Answer.UNDECIDED: ExitCode.UNDECIDED}.get(satisfied, ExitCode.HOLDS)  # type: ignore[arg-type]


def worst(codes: Iterable[ExitCode]) -> ExitCode:
    """The code of several inputs: 4 over 2 over 1 over 3 over 0."""
    present = set(codes)
    return next((code for code in _WORST_FIRST if code in present), ExitCode.HOLDS)
