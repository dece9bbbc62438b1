"""Planar parts: the boundary of a polygon, its facets and apices, and the distance to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Point, Points, Weights, read_only
from fixture_design.contacts import Provenance
from fixture_design.errors import GeometryError
from fixture_design.geometry.local import LocalSurface
from fixture_design.geometry.shapes import OfEdge, PolygonVertices
from fixture_design.geometry.smoothness import FacetMeasures, provenances
from fixture_design.layout import Part
from fixture_design.tolerances import COPLANAR_ANGLE, FARTHEST, MERGE_VERTICES, SMOOTH_ANGLE, ZERO_COORDINATE


@dataclass(frozen=True, eq=False)
class Polygon:
    """A simple polygon in the part's frame P; facet k runs from vertex k to the next, counted from 1.

    Attributes:
        name: of the part.
        vertices: shape (n, 2), counter-clockwise [m].
        first_edge: shape (n,), for each edge the first one of its facet: edges in one line are one facet.
        provenance: of each facet's normal, by its first edge: an edge of a polygon that stands for an arc is as
            approximate as the strip of a shaft.
        notes: none so far; solids have some.
    """

    name: str
    vertices: PolygonVertices
    first_edge: OfEdge
    provenance: Mapping[int, Provenance]
    notes: tuple[str, ...] = ()

    @property
    def edges(self) -> Points:
        """From each vertex to the next, shape (n, 2)."""
        return np.roll(self.vertices, -1, axis=0) - self.vertices

    @property
    def box_center(self) -> Point:
        """Centre of the bounding box in P, shape (2,) [m]."""
        return (self.vertices.min(axis=0) + self.vertices.max(axis=0)) / 2

    @property
    def half_diagonal(self) -> float:
        """Half the diagonal of the bounding box [m]."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0))) / 2

    @property
    def precision(self) -> float:
        """How near to a vertex a point counts as on it [m]."""
        return 2 * self.half_diagonal * MERGE_VERTICES

    def normal(self, edge: int) -> Point:
        """Outward normal (ey, -ex) of the facet that an edge belongs to, as long as the facet [m]."""
        x, y = self.edges[self.first_edge == self.first_edge[edge]].sum(axis=0)
        return np.array([y, -x])

    def nearest(self, p_PQ: Point) -> tuple[float, Point]:
        """Signed distance of a point to the boundary, negative inside [m], and the boundary point nearest to it."""
        edges, away = self.edges, p_PQ - self.vertices
        along = np.clip(np.einsum("ij,ij->i", away, edges) / np.einsum("ij,ij->i", edges, edges), 0.0, 1.0)
        points = self.vertices + along[:, None] * edges
        lengths = np.linalg.norm(p_PQ - points, axis=1)
        best = int(np.argmin(lengths))
        return float(-lengths[best] if self._inside(p_PQ) else lengths[best]), points[best]

    def local(self, p_PC: Point) -> LocalSurface:
        """The logic of the boundary at one of its points: a facet, a convex apex (OR) or a reflex one (AND)."""
        to_vertices = np.linalg.norm(self.vertices - p_PC, axis=1)
        apex = int(np.argmin(to_vertices))
        if to_vertices[apex] <= self.precision and self.first_edge[apex] == apex:
            return self._at_apex(apex)
        edge = int(np.argmin(self._distances(p_PC)))
        facet = int(self.first_edge[edge])
        return LocalSurface(((self.normal(edge),),), f"facet {facet + 1}", self.provenance[facet])

    def _at_apex(self, apex: int) -> LocalSurface:
        before, after = self.normal(apex - 1), self.normal(apex)
        sides = [self.provenance[int(self.first_edge[edge])] for edge in (apex - 1, apex)]
        error = max(side.normal_error for side in sides)
        turn = _angle(before, after)
        if all(side.kind == "approximate" for side in sides) and abs(turn) < SMOOTH_ANGLE:
            mean = before / np.linalg.norm(before) + after / np.linalg.norm(after)
            return LocalSurface(((mean,),), f"apex {apex + 1}", Provenance("approximate", max(error, abs(turn))))
        clauses = ((before, after),) if turn > 0 else ((before,), (after,))
        kind = "approximate" if any(side.kind == "approximate" for side in sides) else "exact"
        return LocalSurface(clauses, f"apex {apex + 1}", Provenance(kind, error))

    def feature(self, p_PC: Point) -> str:
        return self.local(p_PC).feature

    def slack(self, surface: LocalSurface) -> float:
        """A polygon is what it is: nothing is allowed for its being a tessellation."""
        return 0.0

    def _distances(self, p_PC: Point) -> Weights:
        edges, away = self.edges, p_PC - self.vertices
        along = np.clip(np.einsum("ij,ij->i", away, edges) / np.einsum("ij,ij->i", edges, edges), 0.0, 1.0)
        return np.linalg.norm(away - along[:, None] * edges, axis=1)

    def _inside(self, p_PQ: Point) -> bool:
        """Even-odd rule: edges that a ray towards +x crosses."""
        start, end = self.vertices, np.roll(self.vertices, -1, axis=0)
        crosses = (start[:, 1] > p_PQ[1]) != (end[:, 1] > p_PQ[1])
        rise = np.where(crosses, end[:, 1] - start[:, 1], 1.0)
        x = start[:, 0] + (p_PQ[1] - start[:, 1]) * (end[:, 0] - start[:, 0]) / rise
        return bool((crosses & (x > p_PQ[0])).sum() % 2)


