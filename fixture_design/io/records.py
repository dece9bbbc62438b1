"""The layout file `fixture_design/layout/1`, key by key.

These classes say which keys there are and what type each value has; what depends on several of them (the number of
coordinates, names that must differ) is in `layout_rules`. Lengths are in the file's `units`.
"""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field

from fixture_design.contacts import Role
from fixture_design.io.record_types import (
    Coordinates,
    Deviation,
    Force,
    Friction,
    Gravity,
    Mass,
    Moment,
    Name,
    NotNegative,
    Number,
    Pair,
    Place,
    Positive,
    Push,
    PushLimits,
    Record,
    Size,
    Stiffness,
    Text,
    Triple,
    exactly_one,
)
from fixture_design.layout import Requirement, Space

LAYOUT_SCHEMA = "fixture_design/layout/1"

Requirements = Annotated[tuple[Requirement, ...], Field(strict=False)]


class PoseRecord(Record):
    """X_WP: xyz and rpy in space, xy and theta in the plane; what is left out is zero."""

    WANTED: ClassVar[str] = "{xyz: [x, y, z], rpy: [roll, pitch, yaw]}, or planar {xy: [x, y], theta: angle}"
    xyz: Triple | None = Field(None, description="translation [length]")
    rpy: Triple | None = Field(None, description="roll, pitch, yaw as in URDF [rad]")
    xy: Pair | None = Field(None, description="planar translation [length]")
    theta: Number | None = Field(None, description="planar rotation, counter-clockwise [rad]")


class PartRecord(Record):
    """The part: exactly one of urdf, mesh, step and polygon."""

    WANTED: ClassVar[str] = "a mapping such as {mesh: part.stl, scale: 0.001}"
    model_config = exactly_one("urdf", "mesh", "step", "polygon")
    urdf: Text | None = Field(None, description="URDF file, relative to this file")
    mesh: Text | None = Field(None, description="STL, OBJ, DAE, PLY, glTF, GLB or 3MF file")
    step: Text | None = Field(None, description="STEP file")
    polygon: Annotated[tuple[Pair, ...], Field(strict=False, min_length=3)] | None = Field(
        None, description="planar: vertices [x, y] in P, counter-clockwise [length]"
    )
    scale: Positive | None = Field(None, description="factor that makes the vertices metres; mesh and step only")
    pose: PoseRecord | None = Field(None, description="X_WP, default identity")
    mass: Mass | None = Field(None, description="[kg]")
    center: Place | None = Field(None, description="centre of mass in P [length]")
    form_error: Deviation | None = Field(None, description="largest deviation of the surface [length]")
    faceted: bool = Field(
        False, description="every facet is meant as it is; none stands for a piece of a round surface"
    )


class PinRecord(Record):
    """A pin in a hole or slot."""

    WANTED: ClassVar[str] = "{diameter: d, clearance: c, shape: round}"
    diameter: Positive = Field(description="[length]")
    clearance: NotNegative = Field(description="[length]")
    shape: Literal["round", "diamond"] = Field("round", description="diamond: locates along `along` only")
    along: Coordinates | None = Field(None, description="of a diamond pin: the direction it locates in")


class TipRecord(Record):
    """The tip of an element: the word `point`, or one of sphere, pad, line, soft, pin."""

    WANTED: ClassVar[str] = (
        "point, {sphere: radius}, {pad: [width, height], along: v}, {line: length, along: v}, "
        "{soft: radius} or {pin: ...}"
    )
    model_config = exactly_one("sphere", "pad", "line", "soft", "pin")
    sphere: Positive | None = Field(None, description="radius [length]")
    pad: Size | None = Field(None, description="width (along `along`) and height [length]")
    line: Positive | None = Field(None, description="length [length]")
    soft: Positive | None = Field(None, description="radius of the contact patch [length]")
    pin: PinRecord | None = None
    along: Coordinates | None = Field(None, description="direction of a pad's width, a line, a diamond pin")


def or_point(schema: dict[str, Any]) -> None:
    """Lets a JSON Schema say that a tip may be the word `point`."""
    schema["anyOf"].insert(0, {"const": "point"})


def _named_tip(value: object) -> object:
    return None if value == "point" else value


TipField = Annotated[TipRecord | None, BeforeValidator(_named_tip)]


class ElementRecord(Record):
    """An element with a tip that touches the part at the surface point nearest to `at`."""

    WANTED: ClassVar[str] = "a mapping such as {name: L1, role: locator, at: [0, 0, 0]}"
    name: Name
    role: Role
    at: Coordinates = Field(description="in W [length]")
    tip: TipField = Field(None, description="default: point", json_schema_extra=or_point)
    axis: Coordinates | None = Field(None, description="of a pin: its direction")
    tolerance: Deviation | None = Field(None, description="of its position along the normal [length]")
    friction: Friction | None = Field(None, description="coefficient, default: the layout's")
    preload: Push | None = Field(None, description="what a clamp pushes with, along the inward normal [N]")
    limits: PushLimits | None = Field(None, description="smallest and largest preload that design may choose [N]")
    fixed: bool = Field(False, description="design leaves it where it is")
    stiffness: Stiffness | None = Field(None, description="of the contact [N/m], whatever the units")


