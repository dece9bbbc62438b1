"""What the part and the bodies look like: meshes in W, sharp edges, and where everything is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from fixture_design.contacts import Contact, tangents, unit_normal
from fixture_design.geometry import PartGeometry, Polygon, load_geometry, load_part, sharp_edges
from fixture_design.layout import Body, Layout, Part, Pose, Verdict
from fixture_design.viewing.palette import EDGES, PART, ROLE_COLORS, ROLE_INKS
from fixture_design.viewing.scene.drawn_sizes import ASIDE, FACET, SHEET
from fixture_design.viewing.scene.scene import Label, Thing
from fixture_design.viewing.scene.shapes import Box, Lines, Mesh, Points3, Segments3, Vector3
from fixture_design.viewing.scene.space import lifted, lifted_rows
from fixture_design.viewing.scene.tessellation import hull_of

#: How much of what is behind a solid shows: contacts are inside and behind.
_PART_OPACITY, _BODY_OPACITY = 0.36, 0.3

#: Parts with less than this of sharp edges a triangle are drawn with them; else they are all edges.
_EDGES_A_TRIANGLE = 1.0


@dataclass(frozen=True, eq=False)
class Solid:
    """A part in W: its mesh and edges, its middle, and half its diagonal [m]."""

    mesh: Mesh
    edges: Segments3
    center: Vector3
    size: float

    @cached_property
    def hull(self) -> Points3:
        """The corners of its convex hull, shape (n, 3) [m]."""
        return hull_of(self.mesh.vertices)


def solid_of(layout: Layout, geometry: PartGeometry | Polygon | None = None) -> Solid | None:
    """The layout's part; None for layouts of contacts alone.

    Args:
        geometry: the part's, where it is loaded already.

    Raises:
        InputError: the part cannot be read.
    """
    if layout.part is None:
        return None
    geometry = geometry or load_geometry(layout.part)
    if isinstance(geometry, Polygon):
        return _sheet(layout.part.pose.points(geometry.vertices), geometry.half_diagonal)
    return _placed(geometry, layout.part.pose)


def _placed(geometry: PartGeometry, pose: Pose) -> Solid:
    edges = sharp_edges(geometry)
    if len(edges) > _EDGES_A_TRIANGLE * len(geometry.triangles):
        edges = edges[:0]
    mesh = Mesh(pose.points(geometry.vertices), geometry.triangles.astype(np.int64))
    moved = pose.points(edges.reshape(-1, 3)).reshape(-1, 2, 3)
    return Solid(mesh, moved, pose.points(geometry.box_center[None])[0], geometry.half_diagonal)


def _sheet(corners: np.ndarray, size: float) -> Solid:
    """A polygon as a thin plate about z = 0."""
    import shapely  # noqa: PLC0415 - only where there are polygons
    from shapely.geometry.polygon import orient  # noqa: PLC0415 - as above

    count, half = len(corners), SHEET * size / 2
    index = {tuple(corner): number for number, corner in enumerate(corners.tolist())}
    pieces: Any = shapely.constrained_delaunay_triangles(shapely.Polygon(corners)).geoms
    flat = np.array([[index[xy] for xy in orient(piece).exterior.coords[:-1]] for piece in pieces])
    here, there = np.arange(count), (np.arange(count) + 1) % count
    walls = [np.column_stack([here, there, there + count]), np.column_stack([here, there + count, here + count])]
    low, high = (np.column_stack([corners, np.full(count, z)]) for z in (-half, half))
    mesh = Mesh(np.vstack([low, high]), np.vstack([flat[:, ::-1], flat + count, *walls]))
    rims = [np.stack([level[here], level[there]], axis=1) for level in (low, high)]
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    return Solid(mesh, np.vstack([*rims, np.stack([low, high], axis=1)]), lifted(middle), size)


def where(solid: Solid | None, verdict: Verdict) -> tuple[Vector3, float]:
    """Middle and half diagonal of what is looked at [m]; of layouts of contacts alone, of their points."""
    if solid is not None:
        return solid.center, solid.size
    points = lifted_rows(np.array([contact.point for contact in verdict.contacts]))
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    spread = float(np.linalg.norm(np.ptp(points, axis=0))) / 2
    return middle, spread or verdict.length or 1.0


def part_things(solid: Solid | None, contacts: Sequence[Contact], size: float) -> Iterator[Thing]:
    """The part, translucent, and its edges; where there is none, pieces of its facets, one for each normal."""
    if solid is None:
        yield from _facets(contacts, size)
        return
    yield Thing("part/solid", solid.mesh, PART, _PART_OPACITY)
    if len(solid.edges):
        yield Thing("part/edges", Lines(solid.edges), EDGES)


def _facets(contacts: Sequence[Contact], size: float) -> Iterator[Thing]:
    """A small plate behind each normal, as far as the facets of its contact reach."""
    for number, contact in enumerate(contacts):
        planar = len(contact.point) == 2
        normals = [(k, lifted(unit_normal(normal))) for k, clause in enumerate(contact.clauses) for normal in clause]
        for k, (clause, unit) in enumerate(normals):
            first = np.cross([0.0, 0.0, 1.0], unit) if planar else tangents(unit)[0]
            axes = np.column_stack([first, np.cross(unit, first), unit])
            sides = size * np.array([FACET, SHEET if planar else FACET, 0.1 * FACET])
            others = [(other if mine != clause else -other) for j, (mine, other) in enumerate(normals) if j != k]
            middle = lifted(contact.point) - sides[2] / 2 * unit + FACET * size / 2 * _aside(unit, others)
            yield Thing(f"part/facets/{number}/{k}", Box(middle, axes, sides), PART, _PART_OPACITY)


def _aside(unit: Vector3, others: Sequence[Vector3]) -> Vector3:
    """Along a facet away from where it ends at others: at convex edges against their normals, at concave along them."""
    across = np.sum(others, axis=0) if others else np.zeros(3)
    across = across - (across @ unit) * unit
    length = float(np.linalg.norm(across))
    return across / length if length > SHEET else np.zeros(3)


def body_things(layout: Layout, size: float) -> Iterator[Thing | Label]:
    """The fixture bodies in the colour of their role, with their names.

    Args:
        size: half diagonal of the part [m].
    """
    for number, body in enumerate(layout.bodies):
        solid = _body(body)
        yield Thing(f"bodies/{number}/solid", solid.mesh, ROLE_COLORS[body.role], _BODY_OPACITY)
        if len(solid.edges):
            yield Thing(f"bodies/{number}/edges", Lines(solid.edges), ROLE_COLORS[body.role])
        corner = solid.mesh.vertices.min(axis=0) - np.array([0.0, 0.0, ASIDE * size])
        yield Label(f"bodies/{number}", body.name, corner, ROLE_INKS[body.role])


@lru_cache(maxsize=64)  # of the same body: whoever moves an element has not moved the vise
def _body(body: Body) -> Solid:
    return _placed(load_part(Part(body.name, "urdf", body.file, None, 1.0, body.pose)), body.pose)
