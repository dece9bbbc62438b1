"""Regions: among which candidates locators have a straight way out, and how few clamps could close with them.

The bound of a region lets *all* of its candidates be locators: what does not close with them does not close with some.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Indices, Mask, Point
from fixture_design.design.hitting import Hitting, fewest_stopping
from fixture_design.design.problem import Problem
from fixture_design.design.straight import cells, different
from fixture_design.tolerances import COPLANAR_ANGLE

#: Regions that are bounded at most.
MOST_BOUNDED = 64

#: A region that needs this many clamps more than another one need not be known any better.
_AND_MORE = 2


@dataclass(frozen=True, eq=False)
class Region:
    """Candidates among which locators have a straight way out, and how few clamps could close with them."""

    out: Point | None
    pool: Indices
    clamps: Hitting | None

    @property
    def bound(self) -> int:
        return 0 if self.clamps is None else self.clamps.bound


def regions_of(problem: Problem, seed: int) -> tuple[list[Region], bool]:
    """The regions that have enough locators, those with the fewest clamps first; and whether these are all."""
    if not problem.leaves:
        clamps = None if problem.closes is None else _clamps_of_all(problem)
        return [Region(None, problem.new, clamps)], True
    regions: list[Region] = []
    found, complete = ways_out(problem, seed)
    for direction, allowed in found:
        pool = problem.new[allowed[problem.new]]
        if not allowed[list(problem.locators)].all():
            continue
        if not _enough(problem, pool):
            complete = complete and problem.determines  # fewer locators than are looked for might do
            continue
        if problem.closes is None:
            regions.append(Region(direction, pool, None))
            continue
        least = min((region.bound for region in regions), default=np.inf)
        clamps = _bounded(problem, pool, float(least + _AND_MORE))
        if clamps.chosen is not None or not clamps.complete:
            regions.append(Region(direction, pool, clamps))
    regions.sort(key=lambda region: (region.bound, -len(region.pool)))
    return regions, complete


def ways_out(problem: Problem, seed: int) -> tuple[list[tuple[Point | None, Mask]], bool]:
    """Directions out, each with the candidates that the part leaves there, shape (n,); and whether these are all."""
    several = problem.candidates.normals
    if not problem.leaves:
        return [(None, np.ones(len(several), dtype=bool))], True
    flat_normals = several.reshape(-1, several.shape[2])
    said: Mask = np.any(flat_normals, axis=1)
    unit, which = different(flat_normals[said])
    asked = problem.limits.way_out
    found, complete = cells(unit, asked, seed, sliding=not problem.lets_go)
    ways: list[tuple[Point | None, Mask]] = []
    for cell in found[:MOST_BOUNDED]:
        leaves = np.ones(len(flat_normals), dtype=bool)
        leaves[said] = cell.leaves[which]
        ways.append((cell.direction if asked is None else asked, np.all(leaves.reshape(len(several), -1), axis=1)))
    return ways, complete and len(found) <= MOST_BOUNDED


def least_clamps_sliding(problem: Problem, seed: int, enough: int) -> float:
    """No layout has fewer clamps, or inf if there is none, even if the part may slide out along its locators; 0 where
    that is not known.

    Args:
        enough: a bound that need not be known any better.
    """
    ways, complete = ways_out(replace(problem, opens=False), seed)
    least = np.inf
    for _, allowed in ways if complete else []:
        pool = problem.new[allowed[problem.new]]
        if not allowed[list(problem.locators)].all() or (problem.determines and not _enough(problem, pool)):
            continue
        clamps = None if problem.closes is None else _bounded(problem, pool, float(enough))
        if clamps is None or clamps.chosen is not None or not clamps.complete or clamps.bound >= enough:
            least = min(least, 0.0 if clamps is None else float(clamps.bound))
    return float(least) if complete else 0.0


def bounded_region(problem: Problem, out: Point) -> Region | None:
    """New candidates that a direction leaves, and how few clamps could close with them; None if they are too few."""
    products = problem.candidates.normals @ out
    said = np.any(problem.candidates.normals, axis=2)
    leaves: Mask = np.all(~said | (products < -COPLANAR_ANGLE), axis=1)
    pool = problem.new[leaves[problem.new]]
    if not _enough(problem, pool):
        return None
    clamps = None if problem.closes is None else _bounded(problem, pool, np.inf)
    return None if clamps is not None and clamps.chosen is None and clamps.complete else Region(out, pool, clamps)


def _enough(problem: Problem, pool: Indices) -> bool:
    """Whether locators from the pool can notice all that the candidates together can."""
    numbers = problem.rows_of(np.concatenate([pool, np.array(problem.locators, dtype=np.int64)]))
    if len(numbers) < problem.candidates.freedoms:
        return False
    values = np.linalg.svd(problem.rows[numbers], compute_uv=False)
    return int((values > problem.candidates.tolerances.near * values[0]).sum()) >= problem.candidates.freedoms


def _bounded(problem: Problem, pool: Indices, enough: float) -> Hitting:
    """The fewest clamps that close with every locator that is allowed, or only that they are ``enough`` in number."""
    base = np.concatenate([pool, problem.kept])
    others = np.setdiff1d(problem.clampable, base)
    found = fewest_stopping(
        problem.bounding_rows, base, others, tolerances=problem.candidates.tolerances,
        enough=enough - len(problem.clamps), cancelled=problem.cancelled,
    )  # fmt: skip
    return Hitting(found.chosen, found.bound + len(problem.clamps), found.free, found.cuts, found.complete)


def _clamps_of_all(problem: Problem) -> Hitting:
    """Without a way out: what leaves the locators some motion is stopped by a clamp."""
    needs = 1 if problem.enters else 0
    dimension = problem.candidates.dimension
    return Hitting(problem.new[:0], max(needs, len(problem.clamps)), None, np.empty((0, dimension)))
