"""The closed shells of a mesh and which way they are wound: outward around solids, inward around cavities."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fixture_design.arrays import Indices, Weights, cross_products
from fixture_design.geometry.edges import Edges, edges_of
from fixture_design.geometry.piece import Piece, area_vectors
from fixture_design.geometry.shapes import Directions, OfTriangle, PerPoint, SideMask, Triangles, Vector3, Vertices
from fixture_design.tolerances import MERGE_VERTICES

#: Points times triangles looked at together: some tens of megabytes.
_AT_ONCE = 100_000


def shells(triangles: Triangles, vertex_count: int) -> OfTriangle:
    """Which shell each triangle belongs to, shape (t,): triangles that share an edge are of one shell."""
    edges = edges_of(triangles, vertex_count)
    return _connected(triangles, edges, edges.number >= 0)


def wound_outward(piece: Piece) -> Piece:
    """The closed piece with shells that are inside out turned; what lies inside of others may be cavities.

    A shell of negative volume with nothing around it is inside out, and so is then what it surrounds: within a turned
    shell, solid and cavity alternate. Elsewhere a shell of negative volume that others surround is a cavity.
    """
    nested = _Shells(piece.vertices, piece.triangles)
    outermost = {shell for shell in np.flatnonzero(nested.volumes < 0).tolist() if not nested.around(shell)}
    if not outermost:
        return piece
    wrong = set(outermost)
    for shell in range(len(nested.volumes)):
        if shell not in outermost and not outermost.isdisjoint(around := nested.around(shell)):
            outward = len(around) % 2 == 0
            if outward != (nested.volumes[shell] > 0):
                wrong.add(shell)
    turned = np.isin(nested.label, list(wrong))
    triangles = np.where(turned[:, None], piece.triangles[:, ::-1], piece.triangles)
    return replace(piece, triangles=triangles, notes=piece.note(f"{len(wrong)} shells were inside out and were turned"))


def without_sheets(piece: Piece) -> Piece:
    """The closed piece without shells that lie in one plane: they enclose nothing, however they are cut up.

    Raises:
        GeometryError: nothing else is there.
    """
    nested = _Shells(piece.vertices, piece.triangles)
    areas = np.bincount(nested.label, np.linalg.norm(area_vectors(piece.vertices, piece.triangles), axis=1))
    thin = np.flatnonzero(np.abs(nested.volumes) <= MERGE_VERTICES * piece.size * areas)
    flat = [shell for shell in thin if _is_flat(piece.vertices[nested.members[shell].ravel()], piece.size)]
    if not flat:
        return piece
    if len(flat) == len(areas):
        raise piece.error("the mesh encloses nothing: its shells have no thickness", expected="a solid")
    kept = ~np.isin(nested.label, flat)
    text = f"{len(flat)} shells without thickness taken out"
    return replace(piece, triangles=piece.triangles[kept], notes=piece.note(text))


def winding_number(vertices: Vertices, triangles: Triangles, point: Vector3) -> float:
    """How often the surface surrounds a point."""
    return float(winding_numbers(vertices, triangles, point[None])[0])


def winding_numbers(vertices: Vertices, triangles: Triangles, points: Directions) -> PerPoint:
    """How often the surface surrounds each point, shape (n, 3): the sum of the triangles' solid angles over 4 pi.

    Source: Van Oosterom and Strackee, The solid angle of a plane triangle, 1983.
    """
    step = max(1, _AT_ONCE // len(triangles))
    starts = range(0, len(points), step)
    return np.concatenate([np.zeros(0), *(_winding(vertices, triangles, points[s : s + step]) for s in starts)])


def _winding(vertices: Vertices, triangles: Triangles, points: Directions) -> PerPoint:
    corners = vertices[triangles]
    first, second, third = (corners[None, :, corner] - points[:, None] for corner in range(3))
    lengths = [np.sqrt(np.einsum("nti,nti->nt", edge, edge)) for edge in (first, second, third)]
    above = np.einsum("nti,nti->nt", first, cross_products(second, third))
    below = lengths[0] * lengths[1] * lengths[2]
    below += np.einsum("nti,nti->nt", first, second) * lengths[2]
    below += np.einsum("nti,nti->nt", second, third) * lengths[0]
    below += np.einsum("nti,nti->nt", third, first) * lengths[1]
    return np.arctan2(above, below).sum(axis=1) / (2 * np.pi)


@dataclass(frozen=True, eq=False)
class _Shells:
    """The shells of a closed mesh, solids that touch along an edge taken apart where each is closed by itself."""

    vertices: Vertices
    triangles: Triangles

    @cached_property
    def label(self) -> OfTriangle:
        """Which shell each triangle is of, shape (t,)."""
        edges = edges_of(self.triangles, len(self.vertices))
        whole = _connected(self.triangles, edges, edges.number >= 0)
        if (edges.uses == 2).all():
            return whole
        parts = _connected(self.triangles, edges, (edges.uses == 2)[edges.number])
        # an edge within one part may be used as often in one sense as in the other; if not, the part is not closed
        part = np.repeat(parts, 3)
        sense = np.where(self.triangles.ravel() == edges.ends[edges.number, 0], 1, -1)
        _, first, key = np.unique(edges.number * (parts.max() + 1) + part, return_index=True, return_inverse=True)
        unbalanced = part[first[np.bincount(key.ravel(), sense) != 0]]
        undivided = np.isin(whole, whole[np.isin(parts, unbalanced)])
        return np.unique(np.where(undivided, whole + parts.max() + 1, parts), return_inverse=True)[1].astype(np.int64)

    @cached_property
    def members(self) -> list[Triangles]:
        """The triangles of each shell."""
        order = np.argsort(self.label, kind="stable")
        return np.split(self.triangles[order], np.cumsum(np.bincount(self.label))[:-1])

    @cached_property
    def volumes(self) -> Weights:
        """Signed volume of each shell [m^3]: negative if it is wound inside out."""
        origin = self.vertices[[triangles[0, 0] for triangles in self.members]][self.label]
        first, second, third = (self.vertices[self.triangles[:, corner]] - origin for corner in range(3))
        return np.bincount(self.label, np.einsum("ij,ij->i", first, np.cross(second, third))) / 6

    @cached_property
    def boxes(self) -> tuple[Vertices, Vertices]:
        """Lowest and highest corner of each shell [m]."""
        corners = [self.vertices[triangles.ravel()] for triangles in self.members]
        return np.array([c.min(axis=0) for c in corners]), np.array([c.max(axis=0) for c in corners])

    def around(self, shell: int) -> set[int]:
        """The shells that surround this one."""
        low, high = self.boxes
        candidates = np.flatnonzero((low < low[shell]).all(axis=1) & (high > high[shell]).all(axis=1))
        point = self.vertices[self.members[shell][0]].mean(axis=0)
        return {
            other
            for other in candidates.tolist()
            if abs(winding_number(self.vertices, self.members[other], point)) > 0.5
        }


def _connected(triangles: Triangles, edges: Edges, linking: SideMask) -> OfTriangle:
    """Triangles linked by some of their sides (rows of `directed_edges`), numbered from 0, shape (t,)."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    owner: Indices = np.flatnonzero(linking) // 3
    nodes = len(triangles) + len(edges.ends)
    links = coo_array((np.ones(len(owner)), (owner, len(triangles) + edges.number[linking])), shape=(nodes, nodes))
    _, label = connected_components(links, directed=False)
    return np.unique(label[: len(triangles)], return_inverse=True)[1].astype(np.int64)


def _is_flat(points: Vertices, size: float) -> bool:
    extents = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return bool(extents[2] <= MERGE_VERTICES * size)
