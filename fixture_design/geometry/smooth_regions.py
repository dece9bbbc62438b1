"""Which facets stand for one round surface: small patches are fitted, and grow over neighbours that lie on the fit.

A facet lies on a surface if all its corners do, up to the noise of the vertices, if it faces the same way, and if it is
no coarser than the others: a flat cut into a shaft has its corners on the shaft too, but its middle is deeper.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.geometry.facets import Facet
from fixture_design.geometry.round_fits import Patch, fitted, normal_error, refitted
from fixture_design.geometry.shapes import Directions, FacetVectors, OfFacet, PerFacet, Triangles, Vertices
from fixture_design.geometry.smooth_surface import RoundKind, RoundShape, SmoothSurface
from fixture_design.geometry.turned import TurnedPiece
from fixture_design.tolerances import ON_EDGE_ROUNDINGS, ROUND_FIT, SMOOTH_ANGLE

#: Facets and vertices that a surface must have, so that it is no accident that they fit: three bevels between two flats
#: always do, if they are symmetric.
_FEWEST: dict[RoundKind, tuple[int, int]] = {"cylinder": (4, 10), "cone": (4, 9), "sphere": (6, 8), "torus": (9, 12)}
#: A facet's middle may be this many times as deep under the surface as those of the others.
_DEEPER = 2.5
#: Corners of one surface may be off another by this many tolerances, for both to be tried as one [-].
_SAME = 100.0
#: Smooth neighbours that a strip has, and triangles it is made of, at most.
_STRIP_SIDES, _STRIP_TRIANGLES = 2, 12
#: Corners on the surface that make up for others of the same facet that lie on chords.
_FEWEST_ON = 4
#: Neighbours of a facet that are combined to patches, and facets in the largest patch.
_MOST_NEIGHBOURS, _LARGEST_PATCH = 6, 40
#: Seeds that may fail among facets that hang together smoothly, before the rest of them is given up.
_MOST_FAILURES = 25
#: Corners this many tolerances from the axis are at a cone's apex [-].
_AT_APEX = 10.0
#: Angle between a facet's normal and those of the surface at its corners, at most [rad]: half a coarse step.
_STEP = 0.7 * SMOOTH_ANGLE
#: A surface whose normals are known no better than this is not known [rad].
_VAGUE = 1e-2


#: A round surface and the facets that stand for it.
Region = tuple[RoundShape, list[int]]


def fit_tolerance(vertices: Vertices, noise: float) -> float:
    """How far vertices that are known to within ``noise`` may be off a round surface that they lie on [m]."""
    return ON_EDGE_ROUNDINGS * noise + ROUND_FIT * part_size(vertices)


def part_size(vertices: Vertices) -> float:
    """The diagonal of the bounding box [m]."""
    return float(np.linalg.norm(np.ptp(vertices, axis=0)))


def smooth_surfaces(
    facets: Sequence[Facet],
    vertices: Vertices,
    triangles: Triangles,
    noise: float,
    given: Sequence[Region] = (),
    turned: Sequence[TurnedPiece] = (),
    look: bool = True,
) -> tuple[SmoothSurface, ...]:
    """The round surfaces of a part, named by kind in the order of their places.

    Args:
        facets: those whose provenance is approximate may stand for one.
        noise: how well vertices are known [m].
        given: surfaces that are known exactly.
        turned: pieces of surfaces of revolution.
        look: whether to look for others.
    """
    search = _Search.of(facets, vertices, triangles, noise)
    search.free -= {facet for _, members in given for facet in members}
    for piece in turned:
        search.keep_middles_on(piece, triangles)
    bands = [piece for piece in turned if piece.smooth and piece.profile_error]
    not_fitted = []
    search.free -= {facet for piece in turned if not piece.is_plane or piece.profile_error for facet in piece.facets}
    if look:
        for piece in turned:
            if piece.smooth and not piece.profile_error and not piece.is_plane and not search.try_turned(piece):
                not_fitted.append(piece)
        for seed in search.seeds():
            search.try_seed(seed)
        search.merge()
        bands += [piece for unfit in not_fitted if (piece := search.left_of(unfit)) is not None]
    fitted = [search.surface(region, known=False) for region in search.found]
    known = [search.surface(region, known=True) for region in given]
    found = [*known, *(surface for surface in fitted if surface.normal_error <= _VAGUE)]
    found.sort(key=lambda surface: _order(surface, search.size))
    counts = Counter[str]()
    named = []
    for surface in found:
        counts[surface.kind] += 1
        named.append(replace(surface, name=f"{surface.kind} {counts[surface.kind]}"))
    turns = sorted({piece.number for piece in bands})
    named += [replace(search.band(piece), name=f"turned {turns.index(piece.number) + 1}") for piece in bands]
    return tuple(named)


def may_be_round(facet: Facet) -> bool:
    """Whether a facet may stand for a round surface: it is doubtful, or an outwardly flat strip between narrower ones.

    Such a strip has few corners and meets its neighbours smoothly.
    """
    if facet.provenance.kind == "approximate":
        return True
    smooth = sum(abs(angle) < SMOOTH_ANGLE for angle in facet.angles.values())
    return smooth >= _STRIP_SIDES and len(facet.triangles) <= _STRIP_TRIANGLES


def _order(surface: SmoothSurface, size: float) -> tuple[str, list[float]]:
    """Rounded, so that names do not hang on the last bit."""
    place = np.array([*surface.point, surface.radius]) / size
    return surface.kind, [*np.round([*place, *surface.axis], 6).tolist(), float(surface.facets[0])]


def _one_way(shape: RoundShape) -> RoundShape:
    """The axis so that its largest component is positive; a cone's runs into the cone."""
    largest = shape.axis[int(np.argmax(np.abs(shape.axis) > np.abs(shape.axis).max() - 1e-6))]
    return shape if shape.kind == "cone" or largest > 0 else replace(shape, axis=-shape.axis)


