"""The geometry of a part in its own frame P: triangles, facets, and Drake's distance to its surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fixture_design.arrays import Weights, read_only
from fixture_design.contacts import Provenance
from fixture_design.geometry.broad import Boxes, BoxTree, boxes_of
from fixture_design.geometry.distance import DistanceField
from fixture_design.geometry.facet_data import Region, fit_tolerance, may_be_round, part_size
from fixture_design.geometry.facets import Facet, Facets, facet_notes, facets_of
from fixture_design.geometry.flats import judged_again
from fixture_design.geometry.piece import Piece, SmoothPatch
from fixture_design.geometry.planes import neighbours
from fixture_design.geometry.shapes import (
    DirectionMask,
    Directions,
    FacetVectors,
    OfTriangle,
    PerVertex,
    Triangles,
    Vector3,
    Vertices,
)
from fixture_design.geometry.smooth_regions import smooth_surfaces
from fixture_design.geometry.smooth_surface import RoundShape, SmoothSurface
from fixture_design.geometry.turned import TurnedPiece, coarse_errors, turned_pieces
from fixture_design.geometry.winding import shells, winding_numbers
from fixture_design.tolerances import MERGE_VERTICES, ON_EDGE_ROUNDINGS, ROUGH_RINGS


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

    @cached_property
    def notes(self) -> tuple[str, ...]:
        """What was mended, and what facets were taken for, for people."""
        return (*self.read_notes, *facet_notes(self.name, self.facets, self._facets.noise))

    @cached_property
    def low(self) -> Vector3:
        return self.vertices.min(axis=0)

    @cached_property
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
        mesh = (self.vertices, self.triangles, self.facets, self.facet_of_triangle)
        taken = {int(facet) for _, members in self._given_regions for facet in members}
        found: list[TurnedPiece] = []
        for allowed in (tolerance, *(rough * size for rough in ROUGH_RINGS)):
            if allowed >= tolerance:
                found += turned_pieces(*mesh, sorted(taken), noise, allowed, size, len(found))
                taken |= {facet for piece in found for facet in piece.facets}
        return tuple(found)

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
    def _maybe_round(self) -> frozenset[int]:
        """The facets that may stand for a round surface."""
        given = (facet for _, members in self._given_regions for facet in members)
        return frozenset(
            [*given, *self._turned_facets, *(index for index, facet in enumerate(self.facets) if may_be_round(facet))]
        )

    @cached_property
    def _surface_of_facet(self) -> dict[int, SmoothSurface]:
        return {int(facet): surface for surface in self.smooth_surfaces for facet in surface.facets}

    @cached_property
    def _judged_again(self) -> dict[int, Provenance]:
        doubts = coarse_errors(self._turned, self.facets, self.vertices, self.triangles)
        return judged_again(self.facets, self._surface_of_facet, doubts, self.vertices, self.triangles)

    def surface_of_facet(self, facet: int) -> SmoothSurface | None:
        """The round surface that a facet stands for, if it is known."""
        return self._surface_of_facet.get(facet) if facet in self._maybe_round else None

    def provenance_of(self, facet: int) -> Provenance:
        """Of a facet's normal, or of its round surface's; such surfaces are looked for when first asked."""
        own = self.facets[facet].provenance
        return self._judged_again.get(facet, own) if facet in self._maybe_round else own

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
    def shell_boxes(self) -> Boxes:
        """The box around each shell, shape (s, 3) each [m]."""
        low, high = self.triangle_tree.boxes
        count = int(self.shell_of_triangle.max()) + 1
        lowest, highest = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
        np.minimum.at(lowest, self.shell_of_triangle, low)
        np.maximum.at(highest, self.shell_of_triangle, high)
        return lowest, highest

    @cached_property
    def shell_volumes(self) -> Weights:
        """The signed volume of each shell, negative around cavities, shape (s,) [m^3]."""
        first, second, third = (self.vertices[self.triangles[:, corner]] - self.box_center for corner in range(3))
        return np.bincount(self.shell_of_triangle, np.einsum("ij,ij->i", first, np.cross(second, third))) / 6

    @cached_property
    def facet_units(self) -> FacetVectors:
        """The unit normal of every facet, shape (f, 3)."""
        normals = np.array([facet.normal for facet in self.facets])
        return read_only(normals / np.linalg.norm(normals, axis=1, keepdims=True))

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
    def triangle_tree(self) -> BoxTree:
        """The boxes around the triangles, to be asked which of them are near."""
        return BoxTree(boxes_of(self.vertices[self.triangles]))

    def inside(self, points: Directions) -> DirectionMask:
        """Whether each point, shape (n, 3), is inside the material; not meant for points on the surface.

        Solids that overlap or touch are one: a winding number says so, Drake's sign (of the nearest triangle) does not.
        """
        if self.is_one_shell:
            return self.surface.distances(points) < 0
        return winding_numbers(self.vertices, self.triangles, points) > 0.5
