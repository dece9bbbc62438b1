"""The verdict in a few words."""

from __future__ import annotations

from fixture_design.layout import Answer

SUMMARY: dict[Answer | None, str] = {
    Answer.YES: "all requirements hold",
    Answer.NO: "requirements fail",
    Answer.UNDECIDED: "requirements undecided",
    None: "nothing is required",
}
