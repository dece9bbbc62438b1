"""The geometry of a part in its own frame P: triangles, facets, and Drake's distance to its surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import read_only
from fixture_design.contacts import Provenance
from fixture_design.geometry.distance import DistanceField
from fixture_design.geometry.facets import Facet, Facets, facet_notes, facets_of
from fixture_design.geometry.flats import judged_again
from fixture_design.geometry.piece import Piece, SmoothPatch
from fixture_design.geometry.planes import neighbours
from fixture_design.geometry.shapes import (
    DirectionMask,
    Directions,
    OfTriangle,
    PerVertex,
    Triangles,
    Vector3,
    Vertices,
)
from fixture_design.geometry.smooth_regions import Region, fit_tolerance, may_be_round, part_size, smooth_surfaces
from fixture_design.geometry.smooth_surface import RoundShape, SmoothSurface
from fixture_design.geometry.turned import TurnedPiece, coarse_errors, turned_pieces
from fixture_design.geometry.winding import shells, winding_number
from fixture_design.tolerances import MERGE_VERTICES, ON_EDGE_ROUNDINGS


@dataclass(frozen=True, eq=False)
class PartGeometry:
    """A solid bounded by closed shells of triangles. What takes time is computed when first asked for, once.

    Attributes:
        name: for messages.
        vertices: shape (v, 3) [m].  triangles: shape (t, 3), counter-clockwise seen from outside.
        rounding: shape (v,), how far each vertex may be from what was meant [m].
        read_notes: what was mended or looks doubtful on reading, for people.
        faceted: no facet stands for a piece of a round surface.
        given: round surfaces that are known exactly, with the triangles that stand for them.
    """

    name: str
    vertices: Vertices
    triangles: Triangles
    rounding: PerVertex
    read_notes: tuple[str, ...] = ()
    faceted: bool = False
    given: tuple[SmoothPatch, ...] = ()

    @classmethod
    def of_pieces(
        cls, name: str, pieces: Sequence[Piece], notes: Sequence[str] = (), faceted: bool = False
    ) -> PartGeometry:
        """The sound pieces as one part. Their vertices stay apart: touching solids are shells of their own."""
        starts = np.cumsum([0, *(len(piece.vertices) for piece in pieces)])
        triangles = np.vstack([piece.triangles + start for piece, start in zip(pieces, starts, strict=False)])
        triangles.flags.writeable = False
        firsts = np.cumsum([0, *(len(piece.triangles) for piece in pieces)]).tolist()
        return cls(
            name,
            read_only(np.vstack([piece.vertices for piece in pieces])),
            triangles,
            read_only(np.concatenate([piece.rounding for piece in pieces])),
            (*notes, *(note for piece in pieces for note in piece.notes)),
            faceted,
            tuple(
                replace(patch, triangles=patch.triangles + first)
                for piece, first in zip(pieces, firsts, strict=False)
                for patch in piece.smooth
            ),
        )

    @property
    def notes(self) -> tuple[str, ...]:
        """What was mended, and what facets were taken for, for people."""
        return (*self.read_notes, *facet_notes(self.name, self.facets, self._facets.noise))

    @property
    def low(self) -> Vector3:
        return self.vertices.min(axis=0)

    @property
    def high(self) -> Vector3:
        return self.vertices.max(axis=0)

    @property
    def box_center(self) -> Vector3:
        """Centre of the bounding box in P, shape (3,) [m]."""
        return (self.low + self.high) / 2

    @cached_property
    def half_diagonal(self) -> float:
        """Half the diagonal of the bounding box [m]."""
        return float(np.linalg.norm(self.high - self.low)) / 2

    @cached_property
    def on_edge(self) -> float:
        """How near to an edge a point counts as on it [m]: no nearer than the edge itself is known."""
        return max(
            2 * self.half_diagonal * MERGE_VERTICES,
            ON_EDGE_ROUNDINGS * max(float(self.rounding.max()), self._facets.noise),
        )

    @cached_property
    def _facets(self) -> Facets:
        return facets_of(self.vertices, self.triangles, self.rounding, self.faceted)

    @property
    def facets(self) -> tuple[Facet, ...]:
        """The plane faces, in the order of their names."""
        return self._facets.facets

    @cached_property
    def smooth_surfaces(self) -> tuple[SmoothSurface, ...]:
        """The round surfaces that facets stand for, in the order of their names; of a faceted part those given."""
        noise = max(float(self.rounding.max()), self._facets.noise)
        return smooth_surfaces(
            self.facets,
            self.vertices,
            self.triangles,
            noise,
            self._given_regions,
            self._turned,
            look=not self.faceted,
        )

    @cached_property
    def _turned(self) -> tuple[TurnedPiece, ...]:
        """The pieces of surfaces of revolution that have rings of vertices; of a faceted part none."""
        if self.faceted:
            return ()
        noise = max(float(self.rounding.max()), self._facets.noise)
        tolerance, size = fit_tolerance(self.vertices, noise), part_size(self.vertices)
        taken = sorted(self._given_facets)
        mesh = (self.vertices, self.triangles, self.facets, self.facet_of_triangle)
        return tuple(turned_pieces(*mesh, taken, noise, tolerance, size))

    @cached_property
    def _turned_facets(self) -> frozenset[int]:
        return frozenset(facet for piece in self._turned for facet in piece.facets)

    @cached_property
    def _given_regions(self) -> list[Region]:
        """The given surfaces, with facets in the place of triangles."""
        return [
            (
                RoundShape(patch.kind, patch.point, patch.axis, patch.radius, patch.ring),
                np.unique(self.facet_of_triangle[patch.triangles]).tolist(),
            )
            for patch in self.given
        ]

    @cached_property
    def _given_facets(self) -> frozenset[int]:
        return frozenset(facet for _, members in self._given_regions for facet in members)

    @cached_property
    def _surface_of_facet(self) -> dict[int, SmoothSurface]:
        return {int(facet): surface for surface in self.smooth_surfaces for facet in surface.facets}

    @cached_property
    def _judged_again(self) -> dict[int, Provenance]:
        doubts = coarse_errors(self._turned, self.facets, self.vertices, self.triangles)
        return judged_again(self.facets, self._surface_of_facet, doubts, self.vertices, self.triangles)

    def surface_of_facet(self, facet: int) -> SmoothSurface | None:
        """The round surface that a facet stands for, if it is known."""
        return self._surface_of_facet.get(facet) if self._may_be_round(facet) else None

    def provenance_of(self, facet: int) -> Provenance:
        """Of a facet's normal, or of its round surface's; such surfaces are looked for when first asked."""
        own = self.facets[facet].provenance
        return self._judged_again.get(facet, own) if self._may_be_round(facet) else own

    def _may_be_round(self, facet: int) -> bool:
        return facet in self._given_facets or facet in self._turned_facets or may_be_round(self.facets[facet])

    @cached_property
    def facet_of_triangle(self) -> OfTriangle:
        """Index into `facets` for every triangle, shape (t,)."""
        number = np.empty(len(self.triangles), dtype=np.int64)
        for index, facet in enumerate(self.facets):
            number[facet.triangles] = index
        return number

    @cached_property
    def shell_of_triangle(self) -> OfTriangle:
        """Which closed shell every triangle is of, shape (t,)."""
        return shells(self.triangles, len(self.vertices))

    @cached_property
    def triangle_neighbours(self) -> Triangles:
        """The triangle across each side of each triangle, shape (t, 3); -1 where more than two meet."""
        return neighbours(self.triangles, len(self.vertices))

    @cached_property
    def surface(self) -> DistanceField:
        """Drake's signed distance to the surface."""
        return DistanceField(self.vertices, self.triangles, self.name)

    @cached_property
    def is_one_shell(self) -> bool:
        """Whether the surface is a single closed shell with two triangles at each edge.

        Then there are no cavities, and no solids that may overlap, or touch along a face or an edge.
        """
        return bool(self.shell_of_triangle.max() == 0 and (self.triangle_neighbours >= 0).all())

    @cached_property
    def triangle_boxes(self) -> tuple[Float[np.ndarray, "3 t"], Float[np.ndarray, "3 t"]]:
        """Lowest and highest corner of each triangle's box, shape (3, t) each: a coordinate at a time is faster [m]."""
        corners = self.vertices[self.triangles]
        return np.ascontiguousarray(corners.min(axis=1).T), np.ascontiguousarray(corners.max(axis=1).T)

    def inside(self, points: Directions) -> DirectionMask:
        """Whether each point, shape (n, 3), is inside the material; not meant for points on the surface.

        Solids that overlap or touch are one: a winding number says so, Drake's sign (of the nearest triangle) does not.
        """
        if self.is_one_shell:
            return np.array([self.surface.at(point)[0] < 0 for point in points], dtype=bool)
        return np.array([winding_number(self.vertices, self.triangles, point) > 0.5 for point in points], dtype=bool)
