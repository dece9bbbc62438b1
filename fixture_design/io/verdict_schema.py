"""The JSON object `fixture_design/verdict/1`, key by key, for its JSON Schema. `verdict_record` writes it."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, Field

from fixture_design.contacts import Role
from fixture_design.io.record_types import Number, Record
from fixture_design.io.use_schema import LoadsHeldRecord, LoadVerdictRecord, LocatingRecord, SeatingRecord, WaysRecord
from fixture_design.layout import Requirement, RuleName, Space

VerdictWord = Literal["yes", "no", "undecided"]
Row = list[Number]
Choice = list[tuple[str, int, int]]


class WeightsRecord(Record):
    """Weights that balance; the basis rows have positive weight and full rank."""

    weights: dict[str, Row] = Field(description="for each contact one weight a normal or friction edge")
    basis: list[tuple[str, int]] = Field(description="[contact, index into its weights]")


class BranchRecord(WeightsRecord):
    """Weights for one branch of the ORs."""

    choice: Choice = Field(description="[contact, clause, alternative taken]; a clause not named may take any")


class BranchesRecord(Record):
    """Weights for every branch that needs them."""

    branches: list[BranchRecord]


class CountedRecord(Record):
    """Contacts counted together: on one plane facet, or one alone."""

    contacts: list[str]
    count: int = Field(ge=0, description="of their rows (few rows) or normals (few normals), at most")


class RuleRecord(Record):
    """Why the answer holds whatever the normals are: too few rows or normals, or surfaces that the motion keeps.

    "few rows": fewer than d rows do not locate, d rows do not close; "few normals": p do not close; d = 6, p = 3 in
    space, d = 3, p = 2 in the plane. Contacts on one plane facet have one normal, and rows of 1 + the dimension of
    their points' affine hull. "common slip": the motion moves every touched surface along itself, up to the normals'
    errors (`slips` of the contacts); "slip or leave": or leaves the contacts there. Nothing is counted then.
    """

    name: RuleName
    counted: list[CountedRecord]


class MotionRecord(Record):
    """A displacement [dx; dtheta] about W's origin, [m, rad]; with a rule, of the normals as given."""

    motion: Row
    rule: RuleRecord | None = Field(None, description="why errors of normals do not change the answer")


class RankRecord(Record):
    """Rank of the contacts' rows; where it is short, a motion that no contact notices to first order."""

    rank: int = Field(ge=0)
    motion: Row | None = None
    choices: list[Choice] | None = Field(
        None, description="of the branch with the motion; without one, choices of full rank that cover all branches"
    )
    rule: RuleRecord | None = Field(None, description="why errors of normals do not change the answer")


_UseRecord = LocatingRecord | LoadsHeldRecord | SeatingRecord | WaysRecord


class FindingRecord(Record):
    """One answer about a group. With `--brief` only `verdict` and `reason`."""

    verdict: VerdictWord | None = Field(description="null for an empty group")
    margin: Number | None = Field(None, description="dimensionless; rows about run.reference, over run.length")
    witness: WeightsRecord | BranchesRecord | MotionRecord | RankRecord | _UseRecord | None = None
    residual: Number | None = Field(None, description="|D^T w| / sum w, or largest d.u / |u|; dimensionless")
    edges: int | None = Field(None, description="friction edges in space")
    tangents: dict[str, list[Row]] | None = Field(
        None,
        description="with edges: for each contact with friction the unit tangent t of each of its normals; the force "
        "of edge k is n + friction (cos a t + sin a n X t), a = 2 pi k / edges, n of length one",
    )
    reason: str | None = Field(None, description="why it is undecided")


class ConeRecord(Record):
    """A polyhedral convex cone about W's origin in both forms; null for vectors that were not computed."""

    faces: list[Row] | None = Field(description="a . x <= 0")
    equalities: list[Row] | None = Field(description="e . x = 0")
    spans: list[Row] | None = Field(description="generators, taken with weights >= 0")
    lines: list[Row] | None = Field(description="generators, taken with weights of any sign")


class UnionRecord(Record):
    """A union of cones."""

    cones: list[ConeRecord]


class GroupRecord(Record):
    """All findings about one group of contacts."""

    contacts: list[str]
    deterministic: FindingRecord | None = None
    accessible: FindingRecord | None = None
    strongly_accessible: FindingRecord | None = None
    loadable: FindingRecord | None = None
    form_closure: FindingRecord | None = None
    force_closure: FindingRecord | None = None
    seated: FindingRecord | None = None
    holds_loads: FindingRecord | None = None
    accurate: FindingRecord | None = None
    admissible_displacements: UnionRecord | None = Field(None, description="[m, rad]; null if too large to list")
    admissible_forces: ConeRecord | None = Field(None, description="[N, N m]")
    bidirectional: list[str] | None = Field(None, description="contacts that stay closed in every admissible motion")


class ProvenanceRecord(Record):
    """Where normals come from."""

    kind: Literal["exact", "fitted", "approximate"]
    normal_error: Number = Field(description="[rad]")
    slip_error: Number | None = Field(
        None,
        description="how far off `slips` are, where that is less than `normal_error`: surfaces of revolution [rad]",
    )


class FoundContactRecord(Record):
    """A contact as the verdict took it."""

    name: str
    role: Role
    point: Row = Field(description="in W [m]")
    normals: list[list[Row]] = Field(description="AND of ORs of outward normals, of any length")
    distance: Number | None = Field(description="between surface and tip [m]; null for contacts given outright")
    feature: str | None
    friction: Number
    torsion: Number = Field(0.0, description="of soft tips: moment about the normal a newton and unit of friction [m]")
    clearance: Number = Field(0.0, description="of pins; contacts with clearance do not count for accessibility [m]")
    provenance: ProvenanceRecord
    slips: list[list[Row]] = Field(
        [], description="for each normal, the motions about W's origin that move its surface along itself [m, rad]"
    )
    linked: str | None = Field(None, description="the other end of a segment on which convex edges touch")


class RequirementRecord(Record):
    """Whether one requirement on one group holds."""

    group: str
    require: Requirement
    verdict: VerdictWord | None


class RunRecord(Record):
    """How the verdict was computed."""

    model_config = ConfigDict(extra="allow")
    version: str | None = None
    kernel: str | None = None
    tolerances: dict[str, Number] | None = None
    reference: Row = Field(description="of margins and residuals, in W [m]")
    length: Number = Field(description="of margins and residuals [m]")


class VerdictRecord(Record):
    """What `verify` found about one layout. Numbers are SI, whatever the layout's units."""

    schema_: Literal["fixture_design/verdict/1"] = Field(alias="schema")
    name: str
    source: str | None
    space: Space
    units: Literal["m"]
    satisfied: VerdictWord | None = Field(description="null where nothing is required")
    groups: dict[str, GroupRecord]
    contacts: list[FoundContactRecord] | None = Field(None, description="absent with --brief")
    requirements: list[RequirementRecord]
    loads: list[LoadVerdictRecord]
    notes: list[str]
    run: RunRecord


class ErrorRecord(Record):
    """Why a layout could not be verified."""

    kind: str
    message: str


class FailureRunRecord(Record):
    """What in a batch the error is about."""

    version: str
    input: str = Field(description="SHA-256 of the layout's text and of the files it names")


class FailureRecord(Record):
    """The object that stands for a layout that could not be verified, in a batch."""

    schema_: Literal["fixture_design/verdict/1"] = Field(alias="schema")
    name: str
    source: str | None
    error: ErrorRecord
    run: FailureRunRecord | None = None
