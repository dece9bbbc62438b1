"""A restraint: contacts that act together, with the arrays and answers that several questions share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fixture_design.analysis.branches import Leaf, Settled, UnionQuestions
from fixture_design.analysis.counting import too_few_to_close
from fixture_design.analysis.margin import closure_margin
from fixture_design.analysis.normal_errors import blur, still_motion
from fixture_design.analysis.slipping import common_slip, slip_or_leave
from fixture_design.arrays import Points, Rows, Vector
from fixture_design.contacts import (
    Constraints,
    Contact,
    Scale,
    constraints_of,
    first_tangents,
    motion_about_origin,
    motion_scaled,
    scale_of,
)
from fixture_design.errors import ContactError
from fixture_design.layout import Evidence, Finding, Motion, Rule, Weights
from fixture_design.layout.verdict import Answer
from fixture_design.tolerances import DEFAULT, SUM_ROUNDING, Tolerances


@dataclass(frozen=True, eq=False)
class Restraint:
    """Some contacts, and the scale that margins and residuals are reported in.

    Decisions use rows scaled by the contacts themselves (`constraints`), reports rows scaled by the part (`reported`).

    Raises:
        ContactError: no contacts.  DimensionError: planar and spatial ones mixed.
    """

    contacts: tuple[Contact, ...]
    report: Scale
    tolerances: Tolerances = DEFAULT

    @classmethod
    def of(
        cls, contacts: Sequence[Contact], report: Scale | None = None, tolerances: Tolerances = DEFAULT
    ) -> Restraint:
        """Without a report scale the contacts' own centroid and spread are taken."""
        if not contacts:
            raise ContactError("there are no contacts")
        return cls(tuple(contacts), report or scale_of(contacts), tolerances)

    @cached_property
    def constraints(self) -> Constraints:
        return constraints_of(self.contacts)

    @cached_property
    def reported(self) -> Constraints:
        return constraints_of(self.contacts, self.report)

    @cached_property
    def opened(self) -> Restraint | None:
        """The same with clearances open: pins in their holes keep nothing in; None if no other contacts are left."""
        kept = tuple(contact for contact in self.contacts if not contact.clearance)
        if len(kept) == len(self.contacts):
            return self
        return Restraint(kept, self.report, self.tolerances) if kept else None

    @cached_property
    def closed(self) -> Settled:
        """Is every branch {o}? Asked once for form closure and accessibility."""
        settled = UnionQuestions(self.constraints, self.tolerances).closed()
        if settled.truth is not None or not self.constraints.errors.any():
            return settled
        if self.slip is not None:
            return Settled(False, motion=self.slip, rule=Rule("common slip", ()))
        still, rule = still_motion(self.contacts, self.tolerances), too_few_to_close(self.contacts)
        if still is not None:
            return Settled(False, motion=still)
        if rule is not None:
            nominal = UnionQuestions(self.constraints.without_errors(), self.tolerances).closed()
            if nominal.truth is False:
                return replace(nominal, rule=rule)
        leaving = slip_or_leave(self.contacts, self.tolerances) if self.contacts[0].dimension == 6 else None
        if leaving is not None:
            return Settled(False, motion=leaving, rule=Rule("slip or leave", ()))
        return self.blamed(settled)

    @cached_property
    def slip(self) -> Vector | None:
        """A motion of all touched surfaces along themselves; asked only where normals are off."""
        return common_slip(self.contacts, self.tolerances) if self.constraints.errors.any() else None

    def blamed(self, settled: Settled) -> Settled:
        """An outcome whose reason, where it is undecided, names the normals that are off."""
        return replace(settled, reason=self.reason(settled.reason)) if settled.truth is None else settled

    def reason(self, reason: str | None) -> str | None:
        """A reason with the normals that may be behind it."""
        return "; ".join(text for text in (reason, blur(self.contacts, self.tolerances)) if text) or None

    @cached_property
    def tangents(self) -> list[Points] | None:
        """First tangents of the friction edges in space: towards the report's reference, so that groups share them."""
        return first_tangents(self.contacts, self.report.reference) if self.contacts[0].dimension == 6 else None

    @cached_property
    def interior(self) -> Settled:
        """Has some branch interior?"""
        if self.closed.truth:
            # a closed union has none, and its weights prove that too
            return Settled(False, leaves=self.closed.leaves)
        return self.blamed(UnionQuestions(self.constraints, self.tolerances).has_interior())

    @cached_property
    def margin(self) -> float | None:
        """s of the normals, in the report's scale; what keeps slips from being ties is the normals' error."""
        margin = closure_margin(self.reported, self.tolerances)
        return margin if margin is None or self.closed.rule is None else min(margin, 0.0)

    def finding(self, answer: Answer, settled: Settled, margin: float | None, *, full_rank: bool) -> Finding:
        """A finding about the normals, with its evidence; ``full_rank``: the weights need a basis for their claim."""
        evidence = self.evidence(settled, self.constraints, self.reported, full_rank=full_rank)
        return Finding(answer, margin, evidence, largest_residual(evidence), reason=settled.reason)

    def evidence(
        self, settled: Settled, constraints: Constraints, reported: Constraints, *, full_rank: bool
    ) -> Evidence | None:
        """What settled a question about ``constraints``, in names and in the report's scale."""
        if settled.motion is not None:
            motion = motion_in_world(settled.motion, constraints.scale)
            scaled = motion_scaled(motion, self.report.reference, self.report.length)
            value = reported.clause_values(reported.rows @ scaled).max() / np.linalg.norm(scaled)
            return Motion(motion, float(value), settled.rule)
        if settled.leaves:
            return tuple(self._weights(leaf, reported, full_rank) for leaf in settled.leaves)
        return None

    def choice(self, alternatives: Sequence[int], constraints: Constraints) -> tuple[tuple[str, int, int], ...]:
        """(contact, clause, alternative), counted from 0, where a clause had more than one alternative."""
        chosen = []
        for alternative in sorted(alternatives):
            clause = int(constraints.clause[alternative])
            siblings = constraints.alternatives_of(clause)
            if len(siblings) > 1:
                contact = int(constraints.contact[clause])
                first = int(np.searchsorted(constraints.contact, contact))
                chosen.append((self.contacts[contact].name, clause - first, int(alternative - siblings[0])))
        return tuple(chosen)

    def _weights(self, leaf: Leaf, reported: Constraints, full_rank: bool) -> Weights:
        owner = reported.contact[reported.clause[reported.alternative]]
        first = np.searchsorted(owner, np.arange(len(self.contacts)))
        basis = heavy_basis(reported.rows, leaf.weights) if full_rank else []
        return Weights(
            weights={c.name: tuple(leaf.weights[owner == i].tolist()) for i, c in enumerate(self.contacts)},
            basis=tuple((self.contacts[owner[row]].name, int(row - first[owner[row]])) for row in basis),
            choice=self.choice(leaf.choice, reported),
            residual=float(np.linalg.norm(leaf.weights @ reported.rows) / leaf.weights.sum()),
        )


def motion_in_world(motion: Vector, scale: Scale) -> Vector:
    """A unit motion of scaled rows as [dx; dtheta] about W's origin; components that are only rounding become zero."""
    tidy = np.where(np.abs(motion) < SUM_ROUNDING, 0.0, motion)
    return motion_about_origin(tidy, scale.reference, scale.length)


def largest_residual(evidence: Evidence | None) -> float | None:
    """The residual of a finding: the worst of its evidence."""
    if evidence is None:
        return None
    return max(w.residual for w in evidence) if isinstance(evidence, tuple) else evidence.residual


def heavy_basis(rows: Rows, weights: np.ndarray) -> list[int]:
    """d independent rows of large weight: again and again the one whose weighted part off the span is longest."""
    remaining = weights[:, None] * rows
    chosen: list[int] = []
    for _ in range(rows.shape[1]):
        lengths = np.linalg.norm(remaining, axis=1)
        best = int(np.argmax(lengths))
        chosen.append(best)
        direction = remaining[best] / lengths[best]
        remaining = remaining - np.outer(remaining @ direction, direction)
        remaining[chosen] = 0.0
    return sorted(chosen)
