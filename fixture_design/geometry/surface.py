"""What contacts ask of a surface, be it a solid's or a polygon's."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np

from fixture_design.arrays import Indices, Point
from fixture_design.geometry.local import LocalSurface, facets_at, feature_name, local_surface
from fixture_design.geometry.nearest import touched_at_each, touched_triangles
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Directions


@runtime_checkable
class Surface(Protocol):
    """A closed surface in the part's frame P, of dimension 2 or 3; `Polygon` is one as it stands."""

    @property
    def name(self) -> str: ...

    @property
    def half_diagonal(self) -> float: ...

    @property
    def precision(self) -> float:
        """How near to an edge a point counts as on it [m]."""
        ...

    def nearest(self, p_PQ: Point) -> tuple[float, Point]:
        """Signed distance, negative inside [m], and the nearest point of the surface."""
        ...

    def local(self, p_PC: Point) -> LocalSurface:
        """The logic of the surface at one of its points."""
        ...

    def feature(self, p_PC: Point) -> str:
        """The name of the facet, edge or apex at a point of the surface."""
        ...

    def slack(self, surface: LocalSurface) -> float:
        """How far the true surface may lie behind this one there [m]."""
        ...


@dataclass(frozen=True, eq=False)
class SolidSurface:
    """The surface of a solid part. What was asked once is remembered: contacts come back to the same few points."""

    geometry: PartGeometry
    _feet: dict[bytes, tuple[float, Point]] = field(default_factory=dict, repr=False)
    _touched: dict[bytes, Indices] = field(default_factory=dict, repr=False)

    @classmethod
    def near(cls, geometry: PartGeometry, points: Directions) -> SolidSurface:
        """The surface, ready for questions about some points: what they touch is looked for in one go, shape (n, 3)."""
        surface = cls(geometry)
        surface.look(points)
        return surface

    def look(self, points: Directions) -> None:
        """Find in one go what some points touch, shape (n, 3): questions about them are answered faster then."""
        feet = [self.foot(point)[1] for point in points]
        touched = touched_at_each(self.geometry, np.array(feet).reshape(-1, 3), self.precision)
        self._touched.update((foot.tobytes(), found) for foot, found in zip(feet, touched, strict=True))

    @property
    def name(self) -> str:
        return self.geometry.name

    @property
    def half_diagonal(self) -> float:
        return self.geometry.half_diagonal

    @property
    def precision(self) -> float:
        return self.geometry.on_edge

    def nearest(self, p_PQ: Point) -> tuple[float, Point]:
        """As Drake measures it to the facets; where these stand for a round surface, to that, if it is nearer."""
        distance, p_PF = self.foot(p_PQ)
        surfaces = {self.geometry.surface_of_facet(f) for f in self.facets_at(p_PF).tolist()}
        surface = next(iter(surfaces)) if len(surfaces) == 1 else None
        if surface is None:
            return distance, p_PF
        p_PC = surface.project(p_PQ)
        own = surface.distance(p_PQ)
        return (own if abs(own) < abs(distance) else distance), p_PC

    def local(self, p_PC: Point) -> LocalSurface:
        return local_surface(self.geometry, p_PC, touched=self._at(p_PC))

    def feature(self, p_PC: Point) -> str:
        return feature_name(self.geometry, self.facets_at(p_PC))

    def slack(self, surface: LocalSurface) -> float:
        """Of a round surface twice the depth of its strips; of other strips of width w, tilted by e: w sin e.

        In a bore of radius R, cut to strips w = R e wide, a ball of radius r that touches a strip anywhere cuts its
        neighbours by at most w^2 / (8 (R - r)), which is less unless the ball all but fills the bore.
        """
        if surface.provenance.kind == "exact":
            return 0.0
        if surface.provenance.kind == "fitted":
            found = [self.geometry.surface_of_facet(facet) for facet in surface.facets]
            return max(2 * known.sagitta for known in found if known is not None)
        width = max(self.geometry.facets[facet].width for facet in surface.facets)
        return width * float(np.sin(min(surface.provenance.normal_error, np.pi / 2)))

    def foot(self, p_PQ: Point) -> tuple[float, Point]:
        """Signed distance and nearest point as Drake measures it, to the facets."""
        key = p_PQ.tobytes()
        if key not in self._feet:
            self._feet[key] = self.geometry.surface.at(p_PQ)
        return self._feet[key]

    def facets_at(self, p_PF: Point) -> Indices:
        """The facets that meet at a point of them."""
        return facets_at(self.geometry, self._at(p_PF))

    def _at(self, p_PF: Point) -> Indices:
        """The triangles at a point of the facets."""
        key = p_PF.tobytes()
        if key not in self._touched:
            self._touched[key] = touched_triangles(self.geometry, p_PF, self.precision)
        return self._touched[key]
