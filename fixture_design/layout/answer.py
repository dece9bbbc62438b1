"""Yes, no, or undecided."""

from __future__ import annotations

from enum import StrEnum


class Answer(StrEnum):
    """An answer; undecided is one of its own and never rounded."""

    YES = "yes"
    NO = "no"
    UNDECIDED = "undecided"

    @classmethod
    def of(cls, truth: bool | None) -> Answer:
        """True, False, or None for undecided."""
        return cls.UNDECIDED if truth is None else cls.YES if truth else cls.NO

    def negated(self) -> Answer:
        return {Answer.YES: Answer.NO, Answer.NO: Answer.YES}.get(self, self)
