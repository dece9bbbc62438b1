"""Straight ways out: in which directions the part leaves all of its locators at once.

A direction t lets the part out of locators with outward normals n if n . t < 0 for each of them. Which normals a
direction may leave changes only where it crosses a plane n . t = 0, so that the directions fall into finitely many
*cells*, and every set of locators with a way out is within the normals of one cell. All cells touch a ray
n_i X n_j, and near a ray the same question is asked in the plane across it.

Locators that the part would only slide between (n . t = 0 on both sides, as in a slot) have no way out in this sense.
Where sliding is allowed, n . t <= 0, the sets of normals are largest on the rays themselves, which are all there is.
"""

from __future__ import annotations

from collections.abc import Iterator
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
    most = COPLANAR_ANGLE if sliding else -COPLANAR_ANGLE
    if sliding and out is not None:
        found, complete = [out / np.linalg.norm(out)], True
    elif sliding and (normals.shape[1] == 2 or len(normals) <= MOST_NORMALS):
        found, complete = _rays(normals), True
    elif out is not None:
        found, complete = _near(out / np.linalg.norm(out), normals), True
    elif normals.shape[1] == 2:
        found, complete = _in_the_plane(normals), True
    elif len(normals) <= MOST_NORMALS:
        found, complete = _in_space(normals), True
    else:
        found, complete = _tried(normals, seed), False
    best: dict[bytes, Cell] = {}
    for direction in found:
        leaves = normals @ direction <= most
        if out is not None:
            leaves &= normals @ out <= COPLANAR_ANGLE
        key = leaves.tobytes()
        if leaves.any() and (key not in best or _depth(normals, direction) > _depth(normals, best[key].direction)):
            best[key] = Cell(direction, leaves)
    return sorted(_largest(list(best.values())), key=lambda cell: -int(cell.leaves.sum())), complete


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


def _depth(normals: Points, direction: Point) -> float:
    """How far a direction is from the borders of its cell."""
    return float(np.abs(normals @ direction).min())


def _largest(found: list[Cell]) -> list[Cell]:
    """Those that no other one has all normals of, and more; all of them leave different normals."""
    if not found:
        return []
    leaves = np.array([cell.leaves for cell in found]).astype(np.float64)
    missed = leaves @ (1.0 - leaves).T  # for each pair how many normals of the first the second does not leave
    within = (missed == 0).sum(axis=1) > 1
    return [cell for cell, inside in zip(found, within, strict=True) if not inside]


def _in_the_plane(normals: Points) -> Iterator[Point]:
    """One direction between any two neighbouring borders."""
    borders = np.arctan2(normals[:, 1], normals[:, 0]) + np.pi / 2
    borders = np.unique(np.round(np.mod(np.concatenate([borders, borders + np.pi]), 2 * np.pi), 9))
    following = np.append(borders[1:], borders[0] + 2 * np.pi)
    for angle in (borders + following) / 2:
        yield np.array([np.cos(angle), np.sin(angle)])


def _in_space(normals: Points) -> Iterator[Point]:
    yield from -normals
    for first, second in combinations(range(len(normals)), 2):
        ray = cross_products(normals[first], normals[second])
        length = np.linalg.norm(ray)
        if length > COPLANAR_ANGLE:
            yield from _near(ray / length, normals)
            yield from _near(-ray / length, normals)


def _near(ray: Point, normals: Points) -> Iterator[Point]:
    """Directions in all cells that touch a ray."""
    products = normals @ ray
    across = normals[np.abs(products) <= COPLANAR_ANGLE]
    if not len(across):
        yield ray
        return
    others = np.abs(products[np.abs(products) > COPLANAR_ANGLE])
    step = float(others.min(initial=1.0)) / 2
    for aside in _aside(ray, across):
        moved = ray + step * aside
        yield moved / np.linalg.norm(moved)


def _aside(ray: Point, across: Points) -> Iterator[Point]:
    """Directions at right angles to a ray, one in each cell of the normals that are at right angles to it too."""
    if len(ray) == 2:
        yield from (across[0], -across[0])
        return
    first = across[0]
    second = cross_products(ray, first)
    flat = np.column_stack([across @ first, across @ second])
    for x, y in _in_the_plane(flat):
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
