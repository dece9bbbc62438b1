"""Polyhedral bodies in space with the features that form contact pairs: boxes, meshes and URDFs, convex or not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Points, Weights
from fixture_design.assembly.assembly import AssemblyBody
from fixture_design.assembly.body_parts import part_of
from fixture_design.assembly.convex_pieces import convex_pieces
from fixture_design.assembly.mesh_apices import corner_points, touching_apices
from fixture_design.assembly.mesh_edges import MeshEdges, mesh_edges
from fixture_design.assembly.polytope import Polytope
from fixture_design.errors import UnsupportedError
from fixture_design.layout import Pose

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry

#: As many facets that look like pieces of round surfaces are taken as the plane facets that they are: a polyhedron may
#: have its corners on a sphere. More stand for something round.
MOST_STRIPS = 40

#: A shell is convex if its hull has no more than this much more volume [-].
_CONVEX = 1e-6


@dataclass(frozen=True, eq=False)
class Polyhedron:
    """A polyhedral body. Of its apices and edges only the convex ones are listed: no others form pairs.

    Attributes:
        vertices: the convex apices, shape (v, 3) [m].
        edges: ends of the convex edges, shape (e, 2, 3).  outward: the sum of their two facets' normals, shape (e, 3).
        normals, offsets: of the facets, outward and unit, n . x = offset; shapes (f, 3), (f,).
        borders: of each facet segments, the inside to their left seen from outside, shape (k, 2, 3).
        rings: of each facet whether its border is one convex ring.
        pieces: convex pieces that make it.
    """

    vertices: Points
    edges: Float[np.ndarray, "_ 2 3"]
    outward: Points
    normals: Points
    offsets: Weights
    borders: tuple[Float[np.ndarray, "_ 2 3"], ...]
    rings: tuple[bool, ...]
    pieces: tuple[Polytope, ...]

    @classmethod
    def convex(cls, body: Polytope) -> Polyhedron:
        """A convex body, all of whose features can touch."""
        borders = [body.vertices[np.column_stack([ring, np.roll(ring, -1)])] for ring in body.corners]
        return cls(
            body.vertices, body.vertices[body.edges], body.outward(), body.normals, body.offsets, tuple(borders),
            (True,) * len(borders), (body,),
        )  # fmt: skip

    @classmethod
    def of_part(cls, geometry: PartGeometry, pose: Pose) -> Polyhedron:
        """A part, placed; facets in the order of their names.

        Raises:
            UnsupportedError: facets that do not meet in points, too many convex pieces.
        """
        edges = mesh_edges(geometry)
        heights = [
            geometry.vertices[np.unique(geometry.triangles[facet.triangles])] @ normal
            for facet, normal in zip(geometry.facets, geometry.facet_units, strict=True)
        ]
        offsets = np.array([(h.min() + h.max()) / 2 for h in heights])
        corners = corner_points(geometry, edges, offsets)
        ends = corners[np.searchsorted(edges.corners, edges.ends)]
        borders = _borders(edges, ends, len(offsets))
        pieces = _pieces(geometry, corners, edges, offsets, borders)
        normals = pose.vectors(geometry.facet_units)
        apices = pose.points(corners[touching_apices(geometry, edges, corners)])
        placed = pose.points(ends[edges.convex].reshape(-1, 3)).reshape(-1, 2, 3)
        return cls(
            apices[np.lexsort(np.round(apices, 9).T[::-1])],
            placed,
            normals[edges.facets[edges.convex]].sum(axis=1),
            normals,
            offsets + normals @ pose.translation,
            tuple(pose.points(border.reshape(-1, 3)).reshape(-1, 2, 3) for border in borders),
            tuple(_is_ring(border, normal) for border, normal in zip(borders, geometry.facet_units, strict=True)),
            tuple(Polytope.hull_of(pose.points(piece.vertices)) for piece in pieces),
        )


def polyhedron_of(body: AssemblyBody) -> Polyhedron:
    """The body, in W or in the moving body's frame.

    Raises:
        GeometryError: a mesh that cannot be read.
        UnsupportedError: round surfaces of many facets; else as `Polyhedron.of_part`.
    """
    if body.box is not None:
        points = (np.array(list(np.ndindex(2, 2, 2)), dtype=np.float64) - 0.5) * body.box
        return Polyhedron.convex(Polytope.hull_of(points if body.pose is None else body.pose.points(points)))
    geometry = part_of(body)
    _refuse_round(geometry)
    return Polyhedron.of_part(geometry, body.pose or Pose.identity(3))


def strips(geometry: PartGeometry) -> int:
    """How many facets stand for round surfaces."""
    return sum(len(surface.facets) for surface in geometry.smooth_surfaces)


def _refuse_round(geometry: PartGeometry) -> None:
    count = strips(geometry)
    if count > MOST_STRIPS:
        names = ", ".join(surface.name for surface in geometry.smooth_surfaces)
        raise UnsupportedError(
            f"{geometry.name!r} has round surfaces ({names}), and round features form no contact pairs",
            found=f"{count} facets that stand for them",
            expected=f"at most {MOST_STRIPS} such facets, which are then taken as they are: a prism within its circles",
        )


def _borders(edges: MeshEdges, ends: np.ndarray, count: int) -> list[np.ndarray]:
    """Of each facet the segments around it: edges have their first facet to the left, the second to the right."""
    return [
        np.concatenate([ends[edges.facets[:, 0] == facet], ends[edges.facets[:, 1] == facet][:, ::-1]])
        for facet in range(count)
    ]


def _is_ring(border: np.ndarray, normal: np.ndarray) -> bool:
    """Whether no corner of a border is on the outside of one of its segments: one convex ring."""
    across = np.cross(border[:, 1] - border[:, 0], normal)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    beyond = border[:, 0] @ across.T - np.einsum("ij,ij->i", across, border[:, 0])
    return bool(beyond.max() <= _CONVEX * np.ptp(border[:, 0], axis=0).max())


def _pieces(
    geometry: PartGeometry, corners: Points, edges: MeshEdges, offsets: Weights, borders: list[np.ndarray]
) -> tuple[Polytope, ...]:
    """The hulls of the shells where each is convex, else pieces cut by the facets' planes."""
    shell_of = np.zeros(len(geometry.vertices), dtype=int)
    shell_of[geometry.triangles] = geometry.shell_of_triangle[:, None]
    hulls = [Polytope.hull_of(corners[shell_of[edges.corners] == k]) for k in range(len(geometry.shell_volumes))]
    volumes = np.array([hull.volume for hull in hulls])
    if (volumes <= geometry.shell_volumes * (1 + _CONVEX)).all():
        return tuple(hulls)
    facets = list(zip(geometry.facet_units, offsets.tolist(), borders, strict=True))
    return convex_pieces(corners, facets, geometry.inside)
