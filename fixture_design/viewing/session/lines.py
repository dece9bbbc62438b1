"""What a session says beside the drawing, line by line: answers of every group, margins, what moves freely."""

from __future__ import annotations

from dataclasses import dataclass
from textwrap import wrap

from fixture_design.layout import (
    Answer,
    Element,
    Finding,
    LineTip,
    PadTip,
    PinTip,
    SoftTip,
    SphereTip,
    Tip,
    Verdict,
)
from fixture_design.viewing.palette import answer_sign
from fixture_design.viewing.words import evidence_in_words

#: Characters of a line that Meshcat's panel shows.
_WIDTH = 44

#: Characters that mean something to the JavaScript and the HTML that Meshcat makes of a name, and what stands for them.
_HARMLESS = str.maketrans({"'": "’", '"': "”", "`": "’", "\\": "∖", "<": "‹", ">": "›", "&": "+", "$": "＄"})


@dataclass(frozen=True)
class Line:
    """A line of text; ``story``: (group, claim) of the answer that it is about."""

    text: str
    story: tuple[str, str] | None = None


def harmless(text: str) -> str:
    """Text that a page may show as it stands: names come from files."""
    return "".join(c if c.isprintable() else "�" for c in text).translate(_HARMLESS)


def answer_line(group: str, claim: str, finding: Finding, required: bool) -> Line:
    """One answer: "✓ locators: deterministic: yes (0.5408)", with the margin; the sign is where it is required."""
    answer = "no contacts" if finding.answer is None else finding.answer.value
    margin = "" if finding.margin is None else f" ({finding.margin:.4g})"
    return Line(harmless(f"{answer_sign(finding.answer, required)} {group}: {claim}: {answer}{margin}"), (group, claim))


def answer_lines(verdict: Verdict) -> list[Line]:
    """Every answer of every group, what is required first; of groups with the same contacts the shared ones once,
    unless they are required.
    """
    required = {(each.group, each.require) for each in verdict.requirements}
    lines, told = [], dict[tuple[str, ...], str]()
    for group in verdict.groups.values():
        first = told.setdefault(group.contacts, group.name) == group.name
        for claim, finding in group.findings.items():
            if first or (group.name, claim) in required:
                lines.append(answer_line(group.name, claim, finding, (group.name, claim) in required))
    return sorted(lines, key=lambda line: line.story not in required)


def verdict_lines(verdict: Verdict, told: tuple[str, str] | None) -> list[Line]:
    """Whether all holds, the answers, and the evidence for the one that is told."""
    whole = {None: "nothing is required", Answer.YES: "all requirements hold"}
    lines = [Line(whole.get(verdict.satisfied, f"requirements: {verdict.satisfied and verdict.satisfied.value}"))]
    lines += answer_lines(verdict)
    if told is not None:
        group, claim = told
        finding = verdict.groups[group].findings[claim]
        words = evidence_in_words(claim, finding, verdict.reference, verdict.length)
        lines += wrapped(f"{group}: {claim}: {words}")
    return lines


def wrapped(text: str) -> list[Line]:
    """A longer text in lines that the panel has room for."""
    return [Line(harmless(piece)) for piece in wrap(text, _WIDTH)]


def element_line(element: Element | None) -> Line:
    """Who is chosen."""
    if element is None:
        return Line("no element is chosen")
    return Line(harmless(f"{element.name}: {element.role}, {tip_in_words(element.tip)}"))


def tip_in_words(tip: Tip) -> str:
    """A tip with its size."""
    match tip:
        case SphereTip():
            return f"ball of {tip.radius * 1e3:.4g} mm radius"
        case SoftTip():
            return f"soft tip of {tip.radius * 1e3:.4g} mm radius"
        case PadTip():
            return f"pad of {tip.width * 1e3:.4g} x {tip.height * 1e3:.4g} mm"
        case LineTip():
            return f"line of {tip.length * 1e3:.4g} mm"
        case PinTip():
            return f"pin of {tip.diameter * 1e3:.4g} mm"
    return "point"
