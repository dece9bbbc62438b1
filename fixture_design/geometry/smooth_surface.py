"""Surfaces of revolution that facets stand for: cylinders, cones, spheres and tori, with their true normals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices
from fixture_design.errors import UnsupportedError
from fixture_design.geometry.shapes import Directions, PerPoint, Vector3

RoundKind = Literal["cylinder", "cone", "sphere", "torus"]

#: A point this near to the axis or centre, relative to the points' distances from there, has no normal [-].
_NO_NORMAL = 1e-9


class SeenFromAxis(NamedTuple):
    """Points as an axis sees them.

    Attributes:
        away: from the point of the axis, shape (n, 3) [m].
        along: how far along it [m].
        outward: what is square to it, shape (n, 3) [m].
        across: its length: how far from the axis [m].
    """

    away: Directions
    along: PerPoint
    outward: Directions
    across: PerPoint


@dataclass(frozen=True, eq=False)
class RoundShape:
    """A round surface, without a side where the material is.

    Attributes:
        kind: what it is.
        point: on the axis; the centre of spheres and tori, the apex of cones [m].
        axis: unit; from the apex into the cone; any direction for spheres.
        radius: of cylinders and spheres, of a torus's tube [m]; of cones half the angle at the apex [rad].
        ring: of tori: distance of the tube's centre from the axis; else 0 [m].
    """

    kind: RoundKind
    point: Vector3
    axis: Vector3
    radius: float
    ring: float = 0.0

    def offsets(self, points: Directions) -> PerPoint:
        """Distances of points, shape (n, 3), from the surface, positive away from its axis or centre [m]."""
        return self.offsets_at(self.seen(points))

    def directions(self, points: Directions) -> Directions:
        """Unit normals at points near the surface, away from its axis or centre, shape (n, 3).

        Zero at points on the axis, or at the centre of a sphere: there is none.
        """
        return self.directions_at(self.seen(points))

    def reaches(self, points: Directions) -> PerPoint:
        """Distances of points from the axis, of a sphere from the centre [m]."""
        seen = self.seen(points)
        return np.hypot(seen.across, seen.along if self.kind == "sphere" else 0.0)

    def seen(self, points: Directions) -> SeenFromAxis:
        """Points as the axis sees them: once for all that is asked of the same points."""
        away = points - self.point
        along = away @ self.axis
        outward = away - along[:, None] * self.axis
        return SeenFromAxis(away, along, outward, np.sqrt(np.einsum("ij,ij->i", outward, outward)))

    def offsets_at(self, seen: SeenFromAxis) -> PerPoint:
        """``offsets`` of points that were seen."""
        match self.kind:
            case "cylinder":
                return seen.across - self.radius
            case "cone":
                return seen.across * np.cos(self.radius) - seen.along * np.sin(self.radius)
            case "sphere":
                return np.hypot(seen.across, seen.along) - self.radius
            case "torus":
                return np.hypot(seen.across - self.ring, seen.along) - self.radius

    def directions_at(self, seen: SeenFromAxis) -> Directions:
        """``directions`` at points that were seen."""
        steps = seen.across[:, None]
        match self.kind:
            case "cylinder":
                raw = seen.outward
            case "cone":
                raw = seen.outward * np.cos(self.radius) - steps * np.sin(self.radius) * self.axis
            case "sphere":
                raw = seen.away
            case "torus":
                raw = steps * seen.away - seen.outward * self.ring
        lengths = np.sqrt(np.einsum("ij,ij->i", raw, raw))[:, None]
        none = lengths <= _NO_NORMAL * np.hypot(seen.across, seen.along).max(initial=0.0)
        return np.where(none, 0.0, raw / np.where(none, 1.0, lengths))


@dataclass(frozen=True, eq=False)
class SmoothSurface:
    """A round surface of a part, in its frame P, with the facets that stand for it.

    Attributes:
        name: "cylinder 2", the same from run to run.
        shape: what and where it is.
        hollow: the material is outside (a bore), so that the outward normal points towards the axis or centre.
        facets: indices of the facets.
        error: largest distance of a vertex of these facets from it [m].
        normal_error: how far off its normals may be where it was fitted [rad]; 0 if it was given.
        sagitta: largest distance of the facets' middles from it [m].
        axis_error: how far off the motions may be that move it along itself [rad]. As ``normal_error``, but for a band
            of a turned surface whose profile is not known: there normals are in the plane of axis and point, wherever
            in it.
    """

    name: str
    shape: RoundShape
    hollow: bool
    facets: Indices
    error: float
    normal_error: float
    sagitta: float
    axis_error: float = 0.0

    @property
    def is_band(self) -> bool:
        """Whether it is a band of a turned surface whose profile is not known; bands of one have the same name."""
        return self.axis_error < self.normal_error

    @property
    def kind(self) -> RoundKind:
        return self.shape.kind

    @property
    def point(self) -> Vector3:
        return self.shape.point

    @property
    def axis(self) -> Vector3:
        return self.shape.axis

    @property
    def radius(self) -> float:
        return self.shape.radius

    @property
    def ring(self) -> float:
        return self.shape.ring

    def normal(self, p_PC: Vector3) -> Vector3:
        """The outward unit normal at a point near the surface.

        Raises:
            UnsupportedError: a point on the axis, where there is none, or no further from it than facets are deep.
        """
        normal = self.shape.directions(p_PC[None])[0]
        if not normal.any() or self.shape.reaches(p_PC[None])[0] <= self.sagitta:
            raise UnsupportedError(f"{self.name} has no normal on its axis", expected="a point away from the axis")
        return -normal if self.hollow else normal

    def project(self, p_PQ: Vector3) -> Vector3:
        """The point of the surface nearest to one that is near it."""
        return p_PQ - self.shape.offsets(p_PQ[None])[0] * self.shape.directions(p_PQ[None])[0]

    def distance(self, p_PQ: Vector3) -> float:
        """Signed distance, negative on the side of the material [m]."""
        return float(self.shape.offsets(p_PQ[None])[0]) * (-1.0 if self.hollow else 1.0)

    def slips(self) -> Float[np.ndarray, "k 6"]:
        """The motions [v; w] about P's origin that move the surface along itself: one a row, 1 to 3 of them.

        Turning about the axis; for cylinders also moving along it; for spheres turning any way about the centre. Bands
        of a profile that is not known only turn.
        """
        turns = np.eye(3) if self.kind == "sphere" and not self.is_band else self.axis[None]
        rows = np.hstack([-np.cross(turns, self.point), turns])
        if self.kind == "cylinder" and not self.is_band:
            rows = np.vstack([rows, np.concatenate([self.axis, np.zeros(3)])])
        return rows
