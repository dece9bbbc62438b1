"""Three edges and three holes: the candidates of which poses are made, with all but hopeless ones left out.

Fixtures that differ by a translation or a turn of the grid are one. Its one name here: the three edges in rising order,
locators on the same edge in their order along it; the first hole at [0, 0]; the second one in the quadrant x > 0,
y >= 0, into which exactly one of the four turns takes it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Int

from fixture_design.arrays import Indices
from fixture_design.design.plates.grown_edges import GrownEdges, distances
from fixture_design.design.plates.plate import Plate

#: Candidates that are looked at together: enough to make numpy worth it, few enough for the processor's cache.
BATCH = 50_000


@dataclass(frozen=True, eq=False)
class Triples:
    """Candidates: which grown edges, shape (k, 3), and which holes in pitches from the first one, shape (k, 3, 2)."""

    edges: Int[np.ndarray, "k 3"]
    holes: Int[np.ndarray, "k 3 2"]


def candidate_triples(grown: GrownEdges, plate: Plate, tie: float) -> Iterator[Triples]:
    """All candidates of a plate, in batches.

    Two holes may carry locators on two edges only if their distance is one that points of the two grown edges have: an
    annulus around the first hole (Brost and Goldberg 1996); all three pairs are asked. The holes must fit on the plate.
    """
    near = _annuli(grown, plate, tie)
    waiting: list[Triples] = []
    for first in range(len(grown.edges)):
        for second in range(first, len(grown.edges)):
            for triples in _with_third(first, second, near, plate):
                waiting.append(triples)
                if sum(len(triples.edges) for triples in waiting) >= BATCH:
                    yield _joined(waiting)
                    waiting = []
    if waiting:
        yield _joined(waiting)


def _annuli(grown: GrownEdges, plate: Plate, tie: float) -> Bool[np.ndarray, "n n m m"]:
    """Whether the hole [x, y] from another may carry the second edge's locator while that carries the first's.

    The last two axes are x and y + reach; negative indices wrap around as Python's do.
    """
    steps = np.arange(-plate.reach, plate.reach + 1)
    order = np.concatenate([steps[steps >= 0], steps[steps < 0]])
    apart = plate.pitch * np.hypot(order[:, None], order[None, :])
    nearest, farthest = distances(grown)
    return (
        (apart > 0)
        & (nearest[..., None, None] - tie <= apart)
        & (apart <= farthest[..., None, None] + tie)
        & plate.holds(np.stack(np.broadcast_arrays(abs(order)[:, None], abs(order)[None, :]), axis=-1))
    )


def _with_third(first: int, second: int, near: Bool[np.ndarray, "n n m m"], plate: Plate) -> Iterator[Triples]:
    """All candidates with these two edges in front, a few second holes at a time."""
    reach = plate.reach
    seconds = np.argwhere(near[first, second, : reach + 1, : reach + 1])
    seconds = seconds[seconds[:, 0] > 0]
    thirds = np.argwhere(near[first, second:])
    if not (len(seconds) and len(thirds)):
        return
    edges, holes = thirds[:, 0] + second, thirds[:, 1:]
    holes = np.where(holes > reach, holes - (2 * reach + 1), holes)
    for some in np.array_split(seconds, -(-len(seconds) * len(thirds) // (4 * BATCH))):
        low = np.minimum(np.minimum(holes, 0), some[:, None])
        high = np.maximum(np.maximum(holes, 0), some[:, None])
        left, right = np.nonzero(plate.holds(high - low))
        step = holes[right] - some[left]
        kept = near[second, edges[right], step[:, 0], step[:, 1]]
        left, right = left[kept], right[kept]
        named = np.column_stack([np.full(len(right), first), np.full(len(right), second), edges[right]])
        yield Triples(named, np.stack([np.zeros_like(holes[right]), some[left], holes[right]], axis=1))


def _joined(parts: list[Triples]) -> Triples:
    return Triples(np.concatenate([p.edges for p in parts]), np.concatenate([p.holes for p in parts]))


def unique_rows(edges: Int[np.ndarray, "k 3"], count: int) -> tuple[Int[np.ndarray, "t 3"], Indices]:
    """The edge triples that occur, and which of them each row is."""
    code = (edges[:, 0] * count + edges[:, 1]) * count + edges[:, 2]
    found, which = np.unique(code, return_inverse=True)
    return np.column_stack([found // count**2, found // count % count, found % count]), which
