"""Facets: the plane faces of a part, with names, outward normals, neighbours and how far each normal may be off."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices
from fixture_design.contacts import Provenance
from fixture_design.geometry.piece import area_vectors
from fixture_design.geometry.planes import neighbours, plane_numbers
from fixture_design.geometry.shapes import (
    FacetVectors,
    OfTriangle,
    PerVertex,
    Triangles,
    TriangleVectors,
    Vector3,
    Vertices,
)
from fixture_design.geometry.smoothness import FacetMeasures, provenances
from fixture_design.geometry.widths import widths_and_angles


@dataclass(frozen=True, eq=False)
class Facet:
    """A plane face.

    Attributes:
        name: "facet 1", ... in the order of the centroids' coordinates: the same from run to run.
        normal: outward, twice the area long, not normalised, shape (3,) [m^2].
        centroid: of its area, shape (3,) [m].
        triangles: which triangles it is made of.
        provenance: exact with the angle that rounding allows, or approximate: a strip of a curved surface.
        width: smallest width [m].  noise: angle by which the rounding of its vertices may turn it [rad].
        angles: {index of a neighbouring facet: dihedral angle [rad], positive on convex edges}.
    """

    name: str
    normal: Vector3
    centroid: Vector3
    triangles: Indices
    provenance: Provenance
    width: float
    noise: float
    angles: dict[int, float]

    @property
    def normal_error(self) -> float:
        """Largest angle between the normal and the true surface's [rad]."""
        return self.provenance.normal_error


def facets_of(vertices: Vertices, triangles: Triangles, rounding: PerVertex) -> tuple[Facet, ...]:
    """The facets of a sound mesh, in the order of their names.

    Args:
        vertices: shape (v, 3) [m].  triangles: shape (t, 3).  rounding: of each vertex, shape (v,) [m].
    """
    areas = area_vectors(vertices, triangles)
    grown = plane_numbers(vertices, triangles, rounding)
    number = _in_order(vertices, triangles, areas, grown)
    normals = _sums(areas, number)
    centroids = _centroids(vertices, triangles, areas, number)
    angles = _dihedral_angles(vertices, triangles, normals, number)
    order = np.argsort(number, kind="stable")
    members = np.split(order, np.cumsum(np.bincount(number))[:-1])
    owner_and_vertex = np.unique(np.repeat(number, 3) * len(vertices) + triangles.ravel())
    starts = np.flatnonzero(np.diff(owner_and_vertex // len(vertices), prepend=-1))
    widths, noise = widths_and_angles(vertices, rounding, owner_and_vertex % len(vertices), starts, normals)
    measures = [FacetMeasures(*values) for values in zip(widths.tolist(), noise.tolist(), angles, strict=True)]
    known = zip(members, provenances(measures), measures, strict=True)
    return tuple(
        Facet(f"facet {i + 1}", normals[i], centroids[i], mine, origin, facet.width, facet.noise, dict(facet.angles))
        for i, (mine, origin, facet) in enumerate(known)
    )


def _sums(values: Float[np.ndarray, "t n"], number: OfTriangle) -> Float[np.ndarray, "f n"]:
    """Rows added up facet by facet."""
    sums = np.zeros((int(number.max()) + 1, values.shape[1]))
    np.add.at(sums, number, values)
    return sums


def _centroids(vertices: Vertices, triangles: Triangles, areas: TriangleVectors, number: OfTriangle) -> FacetVectors:
    weights = np.linalg.norm(areas, axis=1, keepdims=True)
    return _sums(vertices[triangles].mean(axis=1) * weights, number) / _sums(weights, number)


def _in_order(vertices: Vertices, triangles: Triangles, areas: TriangleVectors, number: OfTriangle) -> OfTriangle:
    """Facet numbers by centroid, then normal, then area: rounded, so that the order does not hang on the last bit."""
    size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    keys = np.hstack([_centroids(vertices, triangles, areas, number) / size, _sums(areas, number) / size**2])
    rank = np.empty(len(keys), dtype=np.int64)
    rank[np.lexsort(np.round(keys, 7).T[::-1])] = np.arange(len(keys))
    return rank[number]


def _dihedral_angles(
    vertices: Vertices, triangles: Triangles, normals: FacetVectors, number: OfTriangle
) -> list[dict[int, float]]:
    """For each facet the angle to each neighbour, positive on convex edges; the largest one if they meet twice."""
    triangle, corner = np.nonzero((across := neighbours(triangles, len(vertices))) >= 0)
    first, second = number[triangle], number[across[triangle, corner]]
    between = first != second
    triangle, corner, first, second = triangle[between], corner[between], first[between], second[between]
    along = vertices[triangles[triangle, (corner + 1) % 3]] - vertices[triangles[triangle, corner]]
    units = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    cross = np.cross(units[first], units[second])
    sine, cosine = np.linalg.norm(cross, axis=1), np.einsum("ij,ij->i", units[first], units[second])
    angles = np.copysign(np.arctan2(sine, cosine), np.einsum("ij,ij->i", cross, along))
    result: list[dict[int, float]] = [{} for _ in normals]
    for one, other, angle in zip(first.tolist(), second.tolist(), angles.tolist(), strict=True):
        if abs(angle) >= abs(result[one].get(other, 0.0)):
            result[one][other] = angle
    return result
