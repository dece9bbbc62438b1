"""The sections of the sheet that say what was asked and answered, and on what terms."""

from __future__ import annotations

from fixture_design.errors import format_length
from fixture_design.layout import Layout, Verdict
from fixture_design.viewing.markup import Markup, answer_cell, bullets, table, tag
from fixture_design.viewing.words import evidence_in_words


def requirements(verdict: Verdict) -> Markup:
    """What is required of whom, and whether it holds."""
    if not verdict.requirements:
        return tag("p", "Nothing is required.")
    rows = []
    for requirement in verdict.requirements:
        finding = verdict.groups[requirement.group].findings.get(requirement.require)
        said = "" if finding is None else evidence_in_words(
            requirement.require, finding, verdict.reference, verdict.length
        )  # fmt: skip
        rows.append([requirement.group, _spaced(requirement.require), answer_cell(requirement.answer), said])
    return table(["group", "requirement", "answer", "why"], rows)


def questions(verdict: Verdict) -> Markup:
    """Every question asked of every group; groups with the same contacts once."""
    rows, told = [], dict[tuple[str, ...], str]()
    for group in verdict.groups.values():
        first = told.setdefault(group.contacts, group.name)
        who = ", ".join(group.contacts) or "no contacts"
        rows.append([tag("b", group.name), "", "", who if first == group.name else f"contacts as {first}: {who}"])
        for claim, finding in group.findings.items():
            margin = "" if finding.margin is None else f"{finding.margin + 0.0:.3g}"
            words = evidence_in_words(claim, finding, verdict.reference, verdict.length)
            rows.append([_spaced(claim), answer_cell(finding.answer), margin, words])
    return table(["question", "answer", "margin", "evidence"], rows)


def assumptions(layout: Layout, verdict: Verdict, weight: str) -> Markup:
    """What the verdict takes for granted."""
    part = layout.part
    said = [
        f"Friction {layout.friction:g} unless a contact says otherwise; what friction holds is what it can hold.",
        f"Elements are at most {format_length(layout.surface_gap)} off the surface.",
        weight,
        "Bodies are rigid; contacts are taken to first order.",
        "Clamps push with exactly their preload; clamps without one, supports and locators react.",
    ]
    if part is not None:
        form = "not given" if part.form_error is None else format_length(part.form_error)
        said.append(f"Form error of the surface: {form}.")
    untold = [e.name for e in layout.elements if e.role == "locator" and e.tolerance is None]
    if untold:
        said.append(f"No tolerance is given for {', '.join(untold)}: they count as exact.")
    tolerance = verdict.run.get("tolerances")
    said.append(f"Ties: {tolerance}.")
    return bullets(said)


def _spaced(word: str) -> str:
    return word.replace("_", " ")
