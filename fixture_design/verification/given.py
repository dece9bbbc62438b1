"""Whether the evidence about forces and errors is about what the layout says: its weight, loads, preloads, features."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fixture_design.analysis.acting import preloads_of
from fixture_design.contacts import scale_of
from fixture_design.layout import (
    Group,
    GroupVerdict,
    Layout,
    LoadsHeld,
    LocatingErrors,
    Seating,
    Verdict,
    groups_of,
)
from fixture_design.tolerances import WITNESS
from fixture_design.verification.force_questions import acting_weight
from fixture_design.verification.found import FoundContacts
from fixture_design.verification.load_paths import load_rows


def given_faults(verdict: Verdict, layout: Layout) -> list[str]:
    """Everything in a verdict's evidence that is not as the layout has it.

    Raises:
        InputError: a file of the layout cannot be read (any more).
    """
    groups = {group.name: group for group in groups_of(layout, verdict.contacts)}
    if {*groups} != {*verdict.groups}:
        return [f"the layout has the groups {', '.join(groups)}, the verdict {', '.join(verdict.groups)}"]
    return [
        f"{name}: {fault}" for name, found in verdict.groups.items() for fault in _faults(layout, groups[name], found)
    ]


def _faults(layout: Layout, group: Group, verdict: GroupVerdict) -> Iterator[str]:
    for claim in group.require:
        if claim not in verdict.findings:
            yield f"{claim} is required, and there is no finding"
    for claim, finding in verdict.findings.items():
        if isinstance(finding.use, LoadsHeld | Seating):
            yield from (f"{claim}: {fault}" for fault in _force_faults(layout, group, finding.use))
        elif isinstance(finding.use, LocatingErrors):
            yield from (f"{claim}: {fault}" for fault in _feature_faults(layout, finding.use))


def _force_faults(layout: Layout, group: Group, use: LoadsHeld | Seating) -> Iterator[str]:
    if dict(use.preloads) != preloads_of(layout, group.contacts):
        yield "its preloads are not those of the layout"
    weight = acting_weight(layout, group, FoundContacts(group.contacts, scale_of(group.contacts), ()))
    if isinstance(weight, str) or not np.allclose(use.weight, weight, rtol=WITNESS, atol=0):
        yield "its weight is not that of the layout"
    if isinstance(use, LoadsHeld):
        rows = load_rows(layout, group)
        told = [(load.load, load.row) for load in use.loads]
        if told != [(row.load, row.row) for row in rows]:
            yield "its loads are not those of the layout"
        elif not all(np.array_equal(load.wrench, row.wrench) for load, row in zip(use.loads, rows, strict=True)):
            yield "a load is another one in the layout"


def _feature_faults(layout: Layout, use: LocatingErrors) -> Iterator[str]:
    given = [(f.name, f.tolerance, *f.point.tolist()) for f in layout.key_features]
    if use.features and [(f.feature, f.tolerance, *f.point.tolist()) for f in use.features] != given:
        yield "its features are not those of the layout"
    tolerances = {e.name: e.tolerance or 0.0 for e in layout.elements}
    for name, error in use.errors.items():
        if error < tolerances.get(name, 0.0):
            yield f"{name} has an error below its tolerance"
