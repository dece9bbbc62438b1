"""Straight ways out: in which directions the part leaves all of its locators at once.

A direction t lets the part out of locators with outward normals n if n . t < 0 for each of them. Which normals a
direction may leave changes only where it crosses a plane n . t = 0, so that the directions fall into finitely many
*cells*, and every set of locators with a way out is within the normals of one cell. All cells touch a ray
n_i X n_j, and near a ray the same question is asked in the plane across it.

Locators that the part would only slide between (n . t = 0 on both sides, as in a slot) have no way out in this sense.
Where sliding is allowed, n . t <= 0, the sets of normals are largest on the rays themselves, which are all there is.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from fixture_design.arrays import Mask, Point, Points, cross_products
from fixture_design.tolerances import COPLANAR_ANGLE

#: With more normals than these, directions are tried and cells may be missed.
MOST_NORMALS = 32

#: Directions tried then.
_TRIED = 400


@dataclass(frozen=True, eq=False)
class Cell:
    """Directions in which the part leaves the same normals.

    Attributes:
        direction: one of them, of length 1, from the middle of the cell.
        leaves: which of the normals it leaves, shape (m,).
    """

    direction: Point
    leaves: Mask


def different(normals: Points) -> tuple[Points, np.ndarray]:
    """Unit normals without repetition, shape (m, p), and for each one given which of them it is."""
    exact, which_exact = np.unique(normals, axis=0, return_inverse=True)
    kept: list[Point] = []
    which = np.empty(len(exact), dtype=np.int64)
    for index, normal in enumerate(exact):
        near = [k for k, other in enumerate(kept) if np.abs(other - normal).max() <= COPLANAR_ANGLE]
        which[index] = near[0] if near else len(kept)
        if not near:
            kept.append(normal)
    return np.array(kept), which[which_exact.ravel()]


def cells(
    normals: Points, out: Point | None = None, seed: int = 0, *, sliding: bool = False
) -> tuple[list[Cell], bool]:
    """The cells of some different unit normals, most normals left first, and whether these are all.

    Args:
        normals: shape (m, p).
        out: the direction the part must be able to come out in: only cells that touch it are given, so that none of
            their normals is in its way (n . out <= 0).
        sliding: whether the part may slide along a normal's facet, n . t = 0.
    """
    allowed = np.ones(len(normals), dtype=bool) if out is None else normals @ out <= COPLANAR_ANGLE
    complete = normals.shape[1] == 2 or len(normals) <= MOST_NORMALS or out is not None
    if sliding:
        directions = [out / np.linalg.norm(out)] if out is not None else _rays(normals)
        found = list(_slides(normals, allowed, directions if complete else _tried(normals, seed)))
    else:
        patterns = {leaves.tobytes(): leaves for leaves in (allowed & p for p in _patterns(normals, out, seed))}
        found = [cell for leaves in patterns.values() if (cell := _cell(normals, leaves, allowed)) is not None]
    return sorted(_largest(found), key=lambda cell: -int(cell.leaves.sum())), complete


def _patterns(normals: Points, out: Point | None, seed: int) -> Iterator[Mask]:
    """Which normals are left, n . t < 0, in every cell there is, or that touches a direction; or at some directions."""
    if out is not None:
        yield from _near(out / np.linalg.norm(out), normals)
    elif normals.shape[1] == 2:
        yield from (normals @ direction < 0 for direction in _between(normals))
    elif len(normals) <= MOST_NORMALS:
        yield from _in_space(normals)
    else:
        yield from (normals @ direction < 0 for direction in _tried(normals, seed))


def _slides(normals: Points, allowed: Mask, directions: Iterable[Point]) -> Iterator[Cell]:
    """What the part leaves or slides along in some directions."""
    for direction in directions:
        yield Cell(direction, allowed & (normals @ direction <= COPLANAR_ANGLE))


def _cell(normals: Points, leaves: Mask, allowed: Mask) -> Cell | None:
    """The direction that leaves some normals most steeply, and all that it leaves; None if there is hardly any.

    max over |t| = 1 of min over i of -n_i . t  is  1 / |x| for the shortest x with n_i . x <= -1, and x / |x| is the
    direction: least distance programming (Lawson and Hanson, Solving least squares problems, 1974, chapter 23).
    """
    if not leaves.any():
        return None
    from scipy.optimize import nnls  # noqa: PLC0415 - slow to import

    some = -normals[leaves]
    target = np.append(np.zeros(some.shape[1]), 1.0)
    system = np.vstack([some.T, np.ones(len(some))])
    residual = system @ nnls(system, target)[0] - target
    if np.linalg.norm(residual) <= COPLANAR_ANGLE / 2:  # then |x| is 2 / COPLANAR_ANGLE or more
        return None
    direction = -residual[:-1] / residual[-1]
    direction /= np.linalg.norm(direction)
    left = allowed & (normals @ direction <= -COPLANAR_ANGLE)
    return Cell(direction, left) if left[leaves].all() else None


def _largest(found: list[Cell]) -> list[Cell]:
    """Those that no other one has all normals of, and more; of equal ones the first."""
    different_ones = list({cell.leaves.tobytes(): cell for cell in reversed(found) if cell.leaves.any()}.values())[::-1]
    if not different_ones:
        return []
    leaves = np.array([cell.leaves for cell in different_ones]).astype(np.float64)
    missed = leaves @ (1.0 - leaves).T  # for each pair how many normals of the first the second does not leave
    within = (missed == 0).sum(axis=1) > 1
    return [cell for cell, inside in zip(different_ones, within, strict=True) if not inside]


def _rays(normals: Points) -> Iterator[Point]:
    """Directions against one normal, and across one normal in the plane, or two in space, both ways."""
    yield from -normals
    if normals.shape[1] == 2:
        across = np.column_stack([-normals[:, 1], normals[:, 0]])
        yield from (*across, *-across)
        return
    for first in normals:  # in space all parallel: across them in any direction
        side = np.linalg.svd(first[None])[2][1]
        yield from (side, -side)
    for first, second in combinations(range(len(normals)), 2):
        ray = cross_products(normals[first], normals[second])
        length = np.linalg.norm(ray)
        if length > COPLANAR_ANGLE:
            yield from (ray / length, -ray / length)


def _between(normals: Points) -> Iterator[Point]:
    """One direction of the plane between any two neighbouring borders."""
    borders = np.arctan2(normals[:, 1], normals[:, 0]) + np.pi / 2
    borders = np.unique(np.round(np.mod(np.concatenate([borders, borders + np.pi]), 2 * np.pi), 9))
    following = np.append(borders[1:], borders[0] + 2 * np.pi)
    for angle in (borders + following) / 2:
        yield np.array([np.cos(angle), np.sin(angle)])


def _in_space(normals: Points) -> Iterator[Mask]:
    for normal in normals:
        yield normals @ normal > 0
    for first, second in combinations(range(len(normals)), 2):
        ray = cross_products(normals[first], normals[second])
        length = np.linalg.norm(ray)
        if length > COPLANAR_ANGLE:
            yield from _near(ray / length, normals)
            yield from _near(-ray / length, normals)


def _near(ray: Point, normals: Points) -> Iterator[Mask]:
    """Which normals are left in the cells that touch a ray: by signs, however near to it the next border is."""
    products = normals @ ray
    leaves = products < 0
    across = np.abs(products) <= COPLANAR_ANGLE
    if not across.any():
        yield leaves
        return
    for aside in _aside(ray, normals[across]):
        near = leaves.copy()
        near[across] = normals[across] @ aside < 0
        yield near


def _aside(ray: Point, across: Points) -> Iterator[Point]:
    """Directions at right angles to a ray, one in each cell of the normals that are at right angles to it too."""
    if len(ray) == 2:
        yield from (across[0], -across[0])
        return
    first = across[0]
    second = cross_products(ray, first)
    flat = np.column_stack([across @ first, across @ second])
    for x, y in _between(flat):
        yield x * first + y * second


def _tried(normals: Points, seed: int) -> Iterator[Point]:
    """Directions against one, two and three normals, and at random."""
    rng = np.random.default_rng(seed)
    yield from -normals
    for _ in range(_TRIED):
        weights = rng.random(min(3, len(normals)))
        direction = -weights @ normals[rng.integers(0, len(normals), len(weights))]
        yield from (
            d / np.linalg.norm(d) for d in (direction, rng.normal(size=3)) if np.linalg.norm(d) > COPLANAR_ANGLE
        )
