"""Convex polyhedral bodies in space as a `ContactGeometry`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, Mask, Points
from fixture_design.assembly import rotations
from fixture_design.assembly.assembly import Assembly, Region
from fixture_design.assembly.contact_geometry import refuse_too_many
from fixture_design.assembly.pair_equations import PairEquations
from fixture_design.assembly.polytope import Polytope, polytope_of
from fixture_design.assembly.separation import SeparatingAxes
from fixture_design.assembly.spatial_pairs import EdgePairs, FacetPairs, SpatialPairs, rows_of
from fixture_design.assembly.together import intervals, overlapping
from fixture_design.errors import AssemblyError
from fixture_design.tolerances import TOUCHING


@dataclass(frozen=True, eq=False)
class SpatialGeometry:
    """The contact geometry of one convex moving body and some convex fixed ones; attributes as in `ContactGeometry`.

    Fixed bodies may overlap. Features that the region keeps out of reach form no pairs.
    """

    moving: Polytope
    fixed: tuple[Polytope, ...]
    pairs: SpatialPairs
    together: np.ndarray
    axes: tuple[SeparatingAxes, ...]
    region: Region
    size: float
    radius: float
    free: Mask
    dimension: int = 6

    @classmethod
    def of(cls, assembly: Assembly) -> SpatialGeometry:
        """The geometry of an assembly.

        Raises:
            UnsupportedError: bodies that are not convex, or too many features.
            AssemblyError: nothing that can touch.
        """
        moving = polytope_of(assembly.moving)
        fixed = tuple(polytope_of(body) for body in assembly.fixed)
        reach = float(np.linalg.norm(moving.vertices, axis=1).max())
        everything = np.vstack([body.vertices for body in fixed])
        region = assembly.region or Region(everything.min(axis=0) - 1.5 * reach, everything.max(axis=0) + 1.5 * reach)
        pairs, together = _pairs(moving, fixed, region, reach)
        size = max(reach, float(np.abs([region.low, region.high]).max()))
        radius = float(np.sqrt((moving.vertices**2).sum(axis=1).mean()))
        free = np.array([True] * 3 + [region.turning != "fixed"] * 3)
        axes = tuple(SeparatingAxes.of(moving, body) for body in fixed)
        return cls(moving, fixed, pairs, together, axes, region, size, radius, free)

    @property
    def turns(self) -> slice:
        return slice(3, 6)

    @property
    def names(self) -> tuple[str, ...]:
        return self.pairs.names

    @property
    def takes_part(self) -> Mask:
        return np.ones(len(self.pairs.names), dtype=bool)

    def equations(self, q: np.ndarray, chosen: np.ndarray) -> PairEquations:
        return self.pairs.equations(rotations.matrices(q[:, 3:]), q[:, :3], chosen)

    def arms(self, q: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        return self.pairs.arms(rotations.matrices(q[:, 3:]), q[:, :3], chosen)

    def rotations(self, q: np.ndarray) -> np.ndarray:
        return rotations.matrices(q[:, 3:])

    def reach(self, q: np.ndarray) -> np.ndarray:
        return self.pairs.levers(q[:, :3])

    def at_apices(self, q: np.ndarray, distance: float) -> np.ndarray:
        return self.pairs.beyond(rotations.matrices(q[:, 3:]), q[:, :3]) >= -distance

    def coincident(self, q: np.ndarray, distance: float) -> np.ndarray:
        mine = np.einsum("nij,vj->nvi", rotations.matrices(q[:, 3:]), self.moving.vertices) + q[:, None, :3]
        theirs = np.vstack([body.vertices for body in self.fixed])
        near = np.linalg.norm(mine[:, :, None] - theirs[None, None], axis=-1) <= distance
        return near.reshape(len(q), -1).any(axis=1)

    def overlap(self, q: np.ndarray) -> np.ndarray:
        R = rotations.matrices(q[:, 3:])
        return np.max([axes.overlap(R, q[:, :3]) for axes in self.axes], axis=0)

    def moved(self, q: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        turned = rotations.product(rotations.from_vectors(displacement[:, 3:]), q[:, 3:])
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)
        return np.concatenate([q[:, :3] + displacement[:, :3], turned], axis=1)

    def between(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        turn = rotations.vectors(rotations.product(end[:, 3:], rotations.inverse(start[:, 3:])))
        return np.concatenate([end[:, :3] - start[:, :3], turn], axis=1)

    def aligned(self, q: np.ndarray) -> np.ndarray:
        """None: coincident apices in space are not tried with facets along each other."""
        return q[:0]

    def canonical(self, q: np.ndarray) -> np.ndarray:
        return np.concatenate([q[:, :3], np.where(q[:, 3:4] < 0, -q[:, 3:], q[:, 3:])], axis=1)

    def random(self, rng: np.random.Generator, count: int) -> np.ndarray:
        position = rng.uniform(self.region.low, self.region.high, (count, 3))
        turned = rng.normal(size=(count, 4))
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)
        if self.region.turns is not None:
            axes = turned[:, 1:] / np.linalg.norm(turned[:, 1:], axis=1, keepdims=True)
            turned = rotations.from_vectors(axes * rng.uniform(*self.region.turns, (count, 1)))
        return np.concatenate([position, turned], axis=1)

    def inside(self, q: np.ndarray) -> Mask:
        low, high = self.region.low - TOUCHING * self.size, self.region.high + TOUCHING * self.size
        found = np.logical_and(q[:, :3] >= low, q[:, :3] <= high).all(axis=1).reshape(len(q))
        if self.region.turns is None:
            return found
        return found & (np.linalg.norm(rotations.vectors(q[:, 3:]), axis=1) <= self.region.turns[1] + TOUCHING)

    def possible_together(self) -> np.ndarray:
        return self.together


@dataclass(frozen=True, eq=False)
class _Side:
    """Features of one side that may take part: names, and the ends of each for (3-19)."""

    bodies: tuple[Polytope, ...]
    apices: Points
    apex_names: tuple[str, ...]
    edges: np.ndarray
    outward: Points
    edge_names: tuple[str, ...]
    facets: tuple[tuple[int, int], ...]
    facet_names: tuple[str, ...]

    @classmethod
    def of(cls, bodies: tuple[Polytope, ...], first: tuple[int, int, int]) -> _Side:
        """``first``: how many apices, edges and facets have numbers already."""
        counts = [sum(len(getattr(b, key)) for b in bodies) for key in ("vertices", "edges", "normals")]
        names = [tuple(f"{word} {start + k + 1}" for k in range(n))
                 for word, start, n in zip(("apex", "edge", "facet"), first, counts, strict=True)]  # fmt: skip
        return cls(
            bodies,
            np.vstack([b.vertices for b in bodies]),
            names[0],
            np.vstack([b.vertices[b.edges] for b in bodies]),
            np.vstack([b.outward() for b in bodies]),
            names[1],
            tuple((i, k) for i, b in enumerate(bodies) for k in range(len(b.normals))),
            names[2],
        )

    def plane(self, k: int) -> tuple[np.ndarray, float, np.ndarray]:
        """Normal, offset and corners of a facet."""
        i, f = self.facets[k]
        body = self.bodies[i]
        return body.normals[f], float(body.offsets[f]), body.vertices[body.corners[f]]


def _pairs(
    moving: Polytope, fixed: tuple[Polytope, ...], region: Region, reach: float
) -> tuple[SpatialPairs, np.ndarray]:
    mine = _Side.of((moving,), (0, 0, 0))
    theirs = _Side.of(fixed, (len(moving.vertices), len(moving.edges), len(moving.normals)))

    def near(points: Points) -> bool:
        low, high = points.min(axis=0), points.max(axis=0)
        return bool((high >= region.low - reach).all() and (low <= region.high + reach).all())

    facets = [k for k in range(len(theirs.facets)) if near(theirs.plane(k)[2])]
    apices = [k for k in range(len(theirs.apices)) if near(theirs.apices[k][None])]
    edges = [k for k in range(len(theirs.edges)) if near(theirs.edges[k])]
    groups = [
        [(i, j) for i in range(len(mine.apices)) for j in facets],
        [(i, j) for i in range(len(mine.facets)) for j in apices],
        [(i, j) for i in range(len(mine.edges)) for j in edges],
    ]
    count = sum(map(len, groups))
    refuse_too_many(count)
    if not count:
        raise AssemblyError("nothing of the fixed bodies is in reach of the moving one in this region")
    kinds = (
        (mine.apex_names, theirs.facet_names),
        (mine.facet_names, theirs.apex_names),
        (mine.edge_names, theirs.edge_names),
    )
    names = [f"{a[i]} - {b[j]}" for (a, b), rows in zip(kinds, groups, strict=True) for i, j in rows]
    sizes = np.array([len(rows) for rows in groups])
    (a, f), (g, v), (e, h) = (rows_of(rows) for rows in groups)
    built = (_facet_pairs(mine.apices[a], theirs, f, True), _facet_pairs(theirs.apices[v], mine, g, False))
    edge_pairs = EdgePairs(mine.edges[e], theirs.edges[h], theirs.outward[h])
    return SpatialPairs(tuple(names), (*built, edge_pairs), sizes), _together(mine, theirs, groups)


def _facet_pairs(apices: Points, facets: _Side, chosen: Indices, apex_moves: bool) -> FacetPairs:
    planes = [facets.plane(k) for k in range(len(facets.facets))]
    most = max(len(corners) for _, _, corners in planes)
    rims = np.array([_rim(normal, corners, most) for normal, _, corners in planes])
    normals, offsets = np.array([p[0] for p in planes]), np.array([p[1] for p in planes])
    return FacetPairs(apex_moves, apices, normals[chosen], offsets[chosen], rims[chosen])


def _rim(normal: np.ndarray, corners: Points, most: int) -> np.ndarray:
    along = np.roll(corners, -1, axis=0) - corners
    across = np.cross(along, normal)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    rows = np.column_stack([across, np.einsum("ij,ij->i", across, corners)])
    return np.vstack([rows, np.repeat(rows[-1:], most - len(rows), axis=0)])


def _together(mine: _Side, theirs: _Side, groups: list[list[tuple[int, int]]]) -> np.ndarray:
    """(3-20) for apices and edges; facets are given the distances from nothing to their farthest corners."""
    sides = []
    for k, side in enumerate((mine, theirs)):
        ends = []
        for kind, rows in enumerate(groups):
            own = [pair[k] for pair in rows]
            if kind == 2:
                ends += [side.edges[i] for i in own]
            elif (kind == 0) == (k == 0):
                ends += [np.repeat(side.apices[i][None], 2, axis=0) for i in own]
            else:
                ends += [None] * len(own)
        sides.append(_ranges(ends, side))
    return overlapping(sides[0], sides[1], TOUCHING * float(np.abs(theirs.apices).max()))


def _ranges(ends: list, side: _Side) -> np.ndarray:
    """Distances between features; anything is possible for facets."""
    known = np.array([end is not None for end in ends])
    largest = 2 * float(np.linalg.norm(side.apices - side.apices.mean(axis=0), axis=1).max())
    table = np.zeros((len(ends), len(ends), 2))
    table[..., 1] = largest
    if known.any():
        found = intervals(np.array([end for end in ends if end is not None]))
        # segments in space: the nearest ends bound nothing from below, so that only points keep their distance
        points = np.array([bool((end[0] == end[1]).all()) for end in ends if end is not None])
        found[..., 0] = np.where(points[:, None] & points[None], found[..., 0], 0.0)
        table[np.ix_(known, known)] = found
    return table
