"""Witnesses of what the fixture does to the part, key by key, for the JSON Schema; `use_record` writes them."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from fixture_design.io.record_types import Number, Record

VerdictWord = Literal["yes", "no", "undecided"]
Row = list[Number]


class FeatureErrorRecord(Record):
    """How far a key feature may be off along its direction [m]."""

    name: str
    tolerance: Number
    worst: Number | None = Field(description="over all seats; null without limit")
    least: Number | None = Field(description="in the best seat")
    rss: Number | None = Field(description="root sum square of the shares, in the worst seat")
    shares: dict[str, Number] = Field(description="each element's part of `worst`")
    seat: list[str] = Field(description="contacts that the part sits on in the worst case")


class RockingRecord(Record):
    """Contacts that locate more often than once."""

    contacts: list[str]
    motion: Row = Field(description="from one seat to another, [dx; dtheta] about W's origin [m, rad]")
    size: Number = Field(description="how far the contacts are off at most when it rocks [m]")


class LocatingRecord(Record):
    """Witness of `accurate`."""

    features: list[FeatureErrorRecord]
    pose: Row | None = Field(description="largest error of each coordinate, about run.reference [m, rad]")
    errors: dict[str, Number] = Field(description="of each element's contacts along their normals [m]")
    costliest: str | None
    rocking: list[RockingRecord]
    motion: Row | None = Field(description="that no locator notices, where the part is not located")
    complete: bool = Field(description="whether all seats were looked at")


class ContactForceRecord(Record):
    """What a contact does to the part, one force a normal [N], soft tips also moments about the normals [N m]."""

    forces: list[Row]
    moments: Row | None = None


class BalanceRecord(Record):
    """Contact forces that balance a wrench on the part, about W's origin [N, N m]."""

    wrench: Row
    forces: dict[str, ContactForceRecord]
    residual: Number


class UnbalancedRecord(Record):
    """A motion along which the wrench does more work than all contacts can take back."""

    wrench: Row
    motion: Row
    surplus: Number


class LoadPlaceRecord(Record):
    load: str
    row: int | None = None


class LoadsHeldRecord(Record):
    """Witness of `holds_loads`; the loads themselves are in the verdict's `loads`."""

    worst: LoadPlaceRecord
    preloads: dict[str, Number] = Field(description="that contacts push with [N]")
    least_preloads: dict[str, Number] | None = Field(description="smallest sum that holds everything [N]")
    determinate: bool = Field(description="false: friction leaves the reactions undetermined")
    stiff: dict[str, ContactForceRecord] | None = Field(description="reactions for the stiffness given")


class SeatingStepRecord(Record):
    """Gravity alone (clamp: null), or one clamp closed."""

    clamp: str | None
    verdict: VerdictWord
    reactions: dict[str, list[Number | None]] = Field(description="[least, largest] normal force of each locator [N]")
    idle: list[str]
    lifted: list[str]
    proof: BalanceRecord | UnbalancedRecord | None
    cause: str | None


class SeatingRecord(Record):
    """Witness of `seated`."""

    steps: list[SeatingStepRecord]
    preloads: dict[str, Number]


class ObstacleRecord(Record):
    name: str
    after: Number
    point: Row


class WaysRecord(Record):
    """Witness of `loadable`: straight directions in which the part leaves."""

    contacts: list[str]
    open: list[str]
    spans: list[Row]
    lines: list[Row]
    direction: Row | None
    leaving: Number
    slides: list[str]
    length: Number | None = Field(description="of the way looked at [m]")
    against: list[str]
    obstacle: ObstacleRecord | None
    weights: dict[str, Row] | None


class LoadRowRecord(Record):
    """One point of a load path."""

    row: int
    verdict: VerdictWord
    reserve: list[Number | None] | None


class LoadVerdictRecord(Record):
    """Whether a load is held by a group; of a path, its worst point."""

    group: str
    load: str
    verdict: VerdictWord
    reserve: list[Number | None] | None = Field(
        description="[lower, upper] bound of the factor held; null: without limit"
    )
    row: int | None = None
    points: int | None = None
    held: int | None = None
    needed: Number | None = Field(None, description="smallest factor that can be held")
    first: list[tuple[str, Literal["slips", "lifts"]]] | None = None
    proof: BalanceRecord | UnbalancedRecord | None = None
    reason: str | None = None
    rows: list[LoadRowRecord] | None = None
