"""What the bodies of an assembly in space look like: plane facets with their holes, triangles, edges."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fixture_design.assembly.assembly import AssemblyBody
from fixture_design.assembly.convex_pieces import surrounded
from fixture_design.assembly.round_facets import facets_of
from fixture_design.viewing.scene.shapes import Mesh, Points3, Segments3, Vector3


@dataclass(frozen=True, eq=False)
class DrawnFacet:
    """A plane facet: its outward normal, and rings of corners, outer ones counter-clockwise seen from outside."""

    normal: Vector3
    rings: tuple[Points3, ...]


@dataclass(frozen=True, eq=False)
class DrawnBody:
    """A body as it is drawn, in W or in the moving body's frame.

    Attributes:
        facets: with holes.  mesh: the same as triangles.  edges: all segments where two facets meet.
    """

    facets: tuple[DrawnFacet, ...]
    mesh: Mesh
    edges: Segments3

    @cached_property
    def corners(self) -> Points3:
        return self.mesh.vertices


def drawn(body: AssemblyBody) -> DrawnBody:
    """A body in space.

    Raises:
        InputError: as `state_graph`.
    """
    import shapely  # noqa: PLC0415 - only where there are bodies in space
    from shapely.geometry.polygon import orient  # noqa: PLC0415 - as above

    solid = facets_of(body)
    facets, triangles = [], []
    for normal, offset, border in zip(solid.normals, solid.offsets, solid.borders, strict=True):
        basis = np.linalg.svd(normal[None])[2][1:]
        if np.cross(*basis) @ normal < 0:
            basis = basis[::-1]

        def lifted(ring, basis=basis, origin=offset * normal) -> Points3:
            return np.array(ring.coords)[:-1] @ basis + origin

        area = surrounded(border @ basis.T)
        polygons = [orient(polygon) for polygon in shapely.get_parts(area)]
        rings = [lifted(ring) for polygon in polygons for ring in (polygon.exterior, *polygon.interiors)]
        facets.append(DrawnFacet(normal, tuple(rings)))
        triangles += [
            lifted(orient(each).exterior) for each in shapely.get_parts(shapely.constrained_delaunay_triangles(area))
        ]
    corners = np.concatenate(triangles)
    mesh = Mesh(corners, np.arange(len(corners)).reshape(-1, 3))
    return DrawnBody(tuple(facets), mesh, np.concatenate(solid.borders))
