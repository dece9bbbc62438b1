"""A part as design asks for it: candidate points, contacts of elements, verdicts. Its geometry is loaded once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Literal, Protocol, runtime_checkable

import numpy as np

from fixture_design.arrays import Mask, Point, Points, Vector
from fixture_design.contacts import Contact, Scale
from fixture_design.errors import GeometryError, UnsupportedError, looking_at
from fixture_design.layout import Element, Layout, Part, Stem, Verdict, groups_of
from fixture_design.verification.load_paths import load_rows
from fixture_design.verification.use import USE_QUESTIONS
from fixture_design.verification.verify import QUESTIONS, contacts_of, verify
from fixture_design.verification.weight import weight_of

if TYPE_CHECKING:
    from fixture_design.geometry import Hole, PartGeometry, Polygon, SurfacePoints

#: Candidates that a part gets where no spacing is asked for, about [-], and of a planar one.
_SPATIAL, _PLANAR = 400, 80
#: Parts of half the part's diagonal that candidates keep from edges; the first that leaves enough room is taken [-].
_EDGE_MARGINS = (0.02, 0.005, 0.001, 0.0)
#: Fewer candidates than this are not enough for a choice [-].
_ENOUGH = 40


@runtime_checkable
class _Grid(Protocol):
    @property
    def origin(self) -> Point: ...
    @property
    def pitch(self) -> float: ...
    @property
    def plane(self) -> Literal["xy", "yz", "xz"]: ...


@runtime_checkable
class CandidateWishes(Protocol):
    """Where candidates may be, as `design.CandidateRules` has it."""

    @property
    def spacing(self) -> float | None: ...
    @property
    def edge_margin(self) -> float | None: ...
    @property
    def facets(self) -> tuple[int, ...] | None: ...
    @property
    def keep_out(self) -> tuple[tuple[Point, Point], ...]: ...
    @property
    def points(self) -> Points | None: ...
    @property
    def grid(self) -> _Grid | None: ...


class PartSurface:
    """The surface of a part, in the pose it has.

    Attributes:
        answers: the requirements that verdicts answer.
    """

    def __init__(self, part: Part, surface_gap: float) -> None:
        self.part, self.surface_gap = part, surface_gap
        self.answers = frozenset({*QUESTIONS, *USE_QUESTIONS})

    @cached_property
    def geometry(self) -> PartGeometry | Polygon:
        from fixture_design.geometry import load_geometry  # noqa: PLC0415 - Drake only where there is geometry

        with looking_at(self.part.file, None):
            return load_geometry(self.part)

    @property
    def notes(self) -> tuple[str, ...]:
        return self.geometry.notes

    def scale(self) -> Scale:
        """Centre of the part's box in W and half its diagonal, as margins are reported."""
        center = self.part.pose.points(np.asarray(self.geometry.box_center)[None])[0]
        return Scale(center, self.geometry.half_diagonal)

    def wrenches(self, layout: Layout) -> tuple[Vector, Sequence[Vector]] | str:
        """The weight and the loads [f; m] about W's origin [N, N m]; or why the weight is not known.

        Raises:
            FileFormatError: a load path cannot be read.
        """
        weight = weight_of(layout, self.geometry)
        if isinstance(weight, str):
            return weight
        everything = groups_of(layout, ())[1]
        return weight.wrench, [row.wrench for row in load_rows(layout, everything)]

    def contacts(self, layout: Layout) -> Sequence[Contact]:
        return contacts_of(layout, self.geometry).contacts

    def verify(self, layout: Layout) -> Verdict:
        return verify(layout, found=contacts_of(layout, self.geometry))

    def touching(self, elements: Sequence[Element]) -> Sequence[Sequence[Contact]]:
        """The contacts that each element has by itself, without friction; none where it cannot stand."""
        from fixture_design.geometry import contacts_one_by_one  # noqa: PLC0415 - as above

        return contacts_one_by_one(elements, self.part, self.geometry, self.surface_gap)

    def holes(self) -> tuple[Hole, ...]:
        """The holes and slots that pins could be in; a planar part has none."""
        from fixture_design.geometry import Polygon, holes_of  # noqa: PLC0415 - as above

        return () if isinstance(self.geometry, Polygon) else holes_of(self.geometry, self.part.pose)

    def fits(self, points: Points, normals: Points, stem: Stem, out: Point | None = None) -> Mask:
        """Which elements cut the part neither with stem nor body; with ``out`` also while it leaves along that.

        In the plane all fit: elements stand upright beside a planar part.

        Args:
            points, normals: of their contacts in W, shape (n, p); normals outward, of length 1.
            out: of length 1, in W.
        """
        from fixture_design.geometry import Places, Polygon, with_room, with_way  # noqa: PLC0415 - as above

        if isinstance(self.geometry, Polygon):
            return np.ones(len(points), dtype=bool)
        X_PW = self.part.pose.inverse()
        places = Places(X_PW.points(points), X_PW.vectors(normals))
        free = with_room(self.geometry, places, stem)
        if out is not None:
            free[free] = with_way(self.geometry, places.some(np.flatnonzero(free)), stem, X_PW.vectors(out[None])[0])
        return free

    def spots(self, rules: CandidateWishes, seed: int) -> SurfacePoints:
        """Candidates where the rules let them be.

        Raises:
            GeometryError: the rules leave none.  UnsupportedError: a grid for a planar part.
        """
        if rules.edge_margin is not None or rules.points is not None:
            return self._spots(rules, rules.edge_margin or 0.0, seed)
        found, last = None, len(_EDGE_MARGINS) - 1
        for number, part in enumerate(_EDGE_MARGINS):
            try:
                found = self._spots(rules, part * self.scale().length, seed)
            except GeometryError:
                if number == last:  # not even without a margin
                    raise
                continue
            if len(found) >= _ENOUGH:
                return self._on_narrow_sides(found, rules, _EDGE_MARGINS[number + 1 :], seed)
        assert found is not None
        return found

    def _on_narrow_sides(
        self, found: SurfacePoints, rules: CandidateWishes, margins: Sequence[float], seed: int
    ) -> SurfacePoints:
        """Candidates with more on sides that a margin has left bare, nearer to their edges; in space."""
        from fixture_design.geometry import Polygon  # noqa: PLC0415 - as above
        from fixture_design.verification.bare_sides import bare_facets  # noqa: PLC0415 - as above

        if isinstance(self.geometry, Polygon) or rules.grid is not None:
            return found
        for part in margins:
            bare = bare_facets(self.geometry, found, rules.spacing or self._spacing())
            bare = bare if rules.facets is None else tuple(sorted({*bare} & {*rules.facets}))
            if not bare:
                break
            try:
                more = self._spots(rules, part * self.scale().length, seed, bare)
            except GeometryError:  # none there, or keep-outs
                continue
            found += more
        return found

    def _spots(
        self, wishes: CandidateWishes, edge_margin: float, seed: int, facets: tuple[int, ...] | None = None
    ) -> SurfacePoints:
        """With ``facets`` on these only."""
        from fixture_design.geometry import (  # noqa: PLC0415 - as above
            Box,
            Polygon,
            SamplingRules,
            given_points,
            given_polygon_points,
            grid_points,
            sample_polygon,
            sample_surface,
        )

        rules = SamplingRules(
            facets=wishes.facets if facets is None else facets,
            edge_margin=edge_margin,
            keep_out=[Box(low, high) for low, high in wishes.keep_out],
        )
        geometry, X_WP = self.geometry, self.part.pose
        if isinstance(geometry, Polygon):
            if wishes.grid is not None:
                raise UnsupportedError("a grid of candidates is for spatial parts", expected="`points` or `spacing`")
            if wishes.points is not None:
                return given_polygon_points(geometry, X_WP, wishes.points, rules, self.surface_gap)
            return sample_polygon(geometry, X_WP, wishes.spacing or self._spacing(), rules)
        if wishes.points is not None:
            return given_points(geometry, X_WP, wishes.points, rules, self.surface_gap)
        if wishes.grid is not None:
            return grid_points(geometry, X_WP, wishes.grid.origin, wishes.grid.pitch, wishes.grid.plane, rules)
        return sample_surface(geometry, X_WP, wishes.spacing or self._spacing(), rules, seed)

    def _spacing(self) -> float:
        """So that a part gets about as many candidates as are enough, whatever its size."""
        if len(self.scale().reference) == 2:
            edges = np.linalg.norm(self.geometry.edges, axis=1)  # type: ignore[union-attr]
            return float(edges.sum()) / _PLANAR
        corners = self.geometry.vertices[self.geometry.triangles]  # type: ignore[union-attr]
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
        return float(np.sqrt(areas.sum() / _SPATIAL))
