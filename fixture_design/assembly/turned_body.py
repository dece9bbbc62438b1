"""Convex solids of revolution (pegs): coaxial circles, cylinders and cones between them, a flat disk at either end."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.arrays import Indices, Point, Points, Weights
from fixture_design.layout import Pose

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry
    from fixture_design.geometry.smooth_surface import SmoothSurface

#: A direction is along an axis, and a point on one, up to this [-]; points relative to the part's size. Fits of meshes
#: written with seven digits are better than that by far.
COAXIAL = 1e-4

#: Circles nearer to each other than this are one, relative to the part's size [-].
ONE_CIRCLE = 1e-5


@dataclass(frozen=True, eq=False)
class TurnedBody:
    """A convex solid of revolution in its own frame: the hull of k coaxial circles.

    Attributes:
        axis: unit.  foot: the point of the axis nearest to the frame's origin [m].
        heights, radii: of the circles along the axis from there, heights increasing, shape (k,) [m].
    """

    axis: Point
    foot: Point
    heights: Weights
    radii: Weights

    @cached_property
    def centers(self) -> Points:
        """Of the circles, shape (k, 3) [m]."""
        return self.foot + self.heights[:, None] * self.axis

    @cached_property
    def lengths(self) -> Weights:
        """Of the generators of the k - 1 surfaces between the circles [m]."""
        return np.hypot(np.diff(self.heights), np.diff(self.radii))

    @cached_property
    def slopes(self) -> np.ndarray:
        """Along the generators, outwards and along the axis, shape (k - 1, 2), unit."""
        return np.column_stack([np.diff(self.radii), np.diff(self.heights)]) / self.lengths[:, None]

    @cached_property
    def reaches(self) -> Weights:
        """How far the points of each circle are from the frame's origin, at most, shape (k,) [m]."""
        return np.linalg.norm(self.centers, axis=1) + self.radii

    @cached_property
    def spread(self) -> float:
        """Root mean square distance of the circles' points from the frame's origin [m]."""
        return float(np.sqrt(((self.centers**2).sum(axis=1) + self.radii**2).mean()))

    def words(self) -> list[str]:
        """What each surface between two circles is: cylinder or cone."""
        return ["cylinder" if abs(slope) <= COAXIAL else "cone" for slope in self.slopes[:, 0]]

    def offsets(self, points: np.ndarray, axis: np.ndarray, origin: np.ndarray) -> np.ndarray:
        """How far outside of each surface and each end points (n, m, 3) are, shape (n, m, k + 1) [m].

        ``axis`` and ``origin`` (where ``foot`` is), shape (n, 3), place the body. The body is where all are negative.
        """
        away = points - origin[:, None]
        along = np.einsum("nmi,ni->nm", away, axis)
        across = np.linalg.norm(away - along[..., None] * axis[:, None], axis=-1)
        sides = (across[..., None] - self.radii[:-1]) * self.slopes[:, 1]
        sides -= (along[..., None] - self.heights[:-1]) * self.slopes[:, 0]
        ends = np.stack([self.heights[0] - along, along - self.heights[-1]], axis=-1)
        return np.concatenate([sides, ends], axis=-1)


def turned_body(geometry: PartGeometry, pose: Pose) -> TurnedBody | str:
    """A part as a convex solid of revolution, or in words why it is none."""
    surfaces = geometry.smooth_surfaces
    refused = [surface.name for surface in surfaces if surface.is_band or surface.kind not in ("cylinder", "cone")]
    if refused:
        return f"{', '.join(refused)}: only cylinders and cones form contact pairs"
    hollow = [surface.name for surface in surfaces if surface.hollow]
    if hollow:
        return f"{', '.join(hollow)}: what turns must have no holes"
    axis, point, size = surfaces[0].axis, surfaces[0].point, 2 * geometry.half_diagonal
    away = [surface.point - point for surface in surfaces]
    for surface, off in zip(surfaces, away, strict=True):
        if (
            np.linalg.norm(np.cross(surface.axis, axis)) > COAXIAL
            or np.linalg.norm(np.cross(off, axis)) > COAXIAL * size
        ):
            return f"{surface.name} is not about the axis of {surfaces[0].name}"
    flat = np.setdiff1d(np.arange(len(geometry.facets)), np.concatenate([surface.facets for surface in surfaces]))
    if len(flat) != 2 or (np.abs(geometry.facet_units[flat] @ axis) < 1 - COAXIAL**2).any():
        return "its plane facets are not two disks, one at either end"
    heights, radii = _circles(geometry, surfaces, flat, axis, point)
    slopes = np.diff(radii) / np.diff(heights)
    if (np.diff(slopes) >= 0).any():
        return "its profile is not convex"
    placed_axis, placed = pose.vectors(axis[None])[0], pose.points(point[None])[0]
    foot = placed - (placed @ placed_axis) * placed_axis
    return TurnedBody(placed_axis, foot, heights + placed @ placed_axis, radii)


def _circles(
    geometry: PartGeometry, surfaces: tuple[SmoothSurface, ...], flat: Indices, axis: Point, point: Point
) -> tuple[Weights, Weights]:
    """Heights over ``point`` and radii of the circles in which surfaces end, radii by the fitted surfaces."""
    found = []
    for surface in surfaces:
        corners = geometry.vertices[np.unique(geometry.triangles[_triangles(geometry, surface.facets)])]
        along = (corners - point) @ axis
        for height in (along.min(), along.max()):
            rim = np.abs(along - height) <= ONE_CIRCLE * geometry.half_diagonal
            across = np.linalg.norm(np.cross(corners[rim] - point, axis), axis=1)
            found.append([along[rim].mean(), across.max()])
    for facet in flat:
        found.append([(geometry.facets[facet].centroid - point) @ axis, -1.0])
    rows = np.array(found)[np.argsort([row[0] for row in found], kind="stable")]
    groups = np.cumsum(np.diff(rows[:, 0], prepend=rows[0, 0]) > ONE_CIRCLE * geometry.half_diagonal)
    return (
        np.array([rows[groups == k, 0].mean() for k in range(groups[-1] + 1)]),
        np.array([rows[groups == k, 1].max() for k in range(groups[-1] + 1)]),
    )


def _triangles(geometry: PartGeometry, facets: Indices) -> Indices:
    return np.flatnonzero(np.isin(geometry.facet_of_triangle, facets))
