"""Verdicts: yes, no or undecided, each with the evidence that a checker can confirm without a solver."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from fixture_design.arrays import Point, Vector
from fixture_design.cones import PolyhedralConvexCone
from fixture_design.contacts import Contact
from fixture_design.layout.answer import Answer
from fixture_design.layout.layout import Requirement, Space
from fixture_design.layout.use import LoadsHeld, LocatingErrors, Seating, StraightWays

#: Rules that make an answer certain whatever the normals are.
RuleName = Literal["few rows", "few normals", "common slip", "slip or leave"]


@dataclass(frozen=True)
class Counted:
    """Contacts whose rows are of few dimensions (or whose normals are few), and of how many at most."""

    contacts: tuple[str, ...]
    count: int


@dataclass(frozen=True)
class Rule:
    """Why an answer holds for every normal within the errors, although its motion is that of the normals as given.

    Attributes:
        name: "few rows" or "few normals", see `analysis.counting`; "common slip": the motion moves every touched
            surface along itself, "slip or leave": or leaves the contacts there, see `analysis.slipping`.
        counted: each contact of the group once; their counts add up to too few for the claim. None for slips.
    """

    name: RuleName
    counted: tuple[Counted, ...]


@dataclass(frozen=True, eq=False)
class Motion:
    """A displacement [dx; dtheta] about W's origin, that every contact admits (or, if strict, that leaves all).

    With a ``rule`` the motion is admissible for the normals as given, and the rule vouches for all that they may be.
    """

    motion: Vector
    residual: float
    rule: Rule | None = None


@dataclass(frozen=True, eq=False)
class Weights:
    """Weights that balance the contacts' unit-normal wrenches, for one branch.

    Attributes:
        weights: for each contact one weight a normal, or a friction edge, clause after clause; those of alternatives
            that the branch does not take are zero.
        basis: (contact, index into its weights) of d independent rows of positive weight: the rank; empty where the
            claim needs none.
        choice: for each clause with alternatives that the branch settles, the alternative taken, as
            (contact, clause, alternative); a clause that is not named may take any.
        residual: |D^T w| / sum w, in dimensionless rows.
    """

    weights: Mapping[str, tuple[float, ...]]
    basis: tuple[tuple[str, int], ...]
    choice: tuple[tuple[str, int, int], ...]
    residual: float


@dataclass(frozen=True, eq=False)
class Singular:
    """Evidence for determinacy: the rank, and why it is that.

    Attributes:
        rank: of the branch with the lowest rank found.
        motion: where the rank is short, a motion that no contact of the branch notices to first order; else None.
        choices: the alternatives taken, as (contact, clause, alternative): for a motion those of its branch; else one
            choice for each set of branches whose rows, with those that have no alternative, have full rank. Together
            these cover all branches.
        residual: |D u| at most, for the motion scaled to length one; 0 without.
        rule: as in `Motion`; only with a motion.
    """

    rank: int
    motion: Vector | None
    choices: tuple[tuple[tuple[str, int, int], ...], ...]
    residual: float
    rule: Rule | None = None


Evidence = Motion | Singular | tuple[Weights, ...]
#: Claims about what the fixture does to the part: they depend on gravity, loads and clamps, not on contacts alone.
USE_CLAIMS: tuple[Requirement, ...] = ("loadable", "accurate", "seated", "holds_loads")
UseEvidence = LocatingErrors | LoadsHeld | Seating | StraightWays


@dataclass(frozen=True, eq=False)
class Finding:
    """One answer about one group.

    Attributes:
        answer: None for an empty group.
        margin: dimensionless, see DESIGN of the format; None where it was not computed.
        evidence: a motion, a rank, or weights for every branch that needs them; None only if undecided or empty.
        use: in its place for what the fixture does to the part (`layout.use`).
        residual: the largest one of the evidence.
        edges: number of friction edges in space, for force closure.
        tangents: with edges, for each contact with friction the unit tangent t of each normal n, clause after clause:
            edge k is n + mu (cos a t + sin a n X t) at a = 2 pi k / edges, with n at length one.
        reason: why it is undecided, in words.
    """

    answer: Answer | None
    margin: float | None = None
    evidence: Evidence | None = None
    residual: float | None = None
    edges: int | None = None
    tangents: Mapping[str, tuple[Point, ...]] | None = None
    reason: str | None = None
    use: UseEvidence | None = None


@dataclass(frozen=True, eq=False)
class GroupVerdict:
    """All findings about one group, and its sets: A as the cones of its union, F as one cone (Table 3).

    The sets are about W's origin [m, rad, N, N m]; None for an empty group, and where the union was too large to list.
    """

    name: str
    contacts: tuple[str, ...]
    findings: Mapping[str, Finding]
    admissible_displacements: tuple[PolyhedralConvexCone, ...] | None = None
    admissible_forces: PolyhedralConvexCone | None = None
    bidirectional: tuple[str, ...] = ()


@dataclass(frozen=True)
class RequirementVerdict:
    """Whether one requirement on one group holds; None for an empty group, which satisfies nothing."""

    group: str
    require: Requirement
    answer: Answer | None


@dataclass(frozen=True, eq=False)
class Verdict:
    """Everything `verify` found about a layout.

    Attributes:
        satisfied: None where nothing is required.
        reference, length: of the dimensionless rows that margins and residuals are measured in [m].
        run: version, kernel, tolerances.
    """

    name: str
    source: str | None
    space: Space
    satisfied: Answer | None
    groups: Mapping[str, GroupVerdict]
    contacts: tuple[Contact, ...]
    requirements: tuple[RequirementVerdict, ...]
    notes: tuple[str, ...]
    reference: Point
    length: float
    run: Mapping[str, object] = field(default_factory=dict)
