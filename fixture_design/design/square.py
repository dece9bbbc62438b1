"""Square sets: three, two and one locator against faces, and clamps that push square onto each of these groups.

Where friction may keep the part off its locators, clamps must press each group of locators by themselves. With
N(k) = -D^-T d_k the forces of the locators under a push of a clamp k without friction, a clamp is worth

    least of N_i(k) over its group, times their number,  -  largest |N_j(k)| of the others

and 1 is the most there is: it pushes through the middle of the group, and leaves the others alone. Locators are drawn
far from each other by chance, and the sets of which the worst clamp is worth most are proposed. The weight alone must
rest on the locators; a clamp is left out where the others and the weight do.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, permutations

import numpy as np

from fixture_design.arrays import Indices, Point, Points, Rows, Vector, Weights
from fixture_design.design.clamping import closes
from fixture_design.design.problem import Problem
from fixture_design.design.regions import Region
from fixture_design.tolerances import COPLANAR_ANGLE

#: How many locators of a group there are, in the plane and in space.
_GROUPS = {3: (2, 1), 6: (3, 2, 1)}
#: Draws of locators for each choice of faces, and choices of faces.
_DRAWS, _MOST_FACES = 160, 24
#: Sets that are proposed in a region.
_MOST_SETS = 4
#: Clamps of a group that are tried where the best is in the way of others.
_MOST_CLAMPS = 6


def square_sets(problem: Problem, region: Region, rng: np.random.Generator) -> Iterator[tuple[Indices, Indices]]:
    """Locators of a region and clamps against each group of them, the best sets first, and with fewer clamps.

    None where elements of a start stay, or touch in more than one point.
    """
    if len(problem.kept) or len(problem.spare) or problem.each > 1:
        return
    pool = problem.passing(region.pool, region.out)
    drawn = []
    for groups in _faces(problem, pool, rng):
        best = max((_valued(problem, groups, rng) for _ in range(_DRAWS)), key=lambda one: one[0])
        if best[0] > 0:
            drawn.append(best)
    for _, locators, clamps in sorted(drawn, key=lambda one: -one[0])[:_MOST_SETS]:
        for count in range(len(clamps), 0, -1):
            for some in combinations(clamps.tolist(), count):
                if problem.closes is None or closes(problem.closing_rows, np.append(locators, some).astype(np.int64)):
                    yield locators, np.array(some, dtype=np.int64)


def _faces(problem: Problem, pool: Indices, rng: np.random.Generator) -> list[list[Indices]]:
    """Choices of as many directions as there are groups, each with its candidates, those that carry the weight first.

    Shape of a choice: one array of candidates a group.
    """
    groups = _alike(problem.candidates.normals[pool, 0], pool)
    sizes = _GROUPS[problem.candidates.dimension]
    normals = [problem.candidates.normals[group[0], 0] for group in groups]
    down = None if problem.duties is None else problem.duties.weight[: problem.candidates.normals.shape[2]]
    found = []
    for some in permutations(range(len(groups)), len(sizes)):
        enough = all(len(groups[face]) >= size for face, size in zip(some, sizes, strict=True))
        volume = abs(float(np.linalg.det(np.array([normals[face] for face in some]))))
        if enough and volume > COPLANAR_ANGLE:
            carries = 0.0 if down is None else float(down @ normals[some[0]])
            found.append((-carries, -volume, rng.random(), some))
    return [[groups[face] for face in some] for *_, some in sorted(found)[:_MOST_FACES]]


def _alike(normals: Points, pool: Indices) -> list[Indices]:
    """Candidates by their normals, the largest groups first."""
    left, groups = np.arange(len(pool)), []
    while len(left):
        same = normals[left] @ normals[left[0]] > np.cos(COPLANAR_ANGLE)
        groups.append(pool[left[same]])
        left = left[~same]
    return sorted(groups, key=len, reverse=True)


def _valued(problem: Problem, groups: list[Indices], rng: np.random.Generator) -> tuple[float, Indices, Indices]:
    """Locators drawn from each group, with the best clamps against each: what the worst is worth; -1 without any."""
    sizes = _GROUPS[problem.candidates.dimension]
    chosen = [_drawn(problem, group, size, rng) for group, size in zip(groups, sizes, strict=True)]
    locators = np.concatenate(chosen)
    assert problem.pushing is not None
    rows = problem.pushing.smooth[locators, 0]
    none = (-1.0, locators, locators[:0])
    if abs(np.linalg.det(rows)) < problem.candidates.tolerances.near or not problem.together(locators):
        return none
    inverse = np.linalg.inv(rows.T)
    if not _rests(problem, inverse):
        return none
    ends = np.cumsum([0, *sizes])
    forces = -problem.pushing.smooth[problem.clampable, 0] @ inverse.T
    worth, clamps = np.inf, locators[:0]
    for place in np.argsort(sizes).tolist():
        values = _worth(forces, int(ends[place]), int(ends[place + 1]))
        for best in np.argsort(-values)[:_MOST_CLAMPS].tolist():
            clamp = problem.clampable[[best]]
            if problem.joins(clamp, np.concatenate([locators, clamps]))[0]:
                worth, clamps = min(worth, float(values[best])), np.append(clamps, clamp)
                break
        else:
            return none
    return worth, locators, clamps


def _worth(forces: Rows, start: int, end: int) -> Weights:
    """Of each clamp against the locators from ``start`` to ``end``."""
    others = np.delete(forces, slice(start, end), axis=1)
    return (end - start) * forces[:, start:end].min(axis=1) - np.abs(others).max(axis=1, initial=0.0)


def _rests(problem: Problem, inverse: Rows) -> bool:
    """Whether the weight alone is carried without friction."""
    if problem.duties is None:
        return True
    weight: Vector = problem.duties.weight
    near = problem.candidates.tolerances.near
    return bool((inverse @ weight >= -near * np.abs(weight).max()).all())


def _drawn(problem: Problem, group: Indices, size: int, rng: np.random.Generator) -> Indices:
    """Some of a group of candidates, far from each other: the outermost of a part of them, in evenly turned ways."""
    some = rng.permutation(group)[: max(size, int(rng.integers(size, len(group) + 1)))]
    if size == 1:
        return some[:1]
    across = _across(problem.candidates.normals[group[0], 0], rng)
    points = problem.candidates.points[some, 0]
    turns = 2 * np.pi * (np.arange(size) / size) if len(across) > 1 else np.pi * np.arange(size)
    chosen: list[int] = []
    for turn in turns.tolist():
        way: Point = np.cos(turn) * across[0] + (np.sin(turn) * across[1] if len(across) > 1 else 0.0)
        order = np.argsort(-(points @ way))
        chosen.append(next(int(k) for k in order.tolist() if k not in chosen))
    return some[chosen]


def _across(normal: Point, rng: np.random.Generator) -> Points:
    """Orthonormal directions along a face, turned by chance."""
    across = np.linalg.svd(normal[None])[2][1:]
    turn = rng.uniform(0, 2 * np.pi)
    if len(across) == 1:
        return across
    return np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]) @ across
