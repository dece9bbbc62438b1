"""The features of bodies in space that can meet in a region, and the pairs that they form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Points, Weights
from fixture_design.assembly.assembly import Region
from fixture_design.assembly.contact_geometry import refuse_too_many
from fixture_design.assembly.edge_pairs import EdgePairs
from fixture_design.assembly.facet_pairs import FacetPairs
from fixture_design.assembly.polyhedron import Polyhedron
from fixture_design.assembly.rims import ConvexRims, PolygonRims, Rims
from fixture_design.assembly.spatial_pairs import SpatialPairs
from fixture_design.assembly.together import intervals, overlapping
from fixture_design.errors import AssemblyError
from fixture_design.tolerances import TOUCHING


@dataclass(frozen=True, eq=False)
class _Side:
    """Features of one side that may take part: names, and the ends of each for (3-19)."""

    bodies: tuple[Polyhedron, ...]
    apices: Points
    apex_names: tuple[str, ...]
    edges: np.ndarray
    outward: Points
    edge_names: tuple[str, ...]
    facets: tuple[tuple[int, int], ...]
    facet_names: tuple[str, ...]

    @classmethod
    def of(cls, bodies: tuple[Polyhedron, ...], first: tuple[int, int, int]) -> _Side:
        """``first``: how many apices, edges and facets have numbers already."""
        counts = [sum(len(getattr(b, key)) for b in bodies) for key in ("vertices", "edges", "normals")]
        names = [tuple(f"{word} {start + k + 1}" for k in range(n))
                 for word, start, n in zip(("apex", "edge", "facet"), first, counts, strict=True)]  # fmt: skip
        return cls(
            bodies,
            np.vstack([b.vertices for b in bodies]),
            names[0],
            np.concatenate([b.edges for b in bodies]),
            np.vstack([b.outward for b in bodies]),
            names[1],
            tuple((i, k) for i, b in enumerate(bodies) for k in range(len(b.normals))),
            names[2],
        )

    def border(self, k: int) -> np.ndarray:
        """Segments around a facet."""
        i, f = self.facets[k]
        return self.bodies[i].borders[f]

    def planes(self) -> tuple[Points, Weights]:
        """Normals and offsets of the facets."""
        return np.vstack([b.normals for b in self.bodies]), np.concatenate([b.offsets for b in self.bodies])

    def rims(self) -> Rims:
        """Of all facets, as half planes if each is convex."""
        kind = ConvexRims if all(all(b.rings) for b in self.bodies) else PolygonRims
        return kind.around(self.planes()[0], [border for b in self.bodies for border in b.borders])


def pairs_in_reach(
    moving: Polyhedron, fixed: tuple[Polyhedron, ...], region: Region, reach: float
) -> tuple[SpatialPairs, np.ndarray]:
    """All pairs that can meet in a region, and which of them may touch at once (3-20).

    Args:
        reach: of the moving body from its origin [m].

    Raises:
        UnsupportedError: too many pairs.
        AssemblyError: none.
    """
    mine = _Side.of((moving,), (0, 0, 0))
    theirs = _Side.of(fixed, (len(moving.vertices), len(moving.edges), len(moving.normals)))

    def near(points: Points) -> bool:
        low, high = points.min(axis=0), points.max(axis=0)
        return bool((high >= region.low - reach).all() and (low <= region.high + reach).all())

    facets = [k for k in range(len(theirs.facets)) if near(theirs.border(k).reshape(-1, 3))]
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
    built = (
        _facet_pairs(mine.apices, theirs, facets, True),
        _facet_pairs(theirs.apices[apices], mine, list(range(len(mine.facets))), False),
        EdgePairs(mine.edges, theirs.edges[edges], theirs.outward[edges]),
    )
    return SpatialPairs(tuple(names), built, sizes), _together(mine, theirs, groups)


def _facet_pairs(apices: Points, side: _Side, facets: list[int], apex_moves: bool) -> FacetPairs:
    normals, offsets = side.planes()
    chosen = np.array(facets, dtype=int)
    return FacetPairs.of(apex_moves, apices, (normals[chosen], offsets[chosen]), side.rims().of(chosen))


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
