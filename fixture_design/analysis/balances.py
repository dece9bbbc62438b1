"""Forces and motions made exact: what a solver suggests to 1e-9, put right to rounding.

Forces x must be in their cones and add up; they move inside the cones, most where there is most room. A motion q must
get nothing back from cones with free heads: maps_i^T q in the cone itself, which is its own polar but for the sign.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Weights
from fixture_design.cones.force_cones import ForceCones
from fixture_design.tolerances import CARRIES, SUM_ROUNDING, WITNESS, ZERO_ROW

#: Steps of a correction; each squares the error.
_STEPS = 4
#: What counts as touching a cone's surface, coarse to fine [-].
_NEAR_SURFACE = (1e-5, 1e-7, 1e-9)


def repaired_forces(cones: ForceCones, wrench: Weights, x: Weights) -> tuple[Weights, float]:
    """x in the cones with  wrench + maps @ x = 0  as nearly as it can be, and what is left.

    Where nothing acts, nothing pushes. The step to the balance is the shortest in the metric of each cone's barrier, so
    that what has no room stays.

    Returns:
        x, and |wrench + maps @ x| relative to the largest of |wrench|, the largest force, and the unit.
    """
    acted_on = np.any(wrench) or np.nan_to_num(cones.heads).any()
    best, least = inside(cones, x if acted_on else np.zeros_like(x)), np.inf
    x = best
    for _ in range(_STEPS):
        left = wrench + cones.maps @ x
        size = max(1.0, float(np.linalg.norm(wrench)), float(np.abs(x).max(initial=0.0)))
        relative = float(np.linalg.norm(left)) / size
        if relative >= least:
            break
        best, least = x, relative
        if relative <= SUM_ROUNDING:
            break
        room = metric(cones, x)
        gram = cones.maps @ room @ cones.maps.T
        x = inside(cones, x - room @ cones.maps.T @ (np.linalg.pinv(gram, rcond=WITNESS, hermitian=True) @ left))
    return best, least


def inside(cones: ForceCones, x: Weights) -> Weights:
    """The same x, with heads as given and no z longer than its head."""
    x = x.copy()
    for block, head in zip(cones.blocks(), cones.heads, strict=True):
        start = block.start
        x[start] = max(float(x[start]), 0.0) if np.isnan(head) else head
        length = float(np.linalg.norm(x[start + 1 : block.stop]))
        if length > x[start]:
            x[start + 1 : block.stop] *= x[start] / length
    return x


def metric(cones: ForceCones, x: Weights) -> np.ndarray:
    """Block by block the inverse Hessian of the cones' barriers, shape (s, s): how far x may go which way, squared."""
    room = np.zeros((len(x), len(x)))
    for block, head in zip(cones.blocks(), cones.heads, strict=True):
        part = x[block]
        along, across = part[0], part[1:]
        gap = max(float(along**2 - across @ across), 0.0)
        if np.isnan(head):
            flip = -np.eye(len(part))
            flip[0, 0] = 1.0
            room[block, block] = np.outer(part, part) - 0.5 * gap * flip
        elif len(across) and gap > 0:
            inner = slice(block.start + 1, block.stop)
            shrink = np.outer(across, across) / (gap + 2 * across @ across)
            room[inner, inner] = gap / 2 * (np.eye(len(across)) - 2 * shrink)
    return room


def surplus(cones: ForceCones, motion: Weights, wrench: Weights) -> float:
    """wrench . q less what cones with given heads take back: positive for a q that proves that nothing balances."""
    products = cones.maps.T @ motion
    taken = 0.0
    for block, head in zip(cones.blocks(), cones.heads, strict=True):
        if not np.isnan(head):
            part = products[block]
            taken += head * (float(part[0]) - float(np.linalg.norm(part[1:])))
    return float(wrench @ motion) + taken


def resistance(cones: ForceCones, motion: Weights) -> float:
    """The most that a unit force of a cone with a free head resists; <= 0 for a motion that proves anything."""
    products = cones.maps.T @ motion
    worst = -np.inf
    for block, head in zip(cones.blocks(), cones.heads, strict=True):
        if np.isnan(head):
            worst = max(worst, float(np.linalg.norm(products[block][1:])) - float(products[block][0]))
    return worst


def repaired_motion(cones: ForceCones, motion: Weights, square: Weights | None = None) -> Weights | None:
    """A motion next to the one given that no cone with a free head resists, at length one; None if there is none.

    Cones that it nearly touches are made to touch it: with products on a cone's surface by Newton steps, with products
    of about zero by making them zero.

    Args:
        square: a load that the motion should not move along.
    """
    size = float(np.linalg.norm(motion))
    if size <= ZERO_ROW or not np.isfinite(size):
        return None
    for near in _NEAR_SURFACE:
        found = motion / size
        for _ in range(_STEPS):
            rows, misses = _touching(cones, found, near)
            if square is not None:
                rows, misses = np.vstack([rows, square]), np.append(misses, -(square @ found))
            if not np.abs(misses).max(initial=0.0) > np.finfo(np.float64).eps:
                break
            found = found + np.linalg.pinv(rows, rcond=WITNESS) @ misses
            length = float(np.linalg.norm(found))
            if length < 0.5:
                break
            found = found / length
        if np.linalg.norm(found) > CARRIES and resistance(cones, found) <= 0.1 * WITNESS:
            return found
    return None


def _touching(cones: ForceCones, motion: Weights, near: float) -> tuple[np.ndarray, Weights]:
    """Rows and what they miss, for the cones whose surface the products of a motion are near to, or outside of."""
    rows: list[np.ndarray] = [np.zeros((0, len(motion)))]
    misses: list[np.ndarray] = [np.zeros(0)]
    products = cones.maps.T @ motion
    for block, head in zip(cones.blocks(), cones.heads, strict=True):
        if not np.isnan(head):
            continue
        part, columns = products[block], cones.maps[:, block].T
        across = float(np.linalg.norm(part[1:]))
        if part[0] - across > near:
            continue
        if np.linalg.norm(part) <= near:
            rows.append(columns)
            misses.append(-part)
        elif across <= near:
            rows.append(columns[:1])
            misses.append(-part[:1])
        else:
            rows.append((columns[0] - part[1:] @ columns[1:] / across)[None])
            misses.append(np.array([across - part[0]]))
    return np.vstack(rows), np.concatenate(misses)
