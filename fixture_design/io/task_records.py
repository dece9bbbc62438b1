"""The task file `fixture_design/task/1`, key by key; what a layout has too is as there. See `records`."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from fixture_design.design import Objective
from fixture_design.io.record_types import (
    Coordinates,
    Deviation,
    Friction,
    NotNegative,
    Positive,
    PushLimits,
    Record,
    Text,
)
from fixture_design.io.records import KeyFeatureRecord, LoadRecord, PartRecord, RequireRecord, TipField, or_point
from fixture_design.layout import Space

_Corners = Annotated[tuple[Coordinates, ...], Field(strict=False, min_length=2, max_length=2)]
_Count = Annotated[int, Field(ge=0)]


class KeepOutRecord(Record):
    """A region without candidates."""

    WANTED: ClassVar[str] = "{box: [[x, y, z], [x, y, z]]}, its lowest and its highest corner"
    box: _Corners = Field(description="lowest and highest corner in W [length]")


class GridRecord(Record):
    """The holes of a modular plate."""

    WANTED: ClassVar[str] = "{origin: [x, y, z], pitch: p, plane: xy}"
    origin: Coordinates = Field(description="one of the holes, in W [length]")
    pitch: Positive = Field(description="from hole to hole [length]")
    plane: Literal["xy", "yz", "xz"] = Field("xy", description="of the plate")


class StemRecord(Record):
    """What carries the tip of a new element; what is not given fits a part of this size."""

    WANTED: ClassVar[str] = "a mapping such as {radius: 0.004, length: 0.03, body_radius: 0.01, body_length: 0.02}"
    radius: Positive | None = Field(None, description="of the stem [length]")
    length: Positive | None = Field(None, description="of the stem, from the tip [length]")
    body_radius: Positive | None = Field(None, description="of the body behind the stem [length]")
    body_length: Positive | None = Field(None, description="of the body [length]")


class PinsRecord(Record):
    """Pins in holes and slots of the part: a round one and a diamond one, with three points on faces."""

    WANTED: ClassVar[str] = "a mapping such as {clearance: 2.0e-5, diameters: [0.004, 0.02]}"
    clearance: NotNegative = Field(description="between hole and pin, in diameter [length]")
    diameters: Annotated[tuple[Positive, ...], Field(strict=False, min_length=2, max_length=2)] = Field(
        description="of pins, from and to [length]"
    )


class CandidatesRecord(Record):
    """Where elements may touch the part; at most one of spacing, points and grid."""

    WANTED: ClassVar[str] = "a mapping such as {spacing: 0.005, edge_margin: 0.003}"
    spacing: Positive | None = Field(None, description="between candidates [length]")
    edge_margin: NotNegative | None = Field(None, description="least distance from sharp edges [length]")
    facets: Annotated[tuple[Annotated[int, Field(ge=1)], ...], Field(strict=False, min_length=1)] | None = Field(
        None, description="numbers of the facets that elements may touch, default all"
    )
    keep_out: Annotated[tuple[KeepOutRecord, ...], Field(strict=False)] = ()
    points: Annotated[tuple[Coordinates, ...], Field(strict=False, min_length=1)] | None = Field(
        None, description="candidates, in W [length]"
    )
    grid: GridRecord | None = None
    tip: TipField = Field(None, description="of new elements, default: point", json_schema_extra=or_point)
    tips: (
        Annotated[tuple[Annotated[TipField, Field(json_schema_extra=or_point)], ...], Field(strict=False, min_length=1)]
        | None
    ) = Field(None, description="in place of `tip`: several, of which each new element has one")
    stem: StemRecord | None = None
    pins: PinsRecord | None = None
    round: bool = Field(False, description="whether round surfaces count from the first: fewer elements may do")
    tolerance: Deviation | None = Field(None, description="of new locators' positions along the normal [length]")


class LimitsRecord(Record):
    """How many elements there may be, and how they may stand."""

    WANTED: ClassVar[str] = "a mapping such as {locators: 6, clamps: 3, spacing: 0.01}"
    locators: _Count | None = Field(None, description="at most")
    clamps: _Count | None = Field(None, description="at most")
    spacing: NotNegative = Field(0.0, description="least distance between two elements [length]")
    loading: Coordinates | None = Field(None, description="direction in W in which the part goes in")
    preload: PushLimits | None = Field(None, description="least and most that a new clamp may push with [N]")


class TaskRecord(Record):
    """A design task."""

    schema_: Literal["fixture_design/task/1"] = Field(alias="schema")
    name: Text | None = Field(None, description="of the layout, default: the file's name without suffix")
    space: Space = "spatial"
    units: Literal["m", "mm", "in"] = Field("m", description="of the lengths in this file")
    part: PartRecord
    candidates: CandidatesRecord | None = None
    start: Text | None = Field(None, description="layout to begin with, relative to this file")
    require: RequireRecord | None = None
    limits: LimitsRecord | None = None
    objective: Annotated[tuple[Objective, ...], Field(strict=False, min_length=1)] = ("fewest", "accuracy")
    gravity: Coordinates | None = Field(None, description="[m/s^2], whatever the units; default none")
    friction: Friction = Field(0.0, description="default coefficient")
    surface_gap: NotNegative | None = Field(None, description="as in a layout [length]")
    key_features: Annotated[tuple[KeyFeatureRecord, ...], Field(strict=False)] = ()
    loads: Annotated[tuple[LoadRecord, ...], Field(strict=False)] = ()
