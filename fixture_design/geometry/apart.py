"""How far two solids are apart, by their true surfaces."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Weights
from fixture_design.geometry.broad import box_pairs, boxes_of
from fixture_design.geometry.features import EdgeEnds, Features
from fixture_design.geometry.shapes import Vector3


def nearest_place(part: Features, body: Features) -> tuple[float, Vector3]:
    """The distance between two solids that do not touch [m], and where: vertices to surfaces, and between edges."""
    best, place = np.inf, part.geometry.vertices[0]
    for mine, theirs in ((part, body), (body, part)):
        # a vertex is no nearer to the other solid than to its box
        points = mine.geometry.vertices
        bounds = np.linalg.norm(points - np.clip(points, theirs.geometry.low, theirs.geometry.high), axis=1)
        for index in np.argsort(bounds, kind="stable").tolist():
            if bounds[index] >= best:
                break
            distance = abs(theirs.geometry.surface.at(points[index])[0])
            if distance < best:
                best, place = distance, points[index]
    one, other = box_pairs(boxes_of(part.edges), boxes_of(body.edges), best)
    between = _between(part.edges[one], body.edges[other])
    if len(between) and between.min() < best:
        nearest = int(between.argmin())
        best, place = between[nearest], part.edges[one[nearest]].mean(axis=0)
    return float(best), place


def _between(first: EdgeEnds, second: EdgeEnds) -> Weights:
    """Distance between edges where their common perpendicular meets both, shape (e,) [m].

    Infinite elsewhere: there the nearest point of one of them is a vertex.
    """
    along, along_2 = first[:, 1] - first[:, 0], second[:, 1] - second[:, 0]
    normals = np.cross(along, along_2)
    sizes = np.einsum("nj,nj->n", normals, normals)
    known = sizes > 0
    sizes = np.where(known, sizes, 1.0)
    between = second[:, 0] - first[:, 0]
    t = np.einsum("nj,nj->n", np.cross(between, along_2), normals) / sizes
    u = np.einsum("nj,nj->n", np.cross(between, along), normals) / sizes
    meets = known & (t >= 0) & (t <= 1) & (u >= 0) & (u <= 1)
    return np.where(meets, np.abs(np.einsum("nj,nj->n", between, normals)) / np.sqrt(sizes), np.inf)
