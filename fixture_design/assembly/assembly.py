"""The nouns: two parts that are put together, and where configurations of the moving one are sought.

A configuration q is the pose of the moving part: planar [x, y, theta], spatial [x, y, z, qw, qx, qy, qz] (3-2, 3-31).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Point, Points
from fixture_design.errors import AssemblyError
from fixture_design.layout import Pose, Space

#: Planar [x, y, theta], spatial [x, y, z, qw, qx, qy, qz].
Configuration = Float[np.ndarray, "c"]


@dataclass(frozen=True, eq=False)
class AssemblyBody:
    """One body: a polygon in the plane; a box, a mesh or a URDF file in space.

    Attributes:
        kind: which of them.  polygon: shape (n, 2), counter-clockwise [m].  box: its three sides [m], about its centre.
        file: of a mesh or URDF.  scale: factor that makes its vertices metres.
        pose: of a fixed body in W; of the moving body its shape in its own frame.
        apices, facets: name -> index from 0 of the features that take part; without names all do.
    """

    kind: Literal["polygon", "box", "mesh", "urdf"]
    polygon: Points | None = None
    box: Point | None = None
    file: Path | None = None
    scale: float = 1.0
    pose: Pose | None = None
    apices: Mapping[str, int] = field(default_factory=dict)
    facets: Mapping[str, int] = field(default_factory=dict)

    @property
    def named(self) -> bool:
        """Whether only the named features take part."""
        return bool(self.apices or self.facets)


@dataclass(frozen=True, eq=False)
class Region:
    """Where configurations are sought.

    Attributes:
        low, high: of the position, shape (2,) or (3,) [m].
        turns: planar (smallest, largest) theta [rad], the same twice where the orientation is fixed; in space (0,
            largest angle from the given orientation); None: any orientation.

    Raises:
        AssemblyError: limits out of order, or not finite.
    """

    low: Point
    high: Point
    turns: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        limits = np.array([self.low, self.high])
        if not np.isfinite(limits).all() or (limits[0] > limits[1]).any():
            raise AssemblyError(f"a region needs finite limits, the smaller one first: {limits.tolist()}")
        if self.turns is not None and not self.turns[0] <= self.turns[1]:
            raise AssemblyError(f"the angles of a region must be in order: {self.turns}")

    @property
    def turning(self) -> Literal["free", "limited", "fixed"]:
        """What the region leaves of the rotation."""
        if self.turns is None:
            return "free"
        return "fixed" if self.turns[0] == self.turns[1] else "limited"

    @property
    def size(self) -> float:
        """Half the diagonal [m]."""
        return float(np.linalg.norm(self.high - self.low)) / 2


@dataclass(frozen=True, eq=False)
class Assembly:
    """A moving and some fixed bodies.

    Attributes:
        region: None: all around the fixed bodies, any orientation.
        data: the file's mapping, in metres, as a graph file embeds it.
    """

    name: str
    space: Space
    moving: AssemblyBody
    fixed: tuple[AssemblyBody, ...]
    region: Region | None = None
    source: Path | None = None
    data: Mapping[str, Any] = field(default_factory=dict)

    @property
    def files(self) -> tuple[Path, ...]:
        """The files it is made of: its own, and those of meshes and URDFs."""
        bodies = (body.file for body in (self.moving, *self.fixed))
        return tuple(file for file in (self.source, *bodies) if file is not None)
