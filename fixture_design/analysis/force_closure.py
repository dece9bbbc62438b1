"""Force closure (thesis 2.3 (c), 2.6 (c), 2.7 (c)): the contacts can balance every load.

F = R^6 if and only if F* = {o} (2-54), asked of the rows of the friction cones' edges instead of the normals' (2-81,
2-82). Several ORs: closed if and only if every branch is. Without friction it is form closure.

In the plane friction cones are polyhedral and the answer is exact. In space an inner and an outer pyramid bracket them:
the inner one closed means yes; a motion that the cone itself cannot stop means no, whichever pyramid suggested it; else
both get more edges. What is still open at the last number of edges is a tie with the friction cone's boundary.

Yes says that a balance exists for every load (the contacts *can* hold), not that friction will find it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fixture_design.analysis.branches import Settled, UnionQuestions
from fixture_design.analysis.margin import closure_margin
from fixture_design.analysis.normal_errors import still_motion
from fixture_design.analysis.restraint import Restraint, largest_residual, motion_in_world
from fixture_design.arrays import Point, Vector
from fixture_design.contacts import Constraints, Side, constraints_of, motion_scaled
from fixture_design.layout import Answer, Finding, Motion

#: Edges of the pyramids, coarse to fine.
EDGES = (8, 16, 32, 64, 128, 256, 512)
#: With soft contacts, whose cones take about half the square of this many.
SOFT_EDGES = (8, 16, 32)


def force_closure(restraint: Restraint) -> Finding:
    """Whether the contacts with their friction can balance every load: F = R^6  (2-22).

    Returns:
        yes with weights on friction edges (``edges`` of them a contact in space); no with a motion against which no
        contact force does work; undecided with a reason. The margin is s of the pyramids that settled it; how many
        edges they have is stated.
    """
    if not any(contact.friction > 0 for contact in restraint.contacts):
        settled = restraint.closed
        return restraint.finding(Answer.of(settled.truth), settled, restraint.margin, full_rank=True)
    finding = _in_the_plane(restraint) if restraint.contacts[0].dimension == 3 else _in_space(restraint)
    if finding.answer is not Answer.UNDECIDED or not restraint.constraints.errors.any():
        return finding
    still = still_motion(restraint.contacts, restraint.tolerances)
    against = None if still is None else _unopposed(restraint, Settled(False, motion=still), restraint.constraints)
    if against is None:
        return replace(finding, reason=restraint.reason(finding.reason))
    return replace(finding, answer=Answer.NO, evidence=against, residual=against.residual, reason=None)


def _in_the_plane(restraint: Restraint) -> Finding:
    """Planar friction cones have two edges: one question, exact."""
    cones = _pyramids(restraint, EDGES[0], "inner")
    settled = UnionQuestions(cones, restraint.tolerances).closed()
    if settled.truth:
        return replace(_holds(restraint, settled, cones, EDGES[0]), edges=None)
    against = _unopposed(restraint, settled, cones)
    if against is None:
        return Finding(Answer.UNDECIDED, _margin(restraint, EDGES[0], "inner"), reason=settled.reason)
    return Finding(Answer.NO, _margin(restraint, EDGES[0], "inner"), against, against.residual)


def _in_space(restraint: Restraint) -> Finding:
    """Inner and outer pyramids with more and more edges, until they agree."""
    steps = SOFT_EDGES if any(contact.torsion for contact in restraint.contacts) else EDGES
    for edges in steps:
        inner = _pyramids(restraint, edges, "inner")
        settled = UnionQuestions(inner, restraint.tolerances).closed()
        if settled.truth:
            return _holds(restraint, settled, inner, edges)
        against = _unopposed(restraint, settled, inner)
        if against is not None:
            return _opened(restraint, against, edges, "inner")
        outer = _pyramids(restraint, edges, "outer")
        against = _unopposed(restraint, UnionQuestions(outer, restraint.tolerances).closed(), outer)
        if against is not None:
            return _opened(restraint, against, edges, "outer")
    reason = f"pyramids of {steps[-1]} edges inside and outside the friction cones do not agree: a tie with the cones"
    return Finding(Answer.UNDECIDED, edges=steps[-1], reason=reason)


def _holds(restraint: Restraint, settled: Settled, inner: Constraints, edges: int) -> Finding:
    evidence = restraint.evidence(settled, inner, _pyramids(restraint, edges, "inner", reported=True), full_rank=True)
    margin = _margin(restraint, edges, "inner")
    return Finding(Answer.YES, margin, evidence, largest_residual(evidence), edges, _tangents(restraint))


def _opened(restraint: Restraint, against: Motion, edges: int, side: Side) -> Finding:
    margin = _margin(restraint, edges, side)
    return Finding(Answer.NO, margin, against, against.residual, edges, _tangents(restraint))


def _tangents(restraint: Restraint) -> dict[str, tuple[Point, ...]] | None:
    """By name, for the contacts that have friction; None in the plane."""
    if restraint.tangents is None:
        return None
    known = zip(restraint.contacts, restraint.tangents, strict=True)
    return {contact.name: tuple(tangents) for contact, tangents in known if contact.friction > 0}


def _margin(restraint: Restraint, edges: int, side: Side) -> float | None:
    """s of the pyramids that settled the question, so that its sign goes with the answer."""
    return closure_margin(_pyramids(restraint, edges, side, reported=True), restraint.tolerances)


def _pyramids(restraint: Restraint, edges: int, side: Side, *, reported: bool = False) -> Constraints:
    scale = restraint.report if reported else None
    return constraints_of(
        restraint.contacts, scale, with_friction=True, edges=edges, side=side, tangents=restraint.tangents
    )


def _unopposed(restraint: Restraint, settled: Settled, pyramids: Constraints) -> Motion | None:
    """The motion of a search as evidence, if the friction cones themselves do not oppose it."""
    if settled.motion is None:
        return None
    zero = restraint.tolerances.at_offset(restraint.constraints.scale.offset).zero
    if friction_value(restraint, restraint.constraints, settled.motion) > zero:
        return None
    motion = motion_in_world(settled.motion, pyramids.scale)
    scaled = motion_scaled(motion, restraint.report.reference, restraint.report.length)
    residual = friction_value(restraint, restraint.reported, scaled, unsure=False) / np.linalg.norm(scaled)
    return Motion(motion, float(residual))


def friction_value(restraint: Restraint, constraints: Constraints, motion: Vector, *, unsure: bool = True) -> float:
    """max over clauses of min over alternatives of  n . v + mu |[v_t; c w_n]| + error, v the contact point's motion.

    Without ``unsure`` normals are as they are given, and there is no error.

    w_n is the turning about the normal, which soft contacts with torsion c resist.

    It is the largest work that unit-normal forces of the cone (the circular one, no pyramid) do against the motion:
    where it is not positive, no friction force opposes the motion. ``motion`` is in the constraints' coordinates.
    """
    plane = len(constraints.scale.reference)
    owner = constraints.contact[constraints.clause]  # without friction edges, one row an alternative
    levers = np.array([c.point - constraints.scale.reference for c in restraint.contacts]) / constraints.scale.length
    turning = motion[plane:]
    if plane == 2:
        spin = turning[0] * np.column_stack([-levers[:, 1], levers[:, 0]])
    else:
        spin = np.cross(turning, levers)
    velocities = (motion[:plane] + spin)[owner]
    normal_parts = np.einsum("rp,rp->r", constraints.rows[:, :plane], velocities)
    tangential = velocities - normal_parts[:, None] * constraints.rows[:, :plane]
    friction = np.array([c.friction for c in restraint.contacts])[owner]
    angles = np.array([c.provenance.normal_error for c in restraint.contacts])[owner]
    sliding = np.linalg.norm(tangential, axis=1)
    errors = angles * np.hypot(1.0, friction) * np.linalg.norm(velocities, axis=1)
    if plane == 3:
        torsion = np.array([c.torsion for c in restraint.contacts])[owner] / constraints.scale.length
        sliding = np.hypot(sliding, torsion * (constraints.rows[:, :3] @ turning))
        errors += angles * friction * torsion * float(np.linalg.norm(turning))
    products = normal_parts + friction * sliding + (errors if unsure else 0.0)
    return float(constraints.clause_values(products).max())
