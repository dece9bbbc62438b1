"""Surfaces of revolution, whatever their profile, found by the rings of their vertices about one axis.

What triangles join the rings does not matter: meshes whose rings are turned by half a step against each other, and
whose triangles are folded along long diagonals, have facets that face nowhere near the surface.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.geometry.facets import Facet
from fixture_design.geometry.piece import area_vectors
from fixture_design.geometry.planes import neighbours
from fixture_design.geometry.shapes import EdgeEnds, OfTriangle, Triangles, VertexMask, Vertices
from fixture_design.geometry.smooth_surface import RoundShape
from fixture_design.geometry.turned_axes import FEWEST_ON_RING, Axis, axes_of
from fixture_design.geometry.turned_bands import Band, Rings, bands_of
from fixture_design.geometry.turned_profile import Piece, pieces_of
from fixture_design.tolerances import SMOOTH_ANGLE

#: Roundings by which an axis may be off, that many of its vertices' [-].
_AXIS_ERRORS = 4.0
#: Corners on a ring of a facet that has an edge there.
_AN_EDGE = 2
#: A cone whose half angle is this near to a right one is a plane [rad].
_PLANE = 1e-3


@dataclass(frozen=True, eq=False)
class TurnedPiece:
    """A piece of a surface of revolution.

    Attributes:
        shape: a surface through its rings.
        facets: that stand for it, all of their triangles.
        profile_error: how far off its normals may be in the half plane through the axis [rad]; 0 where it is a
            cylinder, cone, sphere or torus.
        axis_error: how far off they may be out of this plane [rad].
        smooth: whether its facets are so narrow that it is round for sure; else it may be faceted as well.
        number: the same for all pieces about one axis.
    """

    shape: RoundShape
    facets: list[int]
    profile_error: float
    axis_error: float
    smooth: bool
    number: int

    @property
    def is_plane(self) -> bool:
        """Whether it is a ring in a plane across the axis."""
        return self.shape.kind == "cone" and self.shape.radius > np.pi / 2 - _PLANE


@dataclass(eq=False)
class _Free:
    """Which facets are of no surface yet."""

    of_triangle: OfTriangle
    counts: Indices
    facet: np.ndarray = field(repr=False)

    def whole(self, triangles: Indices) -> list[int]:
        """The free facets all of whose triangles are among these."""
        facets, found = np.unique(self.of_triangle[triangles], return_counts=True)
        return facets[(found == self.counts[facets]) & self.facet[facets]].tolist()

    def folded(self, band: Band, rings: Rings) -> bool:
        """Whether most facets of a band between two rings are single triangles; those of prisms are not."""
        facets = np.unique(self.of_triangle[band.triangles])
        single = int((self.counts[facets] == 1).sum())
        return all(rings.reach[end] > 0 for end in band.ends) and 2 * single > len(facets)


def turned_pieces(
    vertices: Vertices,
    triangles: Triangles,
    facets: Sequence[Facet],
    facet_of_triangle: OfTriangle,
    taken: list[int],
    noise: float,
    tolerance: float,
    size: float,
    first: int = 0,
) -> Iterator[TurnedPiece]:
    """The pieces of all surfaces of revolution that have rings of vertices; each facet is of one at most.

    Args:
        facets: of the part.  facet_of_triangle: which of them each triangle is of, shape (t,).  taken: facets that are
            of other surfaces.
        noise: how well vertices are known [m].  tolerance: how far they may be off a ring [m].  size: of the part [m].
        first: number of the first axis.
    """
    normals = area_vectors(vertices, triangles)
    counts = np.bincount(facet_of_triangle)
    free = _Free(facet_of_triangle, counts, np.ones(len(counts), dtype=bool))
    free.facet[taken] = False
    edges = _borders(triangles, facet_of_triangle, len(vertices))
    mesh = _Mesh.of(vertices, triangles, facets, facet_of_triangle, edges)
    for number, axis in enumerate(axes_of(vertices, edges, tolerance, size), start=first):
        found = _around(axis, mesh, free, tolerance)
        if found is None:
            continue
        near, rings = found
        bands = bands_of(rings, triangles, near, normals)
        beyond = _Beyond(rings, bands, mesh)
        for piece in pieces_of(rings, bands, tolerance, beyond):
            yield from _of_piece(piece, bands, rings, free, vertices, noise, number)


@dataclass(frozen=True, eq=False)
class _Incidence:
    """The triangles at each vertex: those of vertex v are ``triangle[start[v]:start[v + 1]]``."""

    triangle: Indices
    start: Indices

    @classmethod
    def of(cls, triangles: Triangles, count: int) -> _Incidence:
        order = np.argsort(triangles.ravel(), kind="stable")
        return cls(order // 3, np.concatenate([[0], np.cumsum(np.bincount(triangles.ravel(), minlength=count))]))

    def triangles(self, vertices: Indices) -> Indices:
        """Those at some vertices."""
        rows = [self.triangle[self.start[v] : self.start[v + 1]] for v in vertices.tolist()]
        return np.unique(np.concatenate(rows))


@dataclass(frozen=True, eq=False)
class _Mesh:
    """A mesh in facets.

    Attributes:
        of_triangle: the facet that each triangle is of.  at_border: the vertices on edges between facets.
        at: the triangles at each vertex.
    """

    vertices: Vertices
    triangles: Triangles
    facets: Sequence[Facet]
    of_triangle: OfTriangle
    at_border: VertexMask
    at: _Incidence

    @classmethod
    def of(
        cls, vertices: Vertices, triangles: Triangles, facets: Sequence[Facet], of_triangle: OfTriangle, edges: EdgeEnds
    ) -> _Mesh:
        at_border = np.zeros(len(vertices), dtype=bool)
        at_border[edges] = True
        return cls(vertices, triangles, facets, of_triangle, at_border, _Incidence.of(triangles, len(vertices)))


def _around(axis: Axis, mesh: _Mesh, free: _Free, tolerance: float) -> tuple[Indices, Rings] | None:
    """The triangles of free facets with corners on rings about an axis, and the rings; None if there are too few.

    Rings may have more corners than those by which the axis was found.
    """
    on = axis.vertices
    while True:
        touched = np.unique(mesh.of_triangle[mesh.at.triangles(on)])
        touched = touched[free.facet[touched]]
        if not len(touched):
            return None
        near = np.sort(np.concatenate([mesh.facets[facet].triangles for facet in touched.tolist()]))
        used = np.unique(mesh.triangles[near])
        used = used[mesh.at_border[used]]
        if len(used) < FEWEST_ON_RING:
            return None
        rings = Rings.about(axis, mesh.vertices, used, tolerance)
        more = np.union1d(on, used[rings.of_vertex[used] >= 0])
        if len(more) == len(on):
            return near, rings
        on = more


@dataclass(frozen=True, eq=False)
class _Beyond:
    """The facets beyond the ends of rows of bands."""

    rings: Rings
    bands: list[Band]
    mesh: _Mesh

    def __call__(self, ring: int, band: int) -> tuple[float, float, bool] | None:
        """Angle and width of a facet that meets a band smoothly at a ring, and whether it is a strip."""
        members = set(self.mesh.of_triangle[self.bands[band].triangles].tolist())
        for member in sorted(members):
            for other, angle in self.mesh.facets[member].angles.items():
                if other not in members and abs(angle) < SMOOTH_ANGLE:
                    corners = np.unique(self.mesh.triangles[self.mesh.facets[other].triangles])
                    if (self.rings.of_vertex[corners] == ring).sum() >= _AN_EDGE:
                        return (
                            angle,
                            self.mesh.facets[other].width,
                            self.mesh.facets[other].provenance.kind == "approximate",
                        )
        return None


def coarse_errors(
    pieces: Sequence[TurnedPiece], facets: Sequence[Facet], vertices: Vertices, triangles: Triangles
) -> dict[int, float]:
    """How far off normals are if coarse rings are round [rad], for the facets of pieces that are not smooth."""
    found = {}
    for piece in pieces:
        for facet in [] if piece.smooth else piece.facets:
            corners = vertices[np.unique(triangles[facets[facet].triangles])]
            corners = np.vstack([corners, facets[facet].centroid])
            unit = facets[facet].normal / np.linalg.norm(facets[facet].normal)
            round_ones = piece.shape.directions(corners)
            round_ones = round_ones[round_ones.any(axis=1)]
            off = np.arctan2(np.linalg.norm(np.cross(round_ones, unit), axis=1), np.abs(round_ones @ unit))
            found[facet] = float(off.max(initial=0.0)) + piece.profile_error
    return found


def _of_piece(
    piece: Piece, bands: list[Band], rings: Rings, free: _Free, vertices: Vertices, noise: float, number: int
) -> Iterator[TurnedPiece]:
    for kind in ("smooth", "uneven", "coarse"):
        chosen = [bands[band] for band in piece.bands if bands[band].kind == kind]
        members = free.whole(np.concatenate([band.triangles for band in chosen])) if chosen else []
        if members and (kind != "coarse" or piece.curved or any(free.folded(band, rings) for band in chosen)):
            free.facet[members] = False
            reach = max(float(rings.reach[list(band.ends)].max()) for band in chosen)
            off = _axis_error(rings, vertices, noise, reach)
            yield TurnedPiece(piece.shape, members, piece.error, off, kind == "smooth", number)


def _axis_error(rings: Rings, vertices: Vertices, noise: float, distance: float) -> float:
    """How far normals at a distance from the axis may be off by its place and tilt, as the rings know these [rad]."""
    on = np.flatnonzero(rings.of_vertex >= 0)
    reach, height = rings.axis.places(vertices[on])
    number = rings.of_vertex[on]
    off = max(
        float(np.abs(reach - rings.reach[number]).max()), float(np.abs(height - rings.height[number]).max()), noise
    )
    extent = max(float(np.ptp(rings.height)), float(rings.reach.max()))
    return _AXIS_ERRORS * off * (1 / extent + 1 / distance)


def _borders(triangles: Triangles, facet: OfTriangle, count: int) -> EdgeEnds:
    """The edges between facets."""
    across = neighbours(triangles, count)
    triangle, side = np.nonzero((across < 0) | (facet[:, None] != facet[across]))
    ends = np.stack([triangles[triangle, side], triangles[triangle, (side + 1) % 3]], axis=1)
    return np.unique(np.sort(ends, axis=1), axis=0)
