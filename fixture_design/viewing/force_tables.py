"""The sections of the sheet about errors and forces; None where nobody asked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isinf

import numpy as np

from fixture_design.layout import (
    Balance,
    LoadsHeld,
    LoadVerdict,
    LocatingErrors,
    Seating,
    Unbalanced,
    UseEvidence,
    Verdict,
    severity,
)
from fixture_design.viewing.markup import Markup, answer_cell, joined, table, tag
from fixture_design.viewing.motion_words import motion_in_words
from fixture_design.viewing.number_text import numbers_text
from fixture_design.viewing.use_words import load_in_words, reserve_in_words, rocking_in_words

#: Points of a load path that are listed; the rest is counted.
_ROWS_SHOWN = 12

#: Bounds of a reaction that differ by less are written as one number [-].
_EQUAL = 1e-3


def used(verdict: Verdict) -> Iterator[tuple[str, UseEvidence]]:
    """The evidence of what the fixture does, of all groups, with the group's name."""
    for group in verdict.groups.values():
        for finding in group.findings.values():
            if finding.use is not None:
                yield group.name, finding.use


def error_budget(verdict: Verdict) -> Markup | None:
    """Each element's share of the error of each key feature [um]; None where it was not asked for."""
    parts: list[Markup] = []
    for group, use in used(verdict):
        if not isinstance(use, LocatingErrors):
            continue
        names = list(dict.fromkeys(name for feature in use.features for name in feature.shares))
        rows = [
            [feature.feature, _um(feature.tolerance), _um(feature.worst), _um(feature.rss)]
            + [_um(feature.shares.get(name, 0.0)) for name in names]
            for feature in use.features
        ]
        parts.append(tag("h3", group))
        if rows:
            parts.append(table(["feature", "allowed", "worst", "root sum square", *names], rows, class_="numbers"))
        parts += [tag("p", rocking_in_words(rocking) + ".") for rocking in use.rockings]
    return joined([*parts, tag("p", "In micrometres.")]) if parts else None


def forces(verdict: Verdict) -> Markup | None:
    """Seating step by step, and every load; None where neither was asked for."""
    parts: list[Markup] = []
    for group, use in used(verdict):
        if isinstance(use, Seating):
            rows = [
                [step.clamp or "gravity alone", answer_cell(step.answer), _reactions(step.reactions), step.cause or ""]
                for step in use.steps
            ]
            parts += [tag("h3", f"{group}: seating"), table(["closed", "seated", "reactions [N]", ""], rows)]
        if isinstance(use, LoadsHeld):
            parts += [tag("h3", f"{group}: loads"), _load_table(use), _certificates(use, verdict)]
    return joined(parts) if parts else None


def _load_table(use: LoadsHeld) -> Markup:
    rows = [
        [load.load, load.row or "", answer_cell(load.answer), reserve_in_words(load)]
        for load in _shown(use.loads)
    ]  # fmt: skip
    hidden = len(use.loads) - len(rows)
    said = [f"{hidden} more points of load paths have a larger reserve."] if hidden else []
    said += [f"Reactions are {'' if use.determinate else 'not '}determined by statics alone."]
    if use.least_preloads is not None:
        least = ", ".join(f"{name} {value:.4g} N" for name, value in use.least_preloads.items())
        said.append(f"Least preloads that hold everything: {least}.")
    return joined([table(["load", "row", "held", "factor"], rows), *(tag("p", text) for text in said)])


def _shown(loads: Sequence[LoadVerdict]) -> list[LoadVerdict]:
    """Those with the least reserve, in file order."""
    ranked = sorted(range(len(loads)), key=lambda k: severity(loads[k]))
    return [loads[k] for k in sorted(ranked[:_ROWS_SHOWN])]


def _certificates(use: LoadsHeld, verdict: Verdict) -> Markup:
    """The worst load's proof in numbers: forces that balance it, or the motion that nothing resists."""
    worst = use.loads[use.worst]
    lead = tag("p", load_in_words(worst, verdict.reference, verdict.length) + ".")
    if isinstance(worst.proof, Balance):
        rows = [
            [name, numbers_text(force.forces.sum(axis=0)), f"{np.linalg.norm(force.forces.sum(axis=0)):.4g}"]
            for name, force in worst.proof.forces.items()
        ]
        return joined([lead, table(["contact", "force on the part [N]", "size [N]"], rows, class_="numbers")])
    if isinstance(worst.proof, Unbalanced):
        moves = motion_in_words(worst.proof.motion, verdict.reference, verdict.length)
        text = f"Certificate: the load drives the part {moves}; motion {numbers_text(worst.proof.motion)}, "
        return joined([lead, tag("p", f"{text}surplus of work {worst.proof.surplus:.4g} J a unit of motion.")])
    return lead


def _reactions(reactions: Mapping[str, tuple[float, float]]) -> str:
    return ", ".join(f"{name} {_bracket(bounds)}" for name, bounds in reactions.items())


def _bracket(bounds: tuple[float, float]) -> str:
    low, high = bounds
    if isinf(high):
        return f"{low:.3g} or more"
    return f"{low:.3g}" if high - low <= _EQUAL * abs(high) else f"{low:.3g}..{high:.3g}"


def _um(value: float) -> str:
    return "unlimited" if isinf(value) else f"{value * 1e6:.3g}"
