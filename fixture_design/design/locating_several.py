"""Locators that locate in several rows each, as pads and lines do: as few as determine the part, without redundancy.

An element with rows X (independent ones, r <= 3 of a pad on a face) adds to a set with row span S what is outside S. It
says nothing twice if X outside S still has rank r. Elements join in this order: those that say nothing twice, of these
those that say most; where there are none (two pads on square faces both stop the turn about their common edge) those
that say most. Then they are exchanged for others with as many rows as long as the part is placed more exactly.

A plane, a line and a point (3 + 2 + 1 rows) are what this finds where pads, lines and points are allowed.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from fixture_design.arrays import Indices, Mask, Rows, Weights
from fixture_design.design.candidates import Several
from fixture_design.design.problem import Problem
from fixture_design.tolerances import BETTER, DEFAULT

#: Rounds of exchanging every locator once, at most.
_MOST_ROUNDS = 20


def located_elements(problem: Problem, pool: Indices, rng: np.random.Generator) -> Indices | None:
    """Few locators of a pool that determine the part, after exchanges, the kept ones first; None if there are none."""
    chosen = [*problem.locators]
    while (basis := _span(problem, chosen)).shape[0] < problem.candidates.freedoms:
        free = pool[problem.joins(pool, [*problem.kept, *chosen]) & ~np.isin(pool, chosen)]
        said, spare, volumes = _adds(problem.candidates.locating[free], basis)
        # nothing twice before most at once, most before least redundancy
        best = np.lexsort((spare, -said, spare > 0))
        if not len(free) or said[best[0]] == 0:
            return None
        alike = (said == said[best[0]]) & (spare == spare[best[0]])
        far = np.flatnonzero(alike & (volumes >= rng.uniform(0.5, 1.0) * volumes[alike].max()))
        chosen.append(int(free[rng.choice(far)]))
    return _exchanged(problem, pool, chosen)


def fewest_locators(problem: Problem) -> int:
    """No fewer elements determine what the candidates can notice, counted with those that stay.

    By counting ranks, at most r each of new ones: ceil(freedoms / r). Rows of tips flat on a face in space are forces
    along one normal, of rank 3; two faces share the moment across both normals, so that two such tips have rank 5 at
    most.
    """
    counts = np.any(problem.candidates.locating, axis=2).sum(axis=1)[problem.new]
    most = int(counts.max(initial=1))
    missing = problem.candidates.freedoms - len(_span(problem, problem.locators))
    least = -(-missing // most)
    flat_tips = most == 3 and all(_one_normal(problem, index) for index in problem.new[counts == most].tolist())
    return len(problem.locators) + (max(least, 3) if missing == 6 and flat_tips else least)


def inexactness(problem: Problem, stacks: Several, levers: Float[np.ndarray, "n k"]) -> Weights:
    """What sets of rows are worth, shape (n,): small is good, infinite if they leave a motion.

    The worst error of a feature in its tolerances, for errors of 1 along each normal, by least squares where rows are
    redundant; without features 1 / sqrt(det D^T D).

    Args:
        stacks: unit rows of n sets, k each, shape (n, k, d).  levers: by which they have |n| = 1.
    """
    inside = stacks @ problem.noticed.T
    values = np.linalg.svd(inside, compute_uv=False)
    whole = values[:, -1] > DEFAULT.near if inside.shape[1] >= inside.shape[2] else np.zeros(len(stacks), dtype=bool)
    if problem.features is None or problem.candidates.freedoms < problem.candidates.dimension:
        volumes = np.prod(values, axis=1)
        return np.where(whole, 1.0 / np.where(whole, volumes, 1.0), np.inf)
    errors = np.full(len(stacks), np.inf)
    inverses = np.linalg.pinv(stacks[whole] * levers[whole][:, :, None])
    errors[whole] = np.abs(problem.features.rows @ inverses).sum(axis=2).max(axis=1)
    return errors


def inexactness_of(problem: Problem, chosen: Indices) -> float:
    """Of one set of elements."""
    numbers = problem.rows_of(chosen)
    return float(inexactness(problem, problem.rows[numbers][None], _levers(problem, numbers)[None])[0])


def redundancy(problem: Problem, locators: Indices) -> int:
    """How many rows of locators say what others say."""
    return len(problem.rows_of(locators)) - len(_span(problem, locators.tolist()))


def _one_normal(problem: Problem, index: int) -> bool:
    normals = problem.candidates.normals[index]
    given = normals[np.any(normals, axis=1)]
    return bool(np.abs(given - given[0]).max() <= DEFAULT.tie)


def _levers(problem: Problem, numbers: Int[np.ndarray, "*s"]) -> Float[np.ndarray, "*s"]:
    return np.ones(numbers.shape) if problem.features is None else problem.features.levers[numbers]


def _span(problem: Problem, chosen: Sequence[int]) -> Rows:
    """Orthonormal rows that span those of elements."""
    if not chosen:
        return np.empty((0, problem.candidates.dimension))
    _, values, right = np.linalg.svd(problem.rows[problem.rows_of(tuple(chosen))], full_matrices=False)
    return right[: int((values > problem.candidates.tolerances.near * values[0]).sum())]


def _adds(rows: Several, basis: Rows) -> tuple[Indices, Indices, Weights]:
    """Of elements: how many motions more each notices, how many of its rows are redundant, and what these span."""
    outside = rows - rows @ basis.T @ basis
    values = np.linalg.svd(outside, compute_uv=False)
    new = values > DEFAULT.near
    own = np.any(rows, axis=2).sum(axis=1)
    return new.sum(axis=1), own - new.sum(axis=1), np.prod(np.where(new, values, 1.0), axis=1)


def _exchanged(problem: Problem, pool: Indices, chosen: list[int]) -> Indices:
    counts = np.any(problem.candidates.locating, axis=2).sum(axis=1)
    now = inexactness_of(problem, np.array(chosen))
    for _ in range(_MOST_ROUNDS):
        before = now
        for place in range(len(problem.locators), len(chosen)):
            rest = [*chosen[:place], *chosen[place + 1 :]]
            alike: Mask = counts[pool] == counts[chosen[place]]
            free = pool[alike & problem.joins(pool, [*problem.kept, *rest]) & ~np.isin(pool, rest)]
            if not len(free):
                continue
            there = problem.rows_of(tuple(rest))
            own = np.array([problem.rows_of((index,)) for index in free.tolist()])
            numbers = np.hstack([np.broadcast_to(there, (len(free), len(there))), own])
            worth = inexactness(problem, problem.rows[numbers], _levers(problem, numbers))
            if worth.min() < now * (1 - BETTER):
                now, chosen[place] = float(worth.min()), int(free[int(np.argmin(worth))])
        if now >= before * (1 - BETTER):
            break
    return np.array(chosen, dtype=np.int64)