def polygon_of(part: Part) -> Polygon:
    """The polygon of a planar part.

    Raises:
        GeometryError: no polygon, fewer than three vertices, not finite or too far, repeated vertices, sides that cross
            or overlap, no area, clockwise.
    """
    if part.polygon is None:
        raise GeometryError(f"planar part {part.name!r} has no polygon", expected="polygon: [[x, y], ...]")
    vertices = read_only(part.polygon)
    _check(part.name, vertices)
    edges = np.roll(vertices, -1, axis=0) - vertices
    before = np.roll(edges, 1, axis=0)
    lengths = np.linalg.norm(edges, axis=1) * np.linalg.norm(before, axis=1)
    turn = np.abs(before[:, 0] * edges[:, 1] - before[:, 1] * edges[:, 0])
    corner = (turn > COPLANAR_ANGLE * lengths) | (np.einsum("ij,ij->i", before, edges) < 0)
    corners = np.flatnonzero(corner) if corner.any() else np.arange(len(vertices))
    # edges before the first corner belong to the facet that closes the polygon
    first = corners[np.searchsorted(corners, np.arange(len(vertices)), side="right") - 1]
    return Polygon(part.name, vertices, first, _provenance_of(edges, first, corners, part.faceted))


def _provenance_of(edges: Points, first_edge: np.ndarray, corners: np.ndarray, faceted: bool) -> dict[int, Provenance]:
    """Of each facet: its edges may turn a little from its chord, and it may be one step of an arc."""
    chords = np.array([edges[first_edge == corner].sum(axis=0) for corner in corners])
    measures = []
    for index, (corner, chord) in enumerate(zip(corners, chords, strict=True)):
        spread = max(abs(_angle(chord, edge)) for edge in edges[first_edge == corner])
        neighbours = {(index - 1) % len(corners), (index + 1) % len(corners)}
        angles = {o: _angle(chord, chords[o]) for o in neighbours}
        noise = spread if spread > ZERO_COORDINATE else 0.0
        length = float(np.linalg.norm(chord))
        measures.append(FacetMeasures(length, noise, angles, length))
    return {int(corner): found for corner, found in zip(corners, provenances(measures, faceted), strict=True)}


def _angle(first: Point, second: Point) -> float:
    """The turn from one direction to the other, counter-clockwise positive [rad]."""
    return float(np.arctan2(first[0] * second[1] - first[1] * second[0], first @ second))


def _check(name: str, vertices: np.ndarray) -> None:
    what = f"the polygon of {name!r}"
    if vertices.ndim != 2 or vertices.shape[1] != 2 or len(vertices) < 3:
        raise GeometryError(f"{what} needs three or more vertices [x, y]", found=f"shape {vertices.shape}")
    if not np.isfinite(vertices).all():
        bad = int(np.flatnonzero(~np.isfinite(vertices).all(axis=1))[0])
        raise GeometryError(f"{what} has a vertex that is not finite", found=f"vertex {bad + 1}: {vertices[bad]}")
    if np.abs(vertices).max() > FARTHEST:
        raise GeometryError(
            f"{what} reaches too far", found=f"{np.abs(vertices).max():g} m", expected=f"at most {FARTHEST:g} m"
        )
    size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    import shapely
    from scipy.spatial import KDTree

    repeated = KDTree(vertices).query_pairs(MERGE_VERTICES * size)
    if repeated:
        first, second = min(repeated)
        raise GeometryError(f"{what} has a vertex twice", found=f"vertices {first + 1} and {second + 1}")

    shape = shapely.Polygon(vertices)
    if not shape.is_valid:
        reason = shapely.is_valid_reason(shape)
        raise GeometryError(f"{what} is not simple", found=reason, expected="sides that only join")
    x, y = (vertices - vertices[0]).T
    area = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2
    if abs(area) <= MERGE_VERTICES * size**2:
        raise GeometryError(f"{what} has no area", found=f"{area:.3g} m^2")
    if area < 0:
        raise GeometryError(f"{what} runs clockwise", expected="counter-clockwise; list its vertices in reverse")
