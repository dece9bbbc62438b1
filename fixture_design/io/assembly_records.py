"""The assembly file `fixture_design/assembly/1`, key by key; lengths are in the file's `units`."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field

from fixture_design.io.record_types import NotNegative, Pair, Positive, Record, Text, exactly_one
from fixture_design.io.records import PoseRecord
from fixture_design.layout import Space

Index = Annotated[int, Field(ge=0)]
Names = Annotated[dict[str, Index], Field(default_factory=dict)]
Sides = Annotated[tuple[Positive, ...], Field(strict=False, min_length=3, max_length=3)]


def _fixed_is_zero(value: object) -> object:
    return 0.0 if value == "fixed" else value


class BodyShapeRecord(Record):
    """A body: exactly one of polygon (planar), box, mesh and urdf (in space)."""

    WANTED: ClassVar[str] = "a mapping such as {polygon: [[x, y], ...], apices: {apex 1: 0}}"
    model_config = exactly_one("polygon", "box", "mesh", "urdf")
    polygon: Annotated[tuple[Pair, ...], Field(strict=False, min_length=3)] | None = Field(
        None, description="planar: vertices [x, y], counter-clockwise [length]"
    )
    box: Sides | None = Field(None, description="in space: its sides along x, y and z, about its centre [length]")
    mesh: Text | None = Field(None, description="mesh file, relative to this file")
    urdf: Text | None = Field(None, description="URDF file, relative to this file")
    scale: Positive | None = Field(None, description="factor that makes the vertices metres; mesh only")
    pose: PoseRecord | None = Field(None, description="of the shape in W, or in the moving body's frame")
    apices: Names = Field(description="planar: name -> vertex, from 0; with names only the named take part")
    facets: Names = Field(description="planar: name -> the edge that starts at this vertex")


class RegionRecord(Record):
    """Where configurations are sought; without angles any orientation."""

    WANTED: ClassVar[str] = "a mapping such as {x: [-1, 1], y: [-1, 1], theta: [-1.57, 1.57]}"
    x: Pair = Field(description="smallest, largest [length]")
    y: Pair = Field(description="smallest, largest [length]")
    z: Pair | None = Field(None, description="in space: smallest, largest [length]")
    theta: Pair | None = Field(None, description="planar: smallest, largest, twice the same where it is fixed [rad]")
    rotation: Annotated[NotNegative | None, BeforeValidator(_fixed_is_zero)] = Field(
        None, description="in space: the largest angle from the given orientation [rad], or the word fixed"
    )


def _as_list(value: object) -> Any:
    return [value] if isinstance(value, dict) else value


class AssemblyRecord(Record):
    """Two parts that are put together."""

    WANTED: ClassVar[str] = "an assembly"
    schema_: Literal["fixture_design/assembly/1"] = Field(alias="schema")
    name: Text | None = Field(None, description="default: the file's name")
    space: Space = Field("spatial", description="planar or spatial")
    units: Literal["m", "mm", "in"] = Field("m", description="of this file's lengths")
    moving: BodyShapeRecord = Field(description="the body that moves; its pose is the configuration")
    fixed: Annotated[tuple[BodyShapeRecord, ...], Field(strict=False, min_length=1), BeforeValidator(_as_list)] = Field(
        description="the bodies that do not, in W"
    )
    region: RegionRecord | None = Field(None, description="default: all around the fixed bodies, any orientation")
