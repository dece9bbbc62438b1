"""Facets: the plane faces of a part, with names, outward normals, neighbours and how far each normal may be off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices
from fixture_design.contacts import Provenance
from fixture_design.errors import format_length
from fixture_design.geometry.noise import angles_to_axes, nearly_square, offsets_from_planes, on_axes
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
from fixture_design.tolerances import DEFAULT

#: Names in a note before it says how many more there are.
_NAMES_SHOWN = 8


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
        squared: angle by which the normal was turned to be along a coordinate axis [rad]; 0 if it was not.
    """

    name: str
    normal: Vector3
    centroid: Vector3
    triangles: Indices
    provenance: Provenance
    width: float
    noise: float
    angles: dict[int, float]
    squared: float = 0.0

    @property
    def normal_error(self) -> float:
        """Largest angle between the normal and the true surface's [rad]."""
        return self.provenance.normal_error


@dataclass(frozen=True, eq=False)
class Facets:
    """The facets of a part, in the order of their names.

    Attributes:
        noise: how far vertices are off the planes of the flat facets that they should lie in [m], at most.
    """

    facets: tuple[Facet, ...]
    noise: float


def facets_of(vertices: Vertices, triangles: Triangles, rounding: PerVertex, faceted: bool = False) -> Facets:
    """The facets of a sound mesh.

    Slivers belong to facets but have no say in where their planes are. Vertices that turn out to be off by more than
    their rounding count as known to no better than that, all of them. A facet that is all but square to an axis is
    taken as square: `Facet.squared` says by how much it was turned.

    Args:
        vertices: shape (v, 3) [m].  triangles: shape (t, 3).  rounding: of each vertex, shape (v,) [m].
        faceted: no facet stands for a curved surface.
    """
    areas = area_vectors(vertices, triangles)
    grown, sliver = plane_numbers(vertices, triangles, rounding)
    number = _in_order(vertices, triangles, areas, grown)
    votes = ~sliver | (_sums(~sliver[:, None] * 1.0, number)[number, 0] == 0)
    voted = _sums(areas * votes[:, None], number)
    units = voted / np.linalg.norm(voted, axis=1, keepdims=True)
    normals = units * np.einsum("ij,ij->i", units, _sums(areas, number))[:, None]
    angles = _dihedral_angles(vertices, triangles, units, number)
    sizes = np.linalg.norm(normals, axis=1).tolist()
    owner_and_vertex = np.unique(np.repeat(number[votes], 3) * len(vertices) + triangles[votes].ravel())
    used = owner_and_vertex % len(vertices)
    starts = np.flatnonzero(np.diff(owner_and_vertex // len(vertices), prepend=-1))

    def measured(known_to: PerVertex) -> tuple[list[FacetMeasures], tuple[Provenance, ...]]:
        widths, turns = widths_and_angles(vertices, known_to, used, starts, normals)
        measures = [FacetMeasures(*m) for m in zip(widths.tolist(), turns.tolist(), angles, sizes, strict=True)]
        return measures, provenances(measures, faceted)

    measures, origins = measured(rounding)
    flat = np.array([origin.kind == "exact" for origin in origins], dtype=bool)
    planes = _centroids(vertices, triangles[votes], areas[votes], number[votes])
    noise = float(offsets_from_planes(vertices, used, starts, units, planes)[flat].max(initial=0.0))
    if noise > rounding.max():
        measures, origins = measured(np.maximum(rounding, noise))
    turned = angles_to_axes(units)
    square = np.array([origin.kind == "exact" for origin in origins], dtype=bool) & nearly_square(units) & (turned > 0)
    normals = np.where(square[:, None], on_axes(normals), normals)
    centroids = _centroids(vertices, triangles, areas, number)
    order = np.argsort(number, kind="stable")
    members = np.split(order, np.cumsum(np.bincount(number))[:-1])
    return Facets(
        tuple(
            Facet(
                f"facet {i + 1}",
                normals[i],
                centroids[i],
                members[i],
                Provenance() if square[i] else origins[i],
                measures[i].width,
                measures[i].noise,
                dict(measures[i].angles),
                float(turned[i]) if square[i] else 0.0,
            )
            for i in range(len(members))
        ),
        noise,
    )


def facet_notes(name: str, facets: Sequence[Facet], noise: float) -> tuple[str, ...]:
    """What was taken for granted about facets, for people; ``noise`` as in `Facets`."""
    squared = [facet for facet in facets if facet.squared > DEFAULT.zero]
    if not squared:
        return ()
    names = ", ".join(facet.name.removeprefix("facet ") for facet in squared[:_NAMES_SHOWN])
    more = f" and {len(squared) - _NAMES_SHOWN} more" if len(squared) > _NAMES_SHOWN else ""
    turned = max(facet.squared for facet in squared)
    return (
        f"{name}: {'facet' if len(squared) == 1 else 'facets'} {names}{more} taken as square to the axes of the part, "
        f"from which they are off by up to {turned:.1e} rad: its vertices are off by {format_length(noise)}",
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
    vertices: Vertices, triangles: Triangles, units: FacetVectors, number: OfTriangle
) -> list[dict[int, float]]:
    """For each facet the angle to each neighbour, positive on convex edges; the largest one if they meet twice."""
    triangle, corner = np.nonzero((across := neighbours(triangles, len(vertices))) >= 0)
    first, second = number[triangle], number[across[triangle, corner]]
    between = first != second
    triangle, corner, first, second = triangle[between], corner[between], first[between], second[between]
    along = vertices[triangles[triangle, (corner + 1) % 3]] - vertices[triangles[triangle, corner]]
    cross = np.cross(units[first], units[second])
    sine, cosine = np.linalg.norm(cross, axis=1), np.einsum("ij,ij->i", units[first], units[second])
    angles = np.copysign(np.arctan2(sine, cosine), np.einsum("ij,ij->i", cross, along))
    result: list[dict[int, float]] = [{} for _ in units]
    for one, other, angle in zip(first.tolist(), second.tolist(), angles.tolist(), strict=True):
        if abs(angle) >= abs(result[one].get(other, 0.0)):
            result[one][other] = angle
    return result
