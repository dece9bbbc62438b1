"""Whether a motion is free whatever touches the part, although some normals are not known exactly.

A shaft spins by moving its surface along itself; no tip on that surface stops it, wherever its normal may point within
its error (`analysis.slipping`). So one contact for every surface is looked at, and all exact candidates one by one.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.contacts import motion_scaled
from fixture_design.design.candidates import Candidates, stops
from fixture_design.design.drawing_up import layout_of
from fixture_design.design.task import Task
from fixture_design.design.ways import Ways
from fixture_design.layout import Answer, Motion
from fixture_design.tolerances import DEFAULT


def free_for_certain(task: Task, ways: Ways, candidates: Candidates) -> Vector | None:
    """A motion [dx; dtheta] about W's origin that no candidate stops, whatever its normal is; None if none is known."""
    from fixture_design.analysis import Restraint, form_closure  # noqa: PLC0415 - most designs never ask

    first = {feature: index for index, feature in reversed(list(enumerate(candidates.features)))}
    chosen = np.array(sorted(first.values()), dtype=np.int64)
    names = {int(index): f"C{index}" for index in chosen}
    contacts = ways.contacts(layout_of(task, candidates, chosen, chosen[:0], names, {}, 0.0))
    finding = form_closure(Restraint.of(contacts, candidates.scale))
    evidence = finding.evidence
    if finding.answer is not Answer.NO or not isinstance(evidence, Motion):
        return None
    slips = evidence.rule is not None and evidence.rule.name == "common slip"
    scaled = motion_scaled(evidence.motion, candidates.scale.reference, candidates.scale.length)
    scaled = scaled / np.linalg.norm(scaled)
    known = candidates.errors == 0
    nothing = DEFAULT.near if slips else DEFAULT.zero  # what slips along itself stops nothing, whatever rounding says
    if stops(candidates.rows[known], scaled, nothing).any() or not (slips or known.all()):
        return None
    return evidence.motion
