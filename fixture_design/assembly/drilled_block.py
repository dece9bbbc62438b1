"""Convex polyhedra with round holes: plane facets, and cylinders that end in circles on them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Point, Points, Weights
from fixture_design.assembly.polytope import Polytope
from fixture_design.assembly.turned_body import COAXIAL, ONE_CIRCLE
from fixture_design.layout import Pose

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry
    from fixture_design.geometry.smooth_surface import SmoothSurface

#: Share of the volume that rounding of a mesh may be [-], and how far off the plane of a facet its corners.
_SAME_VOLUME, _ON_PLANE = 1e-2, 1e-6


@dataclass(frozen=True, eq=False)
class Hole:
    """A round hole in W.

    Attributes:
        point: on its axis [m].  axis: unit, out of the block at its (upper) opening.  radius: [m].
        low, high: where it ends along the axis from ``point`` [m].
        openings: facets that it opens in, the one at ``high`` first; one for a blind hole, whose floor is at ``low``.
    """

    point: Point
    axis: Point
    radius: float
    low: float
    high: float
    openings: tuple[int, ...]

    @property
    def blind(self) -> bool:
        return len(self.openings) == 1

    def seen(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of points (n, 3): unit vectors away from the axis, and distances from it [m]."""
        away = points - self.point
        away = away - (away @ self.axis)[:, None] * self.axis
        rho = np.linalg.norm(away, axis=1)
        return away / np.maximum(rho, np.finfo(float).tiny)[:, None], rho

    @property
    def floor(self) -> tuple[Point, float]:
        """Normal and offset of a blind hole's floor."""
        return self.axis, float(self.axis @ self.point) + self.low

    def rims(self) -> list[tuple[Point, Point, int]]:
        """Of each opening the circle's center, the direction out of the block, and the facet."""
        ends = [(self.point + self.high * self.axis, self.axis), (self.point + self.low * self.axis, -self.axis)]
        return [(*end, facet) for end, facet in zip(ends, self.openings, strict=False)]


@dataclass(frozen=True, eq=False)
class DrilledBlock:
    """A convex polyhedron with holes, in W.

    Attributes:
        hull: the polyhedron without its holes; facets of the block are those of ``normals``, ``offsets``.
        normals, offsets: of the outer facets, shapes (f, 3), (f,).
        edges: ends of the straight edges, shape (e, 2, 3).
    """

    hull: Polytope
    normals: Points
    offsets: Weights
    edges: Float[np.ndarray, "_ 2 3"]
    holes: tuple[Hole, ...]

    @classmethod
    def solid(cls, hull: Polytope) -> DrilledBlock:
        """Without holes."""
        return cls(hull, hull.normals, hull.offsets, hull.vertices[hull.edges], ())

    def border(self, points: np.ndarray, facet: int) -> tuple[np.ndarray, np.ndarray]:
        """How far points (n, 3) in the plane of a facet are beyond its border, and unit vectors out of it, (n, 3)."""
        normal = self.normals[facet]
        across = self.normals - (self.normals @ normal)[:, None] * normal
        lengths = np.linalg.norm(across, axis=1)
        sides = lengths > COAXIAL
        across = across[sides] / lengths[sides, None]
        heights = (points @ self.normals[sides].T - self.offsets[sides]) / lengths[sides]
        worst = heights.argmax(axis=1)
        beyond, out = heights[np.arange(len(points)), worst], across[worst]
        for hole in self.holes:
            if facet in hole.openings:
                radial, rho = hole.seen(points)
                inside = hole.radius - rho > beyond
                out = np.where(inside[:, None], -radial, out)
                beyond = np.maximum(beyond, hole.radius - rho)
        return beyond, out


def drilled_block(geometry: PartGeometry, pose: Pose) -> DrilledBlock | str:
    """A part as a convex block with round holes, or in words why it is none."""
    surfaces = geometry.smooth_surfaces
    refused = [s.name for s in surfaces if s.is_band or s.kind != "cylinder" or not s.hollow]
    if refused:
        return f"{', '.join(refused)}: only cylindrical holes in blocks form contact pairs"
    round_facets = np.concatenate([np.zeros(0, dtype=int), *(surface.facets for surface in surfaces)])
    flat = np.setdiff1d(np.arange(len(geometry.facets)), round_facets)
    corners = [geometry.vertices[np.unique(geometry.triangles[geometry.facets[f].triangles])] for f in flat]
    normals = geometry.facet_units[flat]
    offsets = np.array([(c @ n).mean() for c, n in zip(corners, normals, strict=True)])
    size = 2 * geometry.half_diagonal
    heights = geometry.vertices @ normals.T - offsets
    outer = heights.max(axis=0) <= _ON_PLANE * size
    holes = []
    for surface in surfaces:
        found = _hole(geometry, surface, normals, offsets, outer, size)
        if isinstance(found, str):
            return found
        holes.append(found)
    used = {floor for _, floor in holes if floor is not None}
    if set(np.flatnonzero(~outer).tolist()) != used:
        return "apart from its holes it is not convex"
    hull = Polytope.hull_of(pose.points(geometry.vertices))
    drilled = sum(np.pi * hole.radius**2 * (hole.high - hole.low) for hole, _ in holes)
    if abs(hull.volume - drilled - geometry.shell_volumes.sum()) > _SAME_VOLUME * hull.volume:
        return "it is not a convex block with these holes"
    numbers = np.cumsum(outer) - 1
    kept = normals[outer]
    placed = pose.vectors(kept)
    return DrilledBlock(
        hull,
        placed,
        offsets[outer] + placed @ pose.translation,
        hull.vertices[hull.edges],
        tuple(_placed(hole, pose, numbers) for hole, _ in holes),
    )


def _hole(
    geometry: PartGeometry, surface: SmoothSurface, normals: Points, offsets: Weights, outer: np.ndarray, size: float
) -> tuple[Hole, int | None] | str:
    """A hole with the numbers of plane facets as openings, and the facet that is its floor."""
    chosen = np.isin(geometry.facet_of_triangle, surface.facets)
    along = (geometry.vertices[np.unique(geometry.triangles[chosen])] - surface.point) @ surface.axis
    ends: list[tuple[int, float, float]] = []
    for height, sign in ((along.max(), 1.0), (along.min(), -1.0)):
        there = surface.point + height * surface.axis
        on = np.abs(normals @ there - offsets) <= ONE_CIRCLE * size
        square = np.abs(np.abs(normals @ surface.axis) - 1) <= COAXIAL**2
        at = np.flatnonzero(on & square)
        if len(at) != 1:
            return f"{surface.name} does not end in circles on plane facets square to it"
        ends.append((int(at[0]), float(height), sign))
    opens = [bool(outer[facet]) for facet, _, _ in ends]
    if not any(opens):
        return f"{surface.name} opens nowhere"
    top, bottom = ends if opens[0] else ends[::-1]
    axis = surface.axis * top[2]
    low, high = sorted((top[1] * top[2], bottom[1] * top[2]))
    openings = (top[0], bottom[0]) if all(opens) else (top[0],)
    return Hole(surface.point, axis, surface.radius, low, high, openings), None if all(opens) else bottom[0]


def _placed(hole: Hole, pose: Pose, numbers: Indices) -> Hole:
    openings = tuple(int(numbers[facet]) for facet in hole.openings)
    point, axis = pose.points(hole.point[None])[0], pose.vectors(hole.axis[None])[0]
    return Hole(point, axis, hole.radius, hole.low, hole.high, openings)
