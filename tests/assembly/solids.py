"""Prisms with any outline, with holes, and hulls, written as meshes."""

from pathlib import Path

import numpy as np
import shapely
from scipy.spatial import ConvexHull
from shapely.geometry import Polygon
from shapely.geometry.polygon import orient


def written(path: Path, points: np.ndarray, triangles: np.ndarray) -> dict:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles.tolist()]
    path.write_text("\n".join(lines) + "\n")
    return {"mesh": str(path)}


def hull(path: Path, points: np.ndarray) -> dict:
    """The convex hull of points as an OBJ file."""
    found = ConvexHull(points)
    outward = np.cross(
        points[found.simplices[:, 1]] - points[found.simplices[:, 0]],
        points[found.simplices[:, 2]] - points[found.simplices[:, 0]],
    )
    turned = np.einsum("ij,ij->i", outward, found.equations[:, :3]) < 0
    triangles = np.where(turned[:, None], found.simplices[:, ::-1], found.simplices)
    return written(path, points, triangles)


def prism(path: Path, outline: list, low: float, high: float, holes: list | None = None) -> dict:
    """A polygon with holes, from z = low to z = high, as an OBJ file."""
    area = orient(Polygon(outline, holes or []))
    points: list[list[float]] = []
    triangles: list[list[int]] = []
    flat = {}
    for ring in (area.exterior, *area.interiors):
        corners = list(ring.coords)[:-1]
        first = len(points) // 2
        for k, corner in enumerate(corners):
            flat[corner] = 2 * (first + k)
            points += [[*corner, low], [*corner, high]]
        for k in range(len(corners)):
            a, b = 2 * (first + k), 2 * (first + (k + 1) % len(corners))
            triangles += [[a, b, b + 1], [a, b + 1, a + 1]]
    for part in shapely.get_parts(shapely.constrained_delaunay_triangles(area)):
        a, b, c = (flat[corner] for corner in list(orient(part).exterior.coords)[:3])
        triangles += [[a, c, b], [a + 1, b + 1, c + 1]]
    return written(path, np.array(points), np.array(triangles))
