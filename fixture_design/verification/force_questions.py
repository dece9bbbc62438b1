"""The questions about forces: does the part sit on its locators, and are its loads held?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from fixture_design.analysis.acting import LoadRow, preloads_of
from fixture_design.analysis.contact_forces import contact_forces
from fixture_design.analysis.holding import held_loads
from fixture_design.analysis.preloads import least_preloads
from fixture_design.analysis.seating import seating
from fixture_design.analysis.stiffness import elastic_reactions
from fixture_design.analysis.tipping import ON_AN_EDGE, on_an_edge
from fixture_design.arrays import Vector
from fixture_design.contacts import Contact
from fixture_design.layout import (
    Answer,
    Balance,
    ContactForce,
    Finding,
    Group,
    Layout,
    LoadsHeld,
    LoadVerdict,
    element_name,
    severity,
)
from fixture_design.tolerances import ROUND_OFF, Tolerances
from fixture_design.verification.found import FoundContacts
from fixture_design.verification.load_paths import load_rows
from fixture_design.verification.weight import weight_of

#: Loads named in one reason before it says "and so many more".
_LOADS_SHOWN = 3


def holds_loads(layout: Layout, group: Group, found: FoundContacts, tolerances: Tolerances) -> Finding:
    """Whether the group holds each of its loads, one at a time, with gravity and preloads; without loads, these alone.

    Raises:
        FileFormatError: a load path cannot be read.
    """
    rows = load_rows(layout, group)
    weight = acting_weight(layout, group, found)
    if isinstance(weight, str):
        return Finding(Answer.UNDECIDED, reason=weight)
    preloads = preloads_of(layout, group.contacts)
    if without := _without_preload(group.contacts, preloads):
        return Finding(Answer.UNDECIDED, reason=without)
    verdicts = held_loads(group.contacts, preloads, weight, rows, tolerances)
    worst = min(range(len(rows)), key=lambda index: severity(verdicts[index]))
    stiff = _stiff(layout, group, preloads, weight + rows[worst].wrench, tolerances)
    use = LoadsHeld(
        verdicts,
        worst,
        preloads,
        weight,
        _least(layout, group, preloads, weight, rows, tolerances),
        stiff is not None or determinate(group.contacts, preloads, tolerances),
        stiff,
    )
    residuals = [verdict.proof.residual for verdict in verdicts if isinstance(verdict.proof, Balance)]
    answer, reason = verdicts[worst].answer, _reason(verdicts)
    if answer is Answer.YES and on_an_edge(group.contacts, preloads, weight, rows[worst].wrench, tolerances):
        answer, reason = Answer.UNDECIDED, ON_AN_EDGE
    return Finding(answer, residual=max(residuals, default=None), reason=reason, use=use)


def _without_preload(contacts: Sequence[Contact], preloads: Mapping[str, float]) -> str | None:
    """A clamp pushes with its preload; without one nobody knows with what."""
    clamps = dict.fromkeys(element_name(c.name) for c in contacts if c.role == "clamp")
    without = [name for name in clamps if name not in preloads]
    return f"clamp {', '.join(without)} has no preload" if without else None


def acting_weight(layout: Layout, group: Group, found: FoundContacts) -> Vector | str:
    """The weight as a wrench about W's origin, zero where gravity does not act on the group; or why it is not known."""
    weight = weight_of(layout if group.gravity else replace(layout, gravity=None), found.geometry)
    return weight if isinstance(weight, str) else weight.wrench


def _reason(verdicts: Sequence[LoadVerdict]) -> str | None:
    if any(verdict.answer is Answer.NO for verdict in verdicts):
        return None
    texts = [f"{_name(verdict)}: {verdict.reason}" for verdict in verdicts if verdict.answer is Answer.UNDECIDED]
    if len(texts) > _LOADS_SHOWN:
        texts = [*texts[:_LOADS_SHOWN], f"{len(texts) - _LOADS_SHOWN} more"]
    return "; ".join(texts) or None


def _name(verdict: LoadVerdict) -> str:
    return verdict.load if verdict.row is None else f"{verdict.load} row {verdict.row}"


def _least(
    layout: Layout,
    group: Group,
    preloads: Mapping[str, float],
    weight: Vector,
    rows: Sequence[LoadRow],
    tolerances: Tolerances,
) -> dict[str, float] | None:
    limits = {e.name: e.limits for e in layout.elements if e.role == "clamp" and e.limits is not None}
    return least_preloads(group.contacts, preloads, limits, weight, rows, tolerances) if limits else None


def _stiff(
    layout: Layout, group: Group, preloads: Mapping[str, float], wrench: Vector, tolerances: Tolerances
) -> dict[str, ContactForce] | None:
    stiffness = {e.name: e.stiffness for e in layout.elements if e.stiffness is not None}
    return elastic_reactions(group.contacts, preloads, stiffness, wrench, tolerances) if stiffness else None


def determinate(contacts: Sequence[Contact], preloads: Mapping[str, float], tolerances: Tolerances) -> bool:
    """Whether the wrench alone settles what every contact does: as many independent forces as there are."""
    if any(len(clause) > 1 for contact in contacts for clause in contact.clauses):
        return False
    cones = contact_forces(contacts, preloads).cones
    heads = np.zeros(cones.maps.shape[1], dtype=bool)
    heads[cones.starts[~np.isnan(cones.heads)]] = True
    unknown = cones.maps[:, ~heads]
    if unknown.shape[1] > unknown.shape[0]:
        return False
    unknown = unknown / np.maximum(np.linalg.norm(unknown, axis=0), ROUND_OFF)
    return bool((np.linalg.svd(unknown, compute_uv=False) > tolerances.near).all())


def seated(layout: Layout, group: Group, found: FoundContacts, tolerances: Tolerances) -> Finding:
    """Whether gravity, then the group's clamps one after the other press the part against every locator."""
    weight = acting_weight(layout, group, found)
    if isinstance(weight, str):
        return Finding(Answer.UNDECIDED, reason=weight)
    preloads = preloads_of(layout, group.contacts)
    if without := _without_preload(group.contacts, preloads):
        return Finding(Answer.UNDECIDED, reason=without)
    return seating(group.contacts, preloads, weight, tolerances)
