"""What a designer asks for: a part, where elements may be, what must hold, and what is best among what holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from fixture_design.arrays import Point, Points, Vector
from fixture_design.layout import KeyFeature, Layout, Load, Part, PointTip, Requirement, Space, StemSizes, Tip
from fixture_design.tolerances import SURFACE_GAP

#: What is made small or large, in this order; `fewest` elements, the smallest error at the key features, the largest
#: margin of closure, the least preload.
Objective = Literal["fewest", "accuracy", "margin", "preload"]


@dataclass(frozen=True, eq=False)
class Grid:
    """The holes of a modular plate: one of them at ``origin`` in W, others ``pitch`` apart [m]."""

    origin: Point
    pitch: float
    plane: Literal["xy", "yz", "xz"] = "xy"


@dataclass(frozen=True)
class PinRules:
    """Pins that may stand in the part's holes, as thick as these less ``clearance``; ``diameters`` from and to [m]."""

    clearance: float
    diameters: tuple[float, float]


@dataclass(frozen=True, eq=False)
class CandidateRules:
    """Where elements may touch the part.

    Attributes:
        spacing: between candidates [m]; None for as fine as a part of this size needs.
        edge_margin: least distance from sharp edges [m]; None for a small part of the part's size.
        facets: allowed ones by number; None allows all.
        keep_out: boxes (lowest corner, highest corner) in W without candidates [m].
        points: candidates as someone chose them, in W, instead of a spread.  grid: of a modular plate, likewise.
        tip: of new elements.  more_tips: that they may have instead.
        pins: a round and a diamond pin in two holes are tried first; None for none.
        stem: sizes of what carries a tip, where these are not the usual ones.
        round_too: whether round surfaces count from the first, not only where flat ones do not do.
        tolerance: to which new locators are placed along the normal [m].
    """

    spacing: float | None = None
    edge_margin: float | None = None
    facets: tuple[int, ...] | None = None
    keep_out: tuple[tuple[Point, Point], ...] = ()
    points: Points | None = None
    grid: Grid | None = None
    tip: Tip = field(default_factory=PointTip)
    more_tips: tuple[Tip, ...] = ()
    pins: PinRules | None = None
    stem: StemSizes = field(default_factory=StemSizes)
    round_too: bool = False
    tolerance: float | None = None

    @property
    def chosen_by_hand(self) -> bool:
        """Whether they are only on some of the part's surface."""
        everywhere = self.facets is None and not self.keep_out and self.points is None and self.grid is None
        return not everywhere


@dataclass(frozen=True, eq=False)
class Limits:
    """How many elements there may be at most, and how they may stand.

    Attributes:
        spacing: least distance between two elements [m].
        loading: the direction in W in which the part goes in; it comes out the other way. None leaves it open.
        preload: least and most that a new clamp may push with [N]; None for as much as it takes.
    """

    locators: int | None = None
    clamps: int | None = None
    spacing: float = 0.0
    loading: Point | None = None
    preload: tuple[float, float] | None = None

    @property
    def way_out(self) -> Point | None:
        """The unit direction in which the part comes out, where ``loading`` says it."""
        return None if self.loading is None else -np.asarray(self.loading) / np.linalg.norm(self.loading)


@dataclass(frozen=True, eq=False)
class Task:
    """A design task.

    Attributes:
        start: elements to begin with; those that are ``fixed`` stay as they are.
        require: of the groups "locators" and "all", as in `Layout`; None for what a bare part gets: locators that
            locate and let the part out in a straight line, and clamps that close it without friction, or where no
            such fixture exists with `tolerances.USUAL_FRICTION`.
        objective: first things first.
        gravity, friction, surface_gap, key_features, loads: as in `Layout`, which the design gets.
        source: the file it came from.  places: as in `Layout`.
    """

    name: str
    part: Part
    space: Space = "spatial"
    candidates: CandidateRules = field(default_factory=CandidateRules)
    start: Layout | None = None
    require: Mapping[str, tuple[Requirement, ...]] | None = None
    limits: Limits = field(default_factory=Limits)
    objective: tuple[Objective, ...] = ("fewest", "accuracy")
    gravity: Vector | None = None
    friction: float = 0.0
    surface_gap: float = SURFACE_GAP
    key_features: tuple[KeyFeature, ...] = ()
    loads: tuple[Load, ...] = ()
    source: Path | None = None
    places: Mapping[tuple[str, ...], str] = field(default_factory=dict)