@dataclass(eq=False)
class _Search:
    """The facets with what is asked of them again and again, and the surfaces found so far."""

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
    free: set[int]
    doubtful: set[int]
    tolerance: float
    noise: float
    size: float
    found: list[Region] = field(default_factory=list)
    failures: Counter[int] = field(default_factory=Counter)

    @cached_property
    def component(self) -> dict[int, int]:
        """For each facet that may stand for a round surface the first of those that hang together with it smoothly."""
        owner: dict[int, int] = {}
        for facet in sorted(self.free):
            if facet not in owner:
                owner |= dict.fromkeys(self._linked(facet, self.free), facet)
        return owner

    @classmethod
    def of(cls, facets: Sequence[Facet], vertices: Vertices, triangles: Triangles, noise: float) -> _Search:
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
            set(candidates),
            {i for i, facet in enumerate(facets) if facet.provenance.kind == "approximate"},
            fit_tolerance(vertices, noise),
            noise,
            size,
        )

    def seeds(self) -> Iterator[int]:
        """Facets that are still free, the largest first."""
        for seed in sorted(self.free & self.doubtful, key=lambda facet: (-self.areas[facet], facet)):
            if seed in self.free and self.failures[self.component[seed]] < _MOST_FAILURES:
                yield seed

    def try_seed(self, seed: int) -> None:
        """Look for a surface that the seed is on; if there is one, its facets are not free any more."""
        best: Region | None = None
        for patch, kinds in self._patches(seed):
            for kind in kinds:
                if best is not None and kind == best[0].kind and set(patch).issubset(best[1]):
                    continue  # it would grow to the same
                region = self._region(kind, patch)
                if region is not None and (best is None or len(region[1]) > len(best[1])):
                    best = region
            if best is not None and self._complete(best[1]):
                break
        if best is None:
            self.failures[self.component[seed]] += 1
            return
        self.found.append((_one_way(best[0]), best[1]))
        self.free -= set(best[1])

    def keep_middles_on(self, piece: TurnedPiece, triangles: Triangles) -> None:
        """The middle of a plane ring is on the axis, where its surface is not: its largest triangle's counts."""
        for facet in piece.facets:
            reach = piece.shape.reaches(np.vstack([self.vertices[self.corners[facet]], self.middles[facet]]))
            if reach[-1] < reach[:-1].min() / 2:
                corners = self.vertices[triangles[self.triangles_of[facet]]]
                areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
                self.middles[facet] = corners[np.argmax(areas)].mean(axis=0)

    def try_turned(self, piece: TurnedPiece) -> bool:
        """Fit a surface that rings of vertices have shown, and grow it over facets that other features cut.

        Returns:
            Whether it could be; if not, its facets are free.
        """
        points, members = self._points(piece.facets), set(piece.facets)
        shape = refitted(piece.shape, points) if self._enough(piece) else None
        if shape is None or np.abs(shape.offsets(points)).max() > self.tolerance:
            self.free |= members & self.candidates
            return False
        if any(other in self.free for facet in members for other in self.smooth[facet]):
            self.free |= members
            members |= set(self._grown(shape, max(piece.facets, key=lambda facet: (self.areas[facet], facet))))
        self.found.append((_one_way(shape), sorted(members)))
        self.free -= members
        return True

    def left_of(self, piece: TurnedPiece) -> TurnedPiece | None:
        """What no surface has taken of a piece that could not be fitted: it is turned all the same.

        Its profile is what the rings say, as well as they say it.
        """
        taken = {facet for _, members in self.found for facet in members}
        left = [facet for facet in piece.facets if facet not in taken]
        if not left or not self._enough(piece):
            return None
        off = max(float(np.abs(piece.shape.offsets(self._points(left))).max()), self.tolerance)
        return replace(piece, facets=left, profile_error=2 * off / float(self.widths[left].min()))

    def _enough(self, piece: TurnedPiece) -> bool:
        """Whether a piece has so many facets and vertices that it is no accident that they fit."""
        facets, points = _FEWEST[piece.shape.kind]
        return len(piece.facets) >= facets and len(self._points(piece.facets)) >= points

    def band(self, piece: TurnedPiece) -> SmoothSurface:
        """The surface through two rings of a profile that is not known, without a name yet."""
        members = piece.facets
        points, middles = self._points(members), self.middles[members]
        return SmoothSurface(
            "",
            piece.shape,
            self._hollow(piece.shape, members),
            np.array(members, dtype=np.int64),
            float(np.abs(piece.shape.offsets(points)).max()),
            piece.profile_error + piece.axis_error,
            float(np.abs(piece.shape.offsets(middles)).max()),
            piece.axis_error,
        )

    def merge(self) -> None:
        """Make one of surfaces that are one: a slot cuts a bore in two, and the halves have no facet in common."""
        kept: list[tuple[Region, Directions]] = []
        for region in self.found:
            points = self._points_on(*region)
            for index, (other, others) in enumerate(kept):
                if self._alike(other[0], region[0]) and self._near(other[0], points):
                    both = self._both(other, region, np.vstack([others, points]))
                    if both is not None:
                        kept[index] = both, self._points_on(*both)
                        break
            else:
                kept.append((region, points))
        self.found = [region for region, _ in kept]

    def _near(self, shape: RoundShape, points: Directions) -> bool:
        """Whether the corners of one surface are near enough to another to try both as one."""
        return bool(np.abs(shape.offsets(points)).max() <= _SAME * self.tolerance)

    def _alike(self, one: RoundShape, other: RoundShape) -> bool:
        """Whether two shapes may be one, by kind, size and direction: cheap, since all pairs are asked."""
        unit = self.size if one.kind == "cone" else 1.0
        if one.kind != other.kind or abs(one.radius - other.radius) * unit > _SAME * self.tolerance:
            return False
        return one.kind == "sphere" or bool(abs(one.axis @ other.axis) > np.cos(_STEP / 10))

    def _both(self, one: Region, other: Region, points: Directions) -> Region | None:
        """One surface with the facets of two, if all corners are on it and they have the material on one side."""
        if self._hollow(*one) != self._hollow(*other):
            return None
        members = sorted(one[1] + other[1])
        shape = self._fit(one[0].kind, members, points)
        return None if shape is None else (_one_way(shape), members)

    def _complete(self, members: list[int]) -> bool:
        """Whether the surface ends all around: no free facet goes on smoothly, as those of a torus do beside a band."""
        inside = set(members)
        return not any(o in self.free and o not in inside for facet in members for o in self.smooth[facet])

    def surface(self, region: Region, *, known: bool) -> SmoothSurface:
        """The surface of a region, without a name yet; ``known``: it is exact, the vertices are rounded."""
        shape, members = region
        points, middles = self._points_on(shape, members), self.middles[members]
        error = 0.0 if known else float(np.abs(shape.offsets(points)).max())
        width = float(self.widths[members].min())
        off = 0.0 if known else normal_error(shape, points, middles, error, self.noise, width)
        sagitta = float(np.abs(shape.offsets(middles)).max())
        return SmoothSurface(
            shape.kind, shape, self._hollow(shape, members), np.array(members, dtype=np.int64), error, off, sagitta, off
        )

    def _patches(self, seed: int) -> Iterator[tuple[list[int], tuple[RoundKind, ...]]]:
        """A facet with two of its neighbours, then with all around it, wider and wider; and what to try on each.

        Edges of cylinders, cones and spheres are all convex or all concave; only a torus may have both.
        """
        around = {facet: angle for facet, angle in self.smooth[seed].items() if facet in self.free}
        for first, second in combinations(list(around)[:_MOST_NEIGHBOURS], 2):
            if around[first] * around[second] > 0:
                yield [seed, first, second], ("cylinder", "cone")
        before = 0
        for steps in (1, 2, 3):
            patch = self._around(seed, steps)
            if len(patch) > _LARGEST_PATCH or len(patch) == before:
                return
            before = len(patch)
            angles = [self.smooth[one][other] for one in patch for other in self.smooth[one] if other in patch]
            one_way = min(angles, default=0) * max(angles, default=0) > 0
            yield patch, ("cylinder", "cone", "sphere", "torus") if one_way else ("torus",)

    def _around(self, seed: int, steps: int) -> list[int]:
        patch, edge = [seed], [seed]
        for _ in range(steps):
            edge = sorted({o for facet in edge for o in self.smooth[facet] if o in self.free} - set(patch))
            patch += edge
        return patch

    def _region(self, kind: RoundKind, patch: list[int]) -> Region | None:
        """A surface fitted to a patch and all facets that lie on it, if they are enough to believe it."""
        shape, members = self._fit(kind, patch, self._points(patch)), patch
        for _ in range(3):
            if shape is None:
                return None
            grown = self._grown(shape, patch[0])
            if grown == members:
                break
            if len(grown) < len(patch):
                return None
            members = grown
            shape = self._fit(kind, members, self._points_on(shape, members))
        if shape is None or len(members) < _FEWEST[kind][0]:
            return None
        return (shape, members) if len(self._points_on(shape, members)) >= _FEWEST[kind][1] else None

    def _fit(self, kind: RoundKind, members: list[int], points: Directions) -> RoundShape | None:
        if len(points) < 4 or (kind == "cylinder" and not self._parallel(members)):
            return None
        shape = fitted(kind, Patch(points, self.units[members], self.middles[members]))
        if shape is None or np.abs(shape.offsets(points)).max() > self.tolerance:
            return None
        return shape

    def _parallel(self, members: list[int]) -> bool:
        """Whether the normals are square to one direction, as far as a first guess must be."""
        return bool(np.linalg.svd(self.units[members], compute_uv=False)[-1] < np.sin(SMOOTH_ANGLE) / 10)

    def _grown(self, shape: RoundShape, seed: int) -> list[int]:
        """The free facets that lie on the surface and hang together with the seed.

        Facets are judged once, many at a time: those some steps ahead of what has been reached, twice as far each time.
        """
        middle = self.middles[seed][None]
        deepest = _DEEPER * abs(float(shape.offsets(middle)[0])) + self.tolerance
        sense = -1.0 if shape.directions(middle)[0] @ self.units[seed] < 0 else 1.0
        on: dict[int, bool] = {}
        members: set[int] = set()
        waiting, steps = {seed}, 4
        while waiting:
            ahead = self._ahead(waiting, steps, on)
            on |= zip(ahead, self._lie_on(shape, ahead, deepest, sense), strict=True)
            reached, waiting = list(waiting), set()
            while reached:
                facet = reached.pop()
                if facet not in on:
                    waiting.add(facet)
                elif on[facet] and facet not in members:
                    members.add(facet)
                    reached += [o for o in self.smooth[facet] if o in self.free and o not in members]
            steps *= 2
        return sorted(members)

    def _ahead(self, start: set[int], steps: int, judged: Mapping[int, bool]) -> list[int]:
        """Free facets at most so many steps from some, without those that are judged."""
        seen, edge = set(start), start
        for _ in range(steps):
            edge = {o for facet in edge for o in self.smooth[facet] if o in self.free and o not in judged} - seen
            if not edge:
                break
            seen |= edge
        return sorted(seen)

    def _linked(self, seed: int, allowed: set[int]) -> list[int]:
        """Those of some facets that hang together with the seed, if that is one of them."""
        members, waiting = {seed} & allowed, list({seed} & allowed)
        while waiting:
            new = [o for o in self.smooth[waiting.pop()] if o in allowed and o not in members]
            members.update(new)
            waiting += new
        return list(members)

    def _lie_on(self, shape: RoundShape, facets: list[int], deepest: float, sense: float) -> list[bool]:
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
        return (fits & (np.minimum.reduceat(facing, starts) >= np.cos(_STEP))).tolist()

    def _hollow(self, shape: RoundShape, members: list[int]) -> bool:
        facing = np.einsum("ij,ij->i", shape.directions(self.middles[members]), self.units[members])
        return bool(facing @ self.areas[members] < 0)

    def _points(self, members: Sequence[int]) -> Directions:
        return self.vertices[np.unique(np.concatenate([self.corners[facet] for facet in members]))]

    def _points_on(self, shape: RoundShape, members: Sequence[int]) -> Directions:
        """Their corners, without those on chords."""
        points = self._points(members)
        return points[np.abs(shape.offsets(points)) <= self.tolerance]
