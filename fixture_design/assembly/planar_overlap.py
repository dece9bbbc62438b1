"""Whether two planar parts overlap, exactly, for many configurations at once.

Both are cut into convex pieces at their vertices. The interiors of the parts meet if and only if those of two pieces
do, since the pieces' interiors are dense in the parts; and two convex polygons are apart if and only if the line of one
of their edges separates them. The largest separation over these lines is, where negative, minus the shortest way out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.assembly.features import PlanarFeatures


@dataclass(frozen=True, eq=False)
class ConvexPiece:
    """A convex polygon, counter-clockwise, with unit outward normals n . x <= offset; shapes (k, 2), (k,)."""

    vertices: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray

    @classmethod
    def of(cls, vertices: np.ndarray) -> ConvexPiece:
        along = np.roll(vertices, -1, axis=0) - vertices
        normals = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
        return cls(vertices, normals, np.einsum("ij,ij->i", normals, vertices))


def pieces_of(features: PlanarFeatures) -> tuple[ConvexPiece, ...]:
    """Convex pieces of all bodies of a side: a convex body as it is, the others as triangles."""
    return tuple(ConvexPiece.of(part) for polygon in features.polygons for part in _convex_parts(polygon))


def _convex_parts(polygon: np.ndarray) -> list[np.ndarray]:
    before, after = polygon - np.roll(polygon, 1, axis=0), np.roll(polygon, -1, axis=0) - polygon
    if (before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] >= 0).all():
        return [polygon]
    from shapely import constrained_delaunay_triangles, get_parts
    from shapely.geometry import Polygon as ShapelyPolygon
    from shapely.geometry.polygon import orient

    triangles = get_parts(constrained_delaunay_triangles(ShapelyPolygon(polygon)))
    return [np.array(orient(triangle).exterior.coords)[:-1] for triangle in triangles]


def overlap(moving: tuple[ConvexPiece, ...], fixed: tuple[ConvexPiece, ...], q: np.ndarray) -> np.ndarray:
    """How deep the deepest two pieces overlap [m], shape (n,); negative: how far apart the nearest two are at least.

    Args:
        moving: pieces in the moving body's frame.  fixed: in W.  q: shape (n, 3).
    """
    c, s = np.cos(q[:, 2]), np.sin(q[:, 2])
    deepest = np.full(len(q), -np.inf)
    # R^T, so that points of W are seen from the moving body
    back = np.stack([np.stack([c, s], axis=-1), np.stack([-s, c], axis=-1)], axis=-2)
    for mine in moving:
        turned = np.einsum("nji,vj->nvi", back, mine.vertices) + q[:, None, :2]
        for theirs in fixed:
            by_theirs = (turned @ theirs.normals.T - theirs.offsets).min(axis=1).max(axis=1)
            seen = np.einsum("nij,nvj->nvi", back, theirs.vertices[None] - q[:, None, :2])
            by_mine = (seen @ mine.normals.T - mine.offsets).min(axis=1).max(axis=1)
            deepest = np.maximum(deepest, -np.maximum(by_theirs, by_mine))
    return deepest
