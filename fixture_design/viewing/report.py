"""A sheet to sign: one HTML file with everything a verdict rests on, readable without this program or a network."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from fixture_design.arrays import Ends
from fixture_design.io.outputs import refuse_inputs
from fixture_design.io.text_file import write_text
from fixture_design.layout import Layout, Verdict
from fixture_design.viewing.element_table import elements
from fixture_design.viewing.force_tables import error_budget, forces
from fixture_design.viewing.markup import Markup, answer_cell, joined, table, tag
from fixture_design.viewing.part_drawing import PartDrawing, drawing_of
from fixture_design.viewing.sheet import assumptions, questions, requirements
from fixture_design.viewing.three_views import three_views

_STYLE = """
body { font: 14px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 64rem; padding: 0 1rem; color: #222; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.15rem; border-bottom: 1px solid #ccc; margin-top: 2rem; }
h3 { font-size: 1rem; } table { border-collapse: collapse; width: 100%; margin: .5rem 0; }
th, td { text-align: left; vertical-align: top; padding: .2rem .6rem; border-bottom: 1px solid #e4e4e4; }
th { background: #f4f4f4; font-weight: 600; } .answer { font-weight: 600; } .yes { color: #1a7f37; }
.no { color: #b42318; }
.undecided { color: #9a6700; } .numbers td { font-variant-numeric: tabular-nums; }
.views { display: flex; flex-wrap: wrap; }
figure { margin: .5rem; } figcaption { text-align: center; color: #666; }
code { font-size: 12px; word-break: break-all; }
.sign td { height: 3rem; } article { page-break-after: always; }
@page { size: A4; margin: 12mm; } @media print { body { margin: 0; font-size: 11px; max-width: none; } }
"""


def write_report(pairs: Sequence[tuple[Layout, Verdict]], path: Path, now: datetime | None = None) -> None:
    """Write the sheets of some layouts, one after the other, as one HTML file.

    Args:
        path: replaced at once; it may be none of the files that the layouts are made of.
        now: what the sheet says it was made at; by default the time it is.

    Raises:
        FileFormatError: the file cannot be written, or is an input.
    """
    drawings = [drawing_of(layout) for layout, _ in pairs]
    refuse_inputs(path, [file.file for drawing in drawings for file in drawing.files])
    when = (now or datetime.now(UTC)).strftime("%Y-%m-%d %H:%M UTC")
    sheets = [
        _sheet(layout, verdict, drawing, when) for (layout, verdict), drawing in zip(pairs, drawings, strict=True)
    ]
    title = pairs[0][1].name if len(pairs) == 1 else f"{len(pairs)} layouts"
    head = tag("head", Markup('<meta charset="utf-8">'), tag("title", f"{title}: fixture verdict"), _style())
    write_text(path, "<!DOCTYPE html>\n" + tag("html", head, tag("body", *sheets), lang="en") + "\n")


def _style() -> Markup:
    return tag("style", Markup(_STYLE))


def _sheet(layout: Layout, verdict: Verdict, drawing: PartDrawing, when: str) -> Markup:
    sections = [
        ("Required", requirements(verdict)),
        ("Drawing", three_views(_segments(layout, drawing), verdict.contacts)),
        ("Elements", elements(layout, verdict)),
        ("Locating error", error_budget(verdict)),
        ("Forces", forces(verdict)),
        ("All questions", questions(verdict)),
        ("Assumptions", assumptions(layout, verdict, drawing.weight)),
        ("Notes", joined(tag("p", note) for note in verdict.notes) if verdict.notes else None),
        ("Inputs and versions", _inputs(verdict, drawing)),
        ("Signed", table(["checked by", "date", "signature"], [["", "", ""]], class_="sign")),
    ]
    parts = [joined([tag("h2", heading), content]) for heading, content in sections if content is not None]
    summary = tag("p", answer_cell(verdict.satisfied), f" {_summary(verdict)}")
    return tag("article", tag("h1", verdict.name), tag("p", f"{verdict.space}, {when}"), summary, *parts)


def _summary(verdict: Verdict) -> str:
    if verdict.satisfied is None:
        return "(nothing is required)"
    failing = [f"{r.group}: {r.require.replace('_', ' ')}" for r in verdict.requirements if r.answer != "yes"]
    return "all requirements hold" if not failing else "open: " + ", ".join(failing)


def _segments(layout: Layout, drawing: PartDrawing) -> Ends:
    dimension = 2 if layout.space == "planar" else 3
    return drawing.segments if drawing.segments is not None else np.zeros((0, 2, dimension))


def _inputs(verdict: Verdict, drawing: PartDrawing) -> Markup:
    files = table(
        ["input", "file", "SHA-256"],
        [[f.role, f.file.name, tag("code", f.sha256 or "not there")] for f in drawing.files],
    )
    versions = [[key, str(value)] for key, value in verdict.run.items()]
    return joined([files, table(["", ""], [*versions, ["drake", drawing.drake]])])
