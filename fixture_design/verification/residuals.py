"""The residuals that a finding states, computed again: in the verdict's own scale, from points and normals.

They are how far evidence is off, in the rows [n; (x - reference) X n / length] with n at length one: max d . u / |u|
for a motion u (with friction: of n . v + mu |[v_t; c w_n]|), largest |d . u| / |u| for one that is not noticed, and
|D^T w| / sum w for weights.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fixture_design.arrays import Point, Vector
from fixture_design.contacts import Contact, motion_scaled, unit_normal, velocity
from fixture_design.layout import Finding, Motion, Singular, Weights
from fixture_design.tolerances import WITNESS
from fixture_design.verification.proofs import Case, Pyramids, unit_forces


def residual_fault(finding: Finding, case: Case, pyramids: Pyramids | None) -> str | None:
    """A stated residual that is not that of the evidence; ``case``: with the verdict's scale. None if all are right.

    The evidence has passed as a proof before, so that its names and numbers fit the contacts.
    """
    if finding.evidence is None or not case.contacts:
        return None
    evidence = finding.evidence if isinstance(finding.evidence, tuple) else (finding.evidence,)
    limit = WITNESS * (1 + case.scale.offset)
    for stated in evidence:
        found = _residual(stated, case, pyramids)
        if not abs(stated.residual - found) <= limit:
            return f"the residual is {found:.1e}, not {stated.residual:.1e}"
    if finding.residual != max(stated.residual for stated in evidence):
        return f"the finding's residual {finding.residual} is not the largest of its evidence"
    return None


def _residual(evidence: Motion | Singular | Weights, case: Case, pyramids: Pyramids | None) -> float:
    match evidence:
        case Weights():
            total, weight = np.zeros(case.dimension), 0.0
            for contact in case.contacts:
                forces = unit_forces(contact, pyramids)
                assert not isinstance(forces, str), forces
                rows = np.vstack([case.rows(contact, *edges) for edges in forces])
                given = np.array(evidence.weights[contact.name])
                total += given @ rows
                weight += float(given.sum())
            return float(np.linalg.norm(total)) / weight
        case Motion():
            works = [min(_work(c, n, evidence.motion, pyramids is not None) for n in o) for c, o in _clauses(case)]
            return max(works) / _size(evidence.motion, case)
        case Singular():
            if evidence.motion is None:
                return 0.0
            taken = {(name, clause): alternative for name, clause, alternative in evidence.choices[0]}
            works = [
                abs(_work(contact, normal, evidence.motion, False))
                for contact in case.contacts
                for index, clause in enumerate(contact.clauses)
                for alternative, normal in enumerate(clause)
                if taken.get((contact.name, index), alternative) == alternative
            ]
            return max(works) / _size(evidence.motion, case)


def _clauses(case: Case) -> Iterator[tuple[Contact, tuple[Point, ...]]]:
    return ((contact, clause) for contact in case.contacts for clause in contact.clauses)


def _size(motion: Vector, case: Case) -> float:
    return float(np.linalg.norm(motion_scaled(motion, case.scale.reference, case.scale.length)))


def _work(contact: Contact, normal: Point, motion: Vector, friction: bool) -> float:
    """n . v, and with friction the most that tangential forces and torsion add to it."""
    v, unit = velocity(motion, contact.point), unit_normal(normal)
    along = float(unit @ v)
    if not friction or not contact.friction:
        return along
    slip = float(np.linalg.norm(v - along * unit))
    if contact.torsion:
        slip = float(np.hypot(slip, contact.torsion * (unit @ motion[3:])))
    return along + contact.friction * slip
