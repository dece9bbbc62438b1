"""A piece of a part: one closed triangle mesh with where it came from and how well its vertices are known."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.errors import GeometryError
from fixture_design.geometry.shapes import PerTriangle, PerVertex, Triangles, TriangleVectors, Vector3, Vertices
from fixture_design.tolerances import ROUND_OFF, ROUNDED_DIGITS

#: Decimals beyond which a text file keeps everything a float64 has.
_MOST_DECIMALS = 12


@dataclass(frozen=True, eq=False)
class SmoothPatch:
    """A surface of revolution that some triangles stand for, known exactly: from a primitive shape, not recognised.

    Attributes:
        kind: which surface.
        point: on the axis; centre of spheres and tori, apex of cones, shape (3,) [m].
        axis: unit; any direction for spheres, shape (3,).
        radius: of cylinder, sphere, or a torus's tube [m]; of a cone its half angle [rad].
        ring: of a torus, distance of the tube's centre from the axis [m]; else 0.
        triangles: which triangles of the piece it covers.
    """

    kind: Literal["cylinder", "cone", "sphere", "torus"]
    point: Vector3
    axis: Vector3
    radius: float
    ring: float
    triangles: Indices


@dataclass(frozen=True, eq=False)
class Piece:
    """Triangles as a file gives them, in metres.

    Attributes:
        vertices: shape (v, 3) [m].
        triangles: shape (t, 3), vertex numbers, counter-clockwise seen from outside.
        rounding: shape (v,), how far each coordinate may be from what the designer meant [m].
        source: the file.  place: where in it ("link 'base', mesh 'base.stl'"), None for a mesh of its own.
        notes: what was mended, for people.
        smooth: curved surfaces that are known exactly; none in a mesh.
    """

    vertices: Vertices
    triangles: Triangles
    rounding: PerVertex
    source: Path
    place: str | None = None
    notes: tuple[str, ...] = ()
    smooth: tuple[SmoothPatch, ...] = ()

    @property
    def size(self) -> float:
        """Diagonal of the bounding box [m]."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))

    def error(self, problem: str, found: str | None = None, expected: str | None = None) -> GeometryError:
        """A GeometryError that knows where this piece came from."""
        return GeometryError(problem, source=self.source, place=self.place, found=found, expected=expected)

    def note(self, text: str) -> tuple[str, ...]:
        """The piece's notes and one more, prefixed by its origin."""
        origin = self.source.name if self.place is None else f"{self.source.name}, {self.place}"
        return (*self.notes, f"{origin}: {text}")


def rounding_of(coordinates: Vertices) -> PerVertex:
    """How far each vertex may be from the intended one, judged by the digits its file spent on it.

    Half a unit in the last place of float32 where all coordinates are float32 numbers (binary STL, most PLY); half a
    unit of the last decimal where all are decimals that an exporter rounded (``ROUNDED_DIGITS`` significant digits or
    more, for shorter ones are dimensions as the designer typed them); else of float64.

    Args:
        coordinates: as read, before any scale, shape (v, 3).

    Returns:
        shape (v,), in the coordinates' own unit; zeros where some are not finite, which `sound` refuses.
    """
    if not np.isfinite(coordinates).all():
        return np.zeros(len(coordinates))
    largest = np.abs(coordinates).max(axis=1, initial=0.0)
    if np.array_equal(coordinates, coordinates.astype(np.float32)):
        return largest * float(np.finfo(np.float32).eps) / 2
    magnitude = int(np.ceil(np.log10(largest.max())))
    for decimals in range(max(0, ROUNDED_DIGITS - magnitude), _MOST_DECIMALS):
        # np.round leaves a unit or two in the last place of float64
        if np.abs(coordinates - np.round(coordinates, decimals)).max() <= 4 * ROUND_OFF * largest.max():
            shorter = np.abs(coordinates - np.round(coordinates, ROUNDED_DIGITS - magnitude - 1)).max()
            if shorter <= 4 * ROUND_OFF * largest.max():
                break
            return np.full(len(coordinates), 0.5 * 10.0**-decimals)
    return largest * ROUND_OFF


def area_vectors(vertices: Vertices, triangles: Triangles) -> TriangleVectors:
    """(b - a) X (c - a) of every triangle: outward, twice its area long; shape (t, 3) [m^2].

    Edges are subtracted first, so that a triangle in a plane z = const has exactly [0, 0, z].
    """
    first, second, third = (vertices[triangles[:, corner]] for corner in range(3))
    return np.cross(second - first, third - first)


def heights(vertices: Vertices, triangles: Triangles) -> PerTriangle:
    """The smallest height of every triangle, 0 for degenerate ones; shape (t,) [m]."""
    corners = vertices[triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    areas = np.linalg.norm(area_vectors(vertices, triangles), axis=1)
    return areas / np.where(longest > 0, longest, 1.0)