class BodyRecord(Record):
    """A fixture body of which every contact with the part counts."""

    WANTED: ClassVar[str] = "a mapping such as {name: vblock, role: locator, urdf: vblock.urdf}"
    name: Name
    role: Role
    urdf: Text = Field(description="URDF file, relative to this file")
    pose: PoseRecord | None = Field(None, description="X_WB, default identity")
    friction: Friction | None = Field(None, description="coefficient, default: the layout's")


class ContactRecord(Record):
    """A contact given outright, with exactly one of normal, any_of, all_of and normals."""

    WANTED: ClassVar[str] = "a mapping such as {name: Q1, role: locator, point: [1, 1], normal: [0, 1]}"
    model_config = exactly_one("normal", "any_of", "all_of", "normals")
    name: Name
    role: Role
    point: Coordinates = Field(description="in W [length]")
    normal: Coordinates | None = Field(None, description="the part's outward normal, of any length")
    any_of: Annotated[tuple[Coordinates, ...], Field(strict=False, min_length=1)] | None = Field(
        None, description="OR: the facets of a convex edge or apex"
    )
    all_of: Annotated[tuple[Coordinates, ...], Field(strict=False, min_length=1)] | None = Field(
        None, description="AND: the facets of a concave edge"
    )
    normals: (
        Annotated[
            tuple[Annotated[tuple[Coordinates, ...], Field(strict=False, min_length=1)], ...],
            Field(strict=False, min_length=1),
        ]
        | None
    ) = Field(None, description="AND of ORs")
    friction: Friction | None = Field(None, description="coefficient, default: the layout's")


class KeyFeatureRecord(Record):
    """A point of the part whose position along a direction matters."""

    WANTED: ClassVar[str] = "a mapping such as {name: bore, point: [0, 0, 0], direction: [0, 0, 1], tolerance: 5.0e-5}"
    name: Name
    point: Coordinates = Field(description="in W [length]")
    direction: Coordinates
    tolerance: Positive = Field(description="[length]")


class LoadRecord(Record):
    """A wrench on the part, or a path of them in a CSV file."""

    WANTED: ClassVar[str] = "a mapping such as {name: cutting, point: [0, 0, 0], force: [0, 300, -100]}"
    name: Name
    point: Place | None = Field(None, description="where the force acts, in W [length]")
    force: Force | None = Field(None, description="[N]")
    moment: Moment | None = Field(None, description="[N m]; planar: one number")
    path: Text | None = Field(None, description="CSV file of wrenches, instead of the three keys above")


class StageRecord(Record):
    """A moment in the fixture's use; a group of its own."""

    WANTED: ClassVar[str] = "a mapping such as {name: clamped, active: [locator, clamp], require: [force_closure]}"
    name: Name
    active: Annotated[tuple[str, ...], Field(strict=False, min_length=1)] = Field(description="roles or names")
    gravity: bool = Field(False, description="whether the layout's gravity acts")
    loads: Annotated[tuple[str, ...], Field(strict=False)] = Field((), description="names of loads that act")
    require: Requirements = ()


class RequireRecord(Record):
    """Requirements on the contacts of role locator, and on all contacts."""

    WANTED: ClassVar[str] = "{locators: [...], all: [...]}; other groups are `stages`, with a `require` each"
    locators: Requirements | None = None
    all: Requirements | None = None


class SweepRecord(Record):
    """Variants of the layout for `batch`: how far each quantity may be from what the layout says, either way."""

    WANTED: ClassVar[str] = "a mapping such as {at: 0.001, friction: [0.1, 0.3], samples: 100, seed: 1}"
    part_pose: PoseRecord | None = Field(None, description="largest deviation of each coordinate [length, rad]")
    at: NotNegative | None = Field(None, description="largest deviation of each coordinate of `at` [length]")
    friction: Annotated[tuple[Friction, ...], Field(strict=False, min_length=2, max_length=2)] | None = Field(
        None, description="smallest and largest coefficient"
    )
    samples: Annotated[int, Field(ge=1)] | None = Field(None, description="number of variants")
    seed: Annotated[int, Field(ge=0)] | None = Field(None, description="of the random numbers")


class LayoutRecord(Record):
    """A fixture layout: a part, what touches it, and what is required."""

    schema_: Literal["fixture_design/layout/1"] = Field(alias="schema")
    name: Text | None = Field(None, description="default: the file's name without suffix")
    space: Space = "spatial"
    units: Literal["m", "mm", "in"] = Field("m", description="of the lengths in this file")
    part: PartRecord | None = None
    gravity: Gravity | None = Field(None, description="[m/s^2], whatever the units; default none")
    friction: Friction = Field(0.0, description="default coefficient")
    surface_gap: NotNegative | None = Field(
        None, description="largest distance between element and surface [length], default 1e-5 m"
    )
    elements: Annotated[tuple[ElementRecord, ...], Field(strict=False)] = ()
    bodies: Annotated[tuple[BodyRecord, ...], Field(strict=False)] = ()
    contacts: Annotated[tuple[ContactRecord, ...], Field(strict=False)] = ()
    key_features: Annotated[tuple[KeyFeatureRecord, ...], Field(strict=False)] = ()
    loads: Annotated[tuple[LoadRecord, ...], Field(strict=False)] = ()
    stages: Annotated[tuple[StageRecord, ...], Field(strict=False)] = ()
    require: RequireRecord | None = None
    sweep: SweepRecord | None = None
