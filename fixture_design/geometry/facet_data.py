"""The facets that may stand for round surfaces, as arrays, and what of them lies on a given shape.

A facet lies on a surface if all its corners do, up to the noise of the vertices, if it faces the same way, and if it is
no coarser than the others: a flat cut into a shaft has its corners on the shaft too, but its middle is deeper.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.geometry.facets import Facet
from fixture_design.geometry.round_fits import Patch, fitted, normal_error
from fixture_design.geometry.shapes import Directions, FacetVectors, OfFacet, PerFacet, Triangles, Vertices
from fixture_design.geometry.smooth_surface import RoundKind, RoundShape, SmoothSurface
from fixture_design.geometry.turned import TurnedPiece
from fixture_design.tolerances import ON_EDGE_ROUNDINGS, ROUND_FIT, SMOOTH_ANGLE

#: Facets and vertices that a surface must have, so that it is no accident that they fit: three bevels between two flats
#: always do, if they are symmetric.
_FEWEST: dict[RoundKind, tuple[int, int]] = {"cylinder": (4, 10), "cone": (4, 9), "sphere": (6, 8), "torus": (9, 12)}
#: Smooth neighbours that a strip has, and triangles it is made of, at most.
_STRIP_SIDES, _STRIP_TRIANGLES = 2, 12
#: Corners on the surface that make up for others of the same facet that lie on chords.
_FEWEST_ON = 4
#: Corners this many tolerances from the axis are at a cone's apex [-].
_AT_APEX = 10.0
#: Angle between a facet's normal and those of the surface at its corners, at most [rad]: half a coarse step.
STEP = 0.7 * SMOOTH_ANGLE

#: A round surface and the facets that stand for it.
Region = tuple[RoundShape, list[int]]


def fit_tolerance(vertices: Vertices, noise: float) -> float:
    """How far vertices that are known to within ``noise`` may be off a round surface that they lie on [m]."""
    return ON_EDGE_ROUNDINGS * noise + ROUND_FIT * part_size(vertices)


def part_size(vertices: Vertices) -> float:
    """The diagonal of the bounding box [m]."""
    return float(np.linalg.norm(np.ptp(vertices, axis=0)))


def may_be_round(facet: Facet) -> bool:
    """Whether a facet may stand for a round surface: it is doubtful, or an outwardly flat strip between narrower ones.

    Such a strip has few corners and meets its neighbours smoothly.
    """
    if facet.provenance.kind == "approximate":
        return True
    smooth = sum(abs(angle) < SMOOTH_ANGLE for angle in facet.angles.values())
    return smooth >= _STRIP_SIDES and len(facet.triangles) <= _STRIP_TRIANGLES


@dataclass(eq=False)
class FacetData:
    """All facets of a part, with what is asked of them again and again; rows of arrays belong together.

    Attributes:
        corners: of each facet the indices of its vertices, and their numbers in ``corner_counts``.
        units, middles, areas, widths: normals of length 1, centroids [m], lengths of the normals, widths [m].
        smooth: of each facet the neighbours that it meets smoothly, with the angles [rad].
        candidates: facets that may stand for a round surface.  doubtful: those whose normals are approximate.
        tolerance: how far vertices may be off a surface that they lie on.  noise: how well they are known [m].
        size: of the part [m].
    """

    vertices: Vertices
    corners: list[Indices]
    corner_counts: OfFacet
    units: FacetVectors
    middles: FacetVectors
    areas: PerFacet
    widths: PerFacet
    smooth: list[dict[int, float]]
    candidates: frozenset[int]
    triangles_of: list[Indices]
    doubtful: frozenset[int]
    tolerance: float
    noise: float
    size: float

    @classmethod
    def of(cls, facets: Sequence[Facet], vertices: Vertices, triangles: Triangles, noise: float) -> FacetData:
        candidates = {i for i, facet in enumerate(facets) if may_be_round(facet)}
        normals = np.array([facet.normal for facet in facets])
        areas = np.linalg.norm(normals, axis=1)
        smooth = [{o: angle for o, angle in facet.angles.items() if abs(angle) < SMOOTH_ANGLE} for facet in facets]
        corners = [np.unique(triangles[facet.triangles]) for facet in facets]
        size = part_size(vertices)
        return cls(
            vertices,
            corners,
            np.array([len(mine) for mine in corners]),
            normals / areas[:, None],
            np.array([facet.centroid for facet in facets]),
            areas,
            np.array([facet.width for facet in facets]),
            smooth,
            frozenset(candidates),
            [facet.triangles for facet in facets],
            frozenset(i for i, facet in enumerate(facets) if facet.provenance.kind == "approximate"),
            fit_tolerance(vertices, noise),
            noise,
            size,
        )

    def keep_middles_on(self, piece: TurnedPiece, triangles: Triangles) -> None:
        """The middle of a plane ring is on the axis, where its surface is not: its largest triangle's counts."""
        for facet in piece.facets:
            reach = piece.shape.reaches(np.vstack([self.vertices[self.corners[facet]], self.middles[facet]]))
            if reach[-1] < reach[:-1].min() / 2:
                corners = self.vertices[triangles[self.triangles_of[facet]]]
                areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
                self.middles[facet] = corners[np.argmax(areas)].mean(axis=0)

    def points(self, members: Sequence[int]) -> Directions:
        return self.vertices[np.unique(np.concatenate([self.corners[facet] for facet in members]))]

    def points_on(self, shape: RoundShape, members: Sequence[int]) -> Directions:
        """Their corners, without those on chords."""
        points = self.points(members)
        return points[np.abs(shape.offsets(points)) <= self.tolerance]

    def lie_on(self, shape: RoundShape, facets: list[int], deepest: float, sense: float) -> list[bool]:
        """Whether facets lie on a surface: all corners on it, or some on its chords, where another feature cut them."""
        counts = self.corner_counts[facets]
        starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
        owner = np.repeat(np.arange(len(facets)), counts)
        corners = self.vertices[np.concatenate([self.corners[facet] for facet in facets])]
        offsets = np.abs(shape.offsets(corners))
        on = np.add.reduceat(offsets <= self.tolerance, starts)
        fits = (on == counts) | ((on >= _FEWEST_ON) & (np.maximum.reduceat(offsets, starts) <= deepest))
        fits &= np.abs(shape.offsets(self.middles[facets])) <= deepest
        out = shape.directions(corners)
        facing = sense * np.einsum("ij,ij->i", out, self.units[facets][owner])
        # at the apex of a cone there is no normal to compare with, and beside it noise
        facing = np.where(shape.reaches(corners) > _AT_APEX * self.tolerance, facing, 1.0)
        return (fits & (np.minimum.reduceat(facing, starts) >= np.cos(STEP))).tolist()

    def hollow(self, shape: RoundShape, members: list[int]) -> bool:
        facing = np.einsum("ij,ij->i", shape.directions(self.middles[members]), self.units[members])
        return bool(facing @ self.areas[members] < 0)

    def fit(self, kind: RoundKind, members: list[int], points: Directions) -> RoundShape | None:
        if len(points) < 4 or (kind == "cylinder" and not self._parallel(members)):
            return None
        shape = fitted(kind, Patch(points, self.units[members], self.middles[members]))
        if shape is None or np.abs(shape.offsets(points)).max() > self.tolerance:
            return None
        return shape

    def _parallel(self, members: list[int]) -> bool:
        """Whether the normals are square to one direction, as far as a first guess must be."""
        return bool(np.linalg.svd(self.units[members], compute_uv=False)[-1] < np.sin(SMOOTH_ANGLE) / 10)

    def believable(self, kind: RoundKind, members: Sequence[int], points: Directions) -> bool:
        """Whether they are so many facets and vertices that it is no accident that they fit."""
        fewest_facets, fewest_points = _FEWEST[kind]
        return len(members) >= fewest_facets and len(points) >= fewest_points

    def surface(self, region: Region, *, known: bool) -> SmoothSurface:
        """The surface of a region, without a name yet; ``known``: it is exact, the vertices are rounded."""
        shape, members = region
        points, middles = self.points_on(shape, members), self.middles[members]
        error = 0.0 if known else float(np.abs(shape.offsets(points)).max())
        width = float(self.widths[members].min())
        off = 0.0 if known else normal_error(shape, points, middles, error, self.noise, width)
        sagitta = float(np.abs(shape.offsets(middles)).max())
        return SmoothSurface(
            shape.kind, shape, self.hollow(shape, members), np.array(members, dtype=np.int64), error, off, sagitta, off
        )

    def band(self, piece: TurnedPiece) -> SmoothSurface:
        """The surface through two rings of a profile that is not known, without a name yet."""
        members = piece.facets
        points, middles = self.points(members), self.middles[members]
        return SmoothSurface(
            "",
            piece.shape,
            self.hollow(piece.shape, members),
            np.array(members, dtype=np.int64),
            float(np.abs(piece.shape.offsets(points)).max()),
            piece.profile_error + piece.axis_error,
            float(np.abs(piece.shape.offsets(middles)).max()),
            piece.axis_error,
        )
