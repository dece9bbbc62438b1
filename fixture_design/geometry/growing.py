"""Patches of smooth facets, and how a surface that was fitted to one grows over those around it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from itertools import combinations

from fixture_design.geometry.facet_data import FacetData
from fixture_design.geometry.smooth_surface import RoundKind, RoundShape

#: A facet's middle may be this many times as deep under the surface as those of the others.
_DEEPER = 2.5
#: Neighbours of a facet that are combined to patches, and facets in the largest patch.
_MOST_NEIGHBOURS, _LARGEST_PATCH = 6, 40


def patches(facets: FacetData, free: Set[int], seed: int) -> Iterator[tuple[list[int], tuple[RoundKind, ...]]]:
    """A facet with two of its neighbours, then with all around it, wider and wider; and what to try on each.

    Edges of cylinders, cones and spheres are all convex or all concave; only a torus may have both.
    """
    around = {facet: angle for facet, angle in facets.smooth[seed].items() if facet in free}
    for first, second in combinations(list(around)[:_MOST_NEIGHBOURS], 2):
        if around[first] * around[second] > 0:
            yield [seed, first, second], ("cylinder", "cone")
    before = 0
    for steps in (1, 2, 3):
        patch = _around(facets, free, seed, steps)
        if len(patch) > _LARGEST_PATCH or len(patch) == before:
            return
        before = len(patch)
        angles = [facets.smooth[one][other] for one in patch for other in facets.smooth[one] if other in patch]
        one_way = min(angles, default=0) * max(angles, default=0) > 0
        yield patch, ("cylinder", "cone", "sphere", "torus") if one_way else ("torus",)


def _around(facets: FacetData, free: Set[int], seed: int, steps: int) -> list[int]:
    patch, edge = [seed], [seed]
    for _ in range(steps):
        edge = sorted({o for facet in edge for o in facets.smooth[facet] if o in free} - set(patch))
        patch += edge
    return patch


def grown(facets: FacetData, free: Set[int], shape: RoundShape, seed: int) -> list[int]:
    """The free facets that lie on the surface and hang together with the seed.

    Facets are judged once, many at a time: those some steps ahead of what has been reached, twice as far each time.
    """
    middle = facets.middles[seed][None]
    deepest = _DEEPER * abs(float(shape.offsets(middle)[0])) + facets.tolerance
    sense = -1.0 if shape.directions(middle)[0] @ facets.units[seed] < 0 else 1.0
    on: dict[int, bool] = {}
    members: set[int] = set()
    waiting, steps = {seed}, 4
    while waiting:
        ahead = _ahead(facets, free, waiting, steps, on)
        on |= zip(ahead, facets.lie_on(shape, ahead, deepest, sense), strict=True)
        reached, waiting = list(waiting), set()
        while reached:
            facet = reached.pop()
            if facet not in on:
                waiting.add(facet)
            elif on[facet] and facet not in members:
                members.add(facet)
                reached += [o for o in facets.smooth[facet] if o in free and o not in members]
        steps *= 2
    return sorted(members)


def _ahead(facets: FacetData, free: Set[int], start: set[int], steps: int, judged: Mapping[int, bool]) -> list[int]:
    """Free facets at most so many steps from some, without those that are judged."""
    seen, edge = set(start), start
    for _ in range(steps):
        edge = {o for facet in edge for o in facets.smooth[facet] if o in free and o not in judged} - seen
        if not edge:
            break
        seen |= edge
    return sorted(seen)


def linked(facets: FacetData, free: Set[int], seed: int) -> list[int]:
    """Those of the free facets that hang together with the seed, if that is one of them."""
    members, waiting = {seed} & free, list({seed} & free)
    while waiting:
        new = [o for o in facets.smooth[waiting.pop()] if o in free and o not in members]
        members.update(new)
        waiting += new
    return list(members)
