"""The nouns a designer speaks in: part, elements with their tips, bodies, loads, stages, and the layout that has them.

All lengths are metres, angles radians, forces newtons, and everything is in the world frame: `io` converts on reading.
Frozen values; adding a locator makes a new layout (`dataclasses.replace`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from fixture_design.arrays import Point, Points, Vector
from fixture_design.contacts import Contact, Role
from fixture_design.layout.pose import Pose
from fixture_design.tolerances import SURFACE_GAP

Space = Literal["spatial", "planar"]

Requirement = Literal[
    "deterministic",
    "accessible",
    "strongly_accessible",
    "loadable",
    "form_closure",
    "force_closure",
    "seated",
    "holds_loads",
    "accurate",
]


@dataclass(frozen=True, eq=False)
class Part:
    """The part that is to be held.

    Attributes:
        name: for messages: the file's stem, or "polygon".
        kind: how its geometry is given.
        file: URDF, mesh or STEP file, absolute; None for polygons.
        polygon: planar parts: vertices in P, shape (n, 2), counter-clockwise [m].
        scale: what mesh vertices are multiplied by to be metres; 1 for URDF, whose meshes carry their own.
        pose: X_WP.
        mass: [kg].  center: centre of mass in P [m].  form_error: largest deviation of the surface [m].
        faceted: its facets are meant as they are; none stands for a piece of a round surface.
    """

    name: str
    kind: Literal["urdf", "mesh", "step", "polygon"]
    file: Path | None
    polygon: Points | None
    scale: float
    pose: Pose
    mass: float | None = None
    center: Point | None = None
    form_error: float | None = None
    faceted: bool = False


@dataclass(frozen=True)
class PointTip:
    """A sharp tip: touches in a point, without extent of its own."""


@dataclass(frozen=True)
class SphereTip:
    """A ball of ``radius`` [m]."""

    radius: float


@dataclass(frozen=True, eq=False)
class PadTip:
    """A flat rectangle of ``width`` x ``height`` [m], its width along ``along``."""

    width: float
    height: float
    along: Point


@dataclass(frozen=True, eq=False)
class LineTip:
    """A straight edge of ``length`` [m] along ``along``."""

    length: float
    along: Point


@dataclass(frozen=True)
class SoftTip:
    """A soft tip with a contact patch of ``radius`` [m]: resists turning about its normal by friction."""

    radius: float


@dataclass(frozen=True, eq=False)
class PinTip:
    """A pin in a hole or slot: ``diameter`` and ``clearance`` [m], round or diamond (relieved except ``along``)."""

    diameter: float
    clearance: float
    shape: Literal["round", "diamond"]
    along: Point | None = None


Tip = PointTip | SphereTip | PadTip | LineTip | SoftTip | PinTip


@dataclass(frozen=True, eq=False)
class Element:
    """A tip that touches the part at the surface point nearest to ``at``.

    Attributes:
        at: p_W, shape (3,) or (2,) [m].  tip: its shape.  axis: of a pin, from its foot to its end, in W.
        tolerance: of its position along the normal [m].  friction: None takes the layout's.
        preload: what a clamp pushes with [N].  limits: what design may choose for it [N].
        fixed: design leaves it alone.  stiffness: of the contact [N/m].
    """

    name: str
    role: Role
    at: Point
    tip: Tip = field(default_factory=PointTip)
    axis: Point | None = None
    tolerance: float | None = None
    friction: float | None = None
    preload: float | None = None
    limits: tuple[float, float] | None = None
    fixed: bool = False
    stiffness: float | None = None


@dataclass(frozen=True, eq=False)
class Body:
    """A fixture body (vise jaw, V-block) of which every contact with the part counts; pose is X_WB."""

    name: str
    role: Role
    file: Path
    pose: Pose
    friction: float | None = None


@dataclass(frozen=True, eq=False)
class KeyFeature:
    """A point whose position along ``direction`` matters, to within ``tolerance`` [m]."""

    name: str
    point: Point
    direction: Point
    tolerance: float


@dataclass(frozen=True, eq=False)
class Load:
    """A wrench on the part: ``force`` [N] at ``point`` and ``moment`` [N m], or a path of them in a CSV file."""

    name: str
    point: Point | None = None
    force: Point | None = None
    moment: Vector | None = None
    path: Path | None = None


@dataclass(frozen=True)
class Stage:
    """A moment in the fixture's use, with the contacts that are active then; a group of its own.

    Attributes:
        active: roles or contact names.  gravity: whether it acts.  loads: names.  require: what must hold.
    """

    name: str
    active: tuple[str, ...]
    gravity: bool = False
    loads: tuple[str, ...] = ()
    require: tuple[Requirement, ...] = ()


@dataclass(frozen=True, eq=False)
class Layout:
    """A part, whatever touches it, and what is required of it.

    Attributes:
        name: unique in a batch.  source: the file it came from.  space: planar or spatial.
        part: None for layouts of contacts alone.
        gravity: [m/s^2], None for none.  friction: default coefficient.  surface_gap: [m].
        contacts: given outright.  own_friction: names of those whose coefficient was given with them, so that it is not
            the layout's, even where it is the same number.
        stages: groups with requirements; ``require`` holds those of the groups "locators" and "all".
        sweep: settings for a batch of variants, as read.
        units: of the file it came from, for display only.
        places: in that file, as messages name them: of the part under ("part",), of all that has a name under
            ("elements", name) and so on; empty for layouts from no file.
    """

    name: str
    space: Space = "spatial"
    part: Part | None = None
    gravity: Vector | None = None
    friction: float = 0.0
    surface_gap: float = SURFACE_GAP
    elements: tuple[Element, ...] = ()
    bodies: tuple[Body, ...] = ()
    contacts: tuple[Contact, ...] = ()
    key_features: tuple[KeyFeature, ...] = ()
    loads: tuple[Load, ...] = ()
    stages: tuple[Stage, ...] = ()
    require: Mapping[str, tuple[Requirement, ...]] = field(default_factory=dict)
    sweep: Mapping[str, object] | None = None
    source: Path | None = None
    units: Literal["m", "mm", "in"] = "m"
    places: Mapping[tuple[str, ...], str] = field(default_factory=dict)
    own_friction: frozenset[str] = frozenset()


def named_files(layout: Layout) -> tuple[Path, ...]:
    """The files that a layout names: of its part, its bodies, its load paths."""
    part = () if layout.part is None or layout.part.file is None else (layout.part.file,)
    paths = (load.path for load in layout.loads if load.path is not None)
    return (*part, *(body.file for body in layout.bodies), *paths)
