"""Which facets stand for one round surface: small patches are fitted, and grow over neighbours that lie on the fit."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from fixture_design.geometry.facet_data import STEP, FacetData, Region
from fixture_design.geometry.facets import Facet
from fixture_design.geometry.growing import grown, linked, patches
from fixture_design.geometry.round_fits import refitted
from fixture_design.geometry.shapes import Directions, Triangles, Vertices
from fixture_design.geometry.smooth_surface import RoundKind, RoundShape, SmoothSurface
from fixture_design.geometry.turned import TurnedPiece

#: Corners of one surface may be off another by this many tolerances, for both to be tried as one [-].
_SAME = 100.0
#: Seeds that may fail among facets that hang together smoothly, before the rest of them is given up.
_MOST_FAILURES = 25
#: A surface whose normals are known no better than this is not known [rad].
_VAGUE = 1e-2


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
    search = _Search.of(FacetData.of(facets, vertices, triangles, noise))
    search.free -= {facet for _, members in given for facet in members}
    for piece in turned:
        search.facets.keep_middles_on(piece, triangles)
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
    fitted = [search.facets.surface(region, known=False) for region in search.found]
    known = [search.facets.surface(region, known=True) for region in given]
    found = [*known, *(surface for surface in fitted if surface.normal_error <= _VAGUE)]
    found.sort(key=lambda surface: _order(surface, search.facets.size))
    counts = Counter[str]()
    named = []
    for surface in found:
        counts[surface.kind] += 1
        named.append(replace(surface, name=f"{surface.kind} {counts[surface.kind]}"))
    turns = sorted({piece.number for piece in bands})
    named += [replace(search.facets.band(piece), name=f"turned {turns.index(piece.number) + 1}") for piece in bands]
    return tuple(named)


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
    """The facets that no surface has yet, and the surfaces found so far."""

    facets: FacetData
    free: set[int]
    found: list[Region] = field(default_factory=list)
    failures: Counter[int] = field(default_factory=Counter)

    @classmethod
    def of(cls, facets: FacetData) -> _Search:
        return cls(facets, set(facets.candidates))

    @cached_property
    def component(self) -> dict[int, int]:
        """For each facet that may stand for a round surface the first of those that hang together with it smoothly."""
        owner: dict[int, int] = {}
        for facet in sorted(self.free):
            if facet not in owner:
                owner |= dict.fromkeys(linked(self.facets, self.free, facet), facet)
        return owner

    def seeds(self) -> Iterator[int]:
        """Facets that are still free, the largest first."""
        for seed in sorted(self.free & self.facets.doubtful, key=lambda facet: (-self.facets.areas[facet], facet)):
            if seed in self.free and self.failures[self.component[seed]] < _MOST_FAILURES:
                yield seed

    def try_seed(self, seed: int) -> None:
        """Look for a surface that the seed is on; if there is one, its facets are not free any more."""
        best: Region | None = None
        for patch, kinds in patches(self.facets, self.free, seed):
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

    def try_turned(self, piece: TurnedPiece) -> bool:
        """Fit a surface that rings of vertices have shown, and grow it over facets that other features cut.

        Returns:
            Whether it could be; if not, its facets are free.
        """
        facets, members = self.facets, set(piece.facets)
        points = facets.points(piece.facets)
        shape = refitted(piece.shape, points) if facets.believable(piece.shape.kind, piece.facets, points) else None
        if shape is None or np.abs(shape.offsets(points)).max() > facets.tolerance:
            self.free |= members & facets.candidates
            return False
        if any(other in self.free for facet in members for other in facets.smooth[facet]):
            self.free |= members
            largest = max(piece.facets, key=lambda facet: (facets.areas[facet], facet))
            members |= set(grown(facets, self.free, shape, largest))
        self.found.append((_one_way(shape), sorted(members)))
        self.free -= members
        return True

    def left_of(self, piece: TurnedPiece) -> TurnedPiece | None:
        """What no surface has taken of a piece that could not be fitted: it is turned all the same.

        Its profile is what the rings say, as well as they say it.
        """
        taken = {facet for _, members in self.found for facet in members}
        left = [facet for facet in piece.facets if facet not in taken]
        points = self.facets.points(piece.facets)
        if not left or not self.facets.believable(piece.shape.kind, piece.facets, points):
            return None
        off = max(float(np.abs(piece.shape.offsets(self.facets.points(left))).max()), self.facets.tolerance)
        return replace(piece, facets=left, profile_error=2 * off / float(self.facets.widths[left].min()))

    def merge(self) -> None:
        """Make one of surfaces that are one: a slot cuts a bore in two, and the halves have no facet in common."""
        kept: list[tuple[Region, Directions]] = []
        for region in self.found:
            points = self.facets.points_on(*region)
            for index, (other, others) in enumerate(kept):
                if self._alike(other[0], region[0]) and self._near(other[0], points):
                    both = self._both(other, region, np.vstack([others, points]))
                    if both is not None:
                        kept[index] = both, self.facets.points_on(*both)
                        break
            else:
                kept.append((region, points))
        self.found = [region for region, _ in kept]

    def _near(self, shape: RoundShape, points: Directions) -> bool:
        """Whether the corners of one surface are near enough to another to try both as one."""
        return bool(np.abs(shape.offsets(points)).max() <= _SAME * self.facets.tolerance)

    def _alike(self, one: RoundShape, other: RoundShape) -> bool:
        """Whether two shapes may be one, by kind, size and direction: cheap, since all pairs are asked."""
        unit = self.facets.size if one.kind == "cone" else 1.0
        if one.kind != other.kind or abs(one.radius - other.radius) * unit > _SAME * self.facets.tolerance:
            return False
        return one.kind == "sphere" or bool(abs(one.axis @ other.axis) > np.cos(STEP / 10))

    def _both(self, one: Region, other: Region, points: Directions) -> Region | None:
        """One surface with the facets of two, if all corners are on it and they have the material on one side."""
        if self.facets.hollow(*one) != self.facets.hollow(*other):
            return None
        members = sorted(one[1] + other[1])
        shape = self.facets.fit(one[0].kind, members, points)
        return None if shape is None else (_one_way(shape), members)

    def _complete(self, members: list[int]) -> bool:
        """Whether the surface ends all around: no free facet goes on smoothly, as those of a torus do beside a band."""
        inside = set(members)
        return not any(o in self.free and o not in inside for facet in members for o in self.facets.smooth[facet])

    def _region(self, kind: RoundKind, patch: list[int]) -> Region | None:
        """A surface fitted to a patch and all facets that lie on it, if they are enough to believe it."""
        shape, members = self.facets.fit(kind, patch, self.facets.points(patch)), patch
        for _ in range(3):
            if shape is None:
                return None
            wider = grown(self.facets, self.free, shape, patch[0])
            if wider == members:
                break
            if len(wider) < len(patch):
                return None
            members = wider
            shape = self.facets.fit(kind, members, self.facets.points_on(shape, members))
        if shape is None or not self.facets.believable(kind, members, self.facets.points_on(shape, members)):
            return None
        return shape, members
