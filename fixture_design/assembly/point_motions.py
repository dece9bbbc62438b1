"""The motions of one contact point at ends of facets that both bodies' tangent cones there admit.

All pairs that touch in one point have face vectors d = [n; arm X n], so that d . dq = n . v, with v the motion of that
point. The planes n . v = 0 cut its motions into faces (cells, their borders, rays), each with one sign for each pair.
Those in which the tangent cones clearly overlap lead to no state, and the largest of the others are enough: together
they are the union of cones (2-9) of that point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, Mask, Point, Points
from fixture_design.assembly.spatial import SpatialGeometry
from fixture_design.assembly.spatial_contacts import tangent_clauses
from fixture_design.contacts.contact import Clause
from fixture_design.tolerances import DEPENDENT, TOUCHING


@dataclass(frozen=True, eq=False)
class PointMotions:
    """The faces of the motions of a point that are admissible and no part of others.

    Attributes:
        pairs: that touch there, shape (m,), as places among those given.
        signs: of n . v for each face and pair, shape (k, m): -1, 0 or 1.
        normals: unit, shape (m, 3).
    """

    pairs: Indices
    signs: np.ndarray
    normals: Points

    def may_keep(self, kept: Mask) -> bool:
        """Whether some of the pairs may stay without the others.

        What keeps two different normals still on a line, or at rest, keeps all other pairs along it: an apex on two
        facets stays on their common edge, and so do its own edges. Normals along each other turn apart, any of them.
        """
        if not kept.any() or kept.all():
            return True
        _, values, right = np.linalg.svd(self.normals[kept], full_matrices=False)
        spanned = right[values > DEPENDENT]
        others = self.normals[~kept]
        within = np.linalg.norm(others - others @ spanned.T @ spanned, axis=1) <= DEPENDENT
        return len(spanned) < 2 or not within.any()


def point_motions(geometry: SpatialGeometry, q: np.ndarray, pairs: Indices, normals: Points) -> list[PointMotions]:
    """For each point of a configuration in which some pairs touch.

    Args:
        q: shape (c,).  pairs: those at ends of facets, shape (m,).  normals: n of each, shape (m, 3).
    """
    near = TOUCHING * geometry.size
    arms = geometry.arms(q[None], pairs[None])[0]
    left, found = np.arange(len(pairs)), []
    while left.size:
        here = np.linalg.norm(arms[left] - arms[left[0]], axis=1) <= _ONE_POINT * near
        own, left = left[here], left[~here]
        clauses = tangent_clauses(geometry, q[None], arms[own[0]], near)
        units = normals[own] / np.linalg.norm(normals[own], axis=1, keepdims=True)
        signs, witnesses = _faces(units)
        if clauses is not None:
            kept = _admitted(witnesses, clauses)
            signs = signs[kept]
        found.append(PointMotions(own, _largest(signs), units))
    return found


#: Contact points this many times `TOUCHING` from each other are one [-]: more apart, each is seen alone, which is right
#: too but takes longer.
_ONE_POINT = 100.0


def _admitted(motions: np.ndarray, clauses: tuple[Clause, ...]) -> np.ndarray:
    """Which motions do not clearly enter the other body: of each clause one normal does not point along them."""
    allowed = np.ones(len(motions), dtype=bool)
    for clause in clauses:
        normals = np.array([normal / np.linalg.norm(normal) for normal in clause])
        allowed &= ((motions @ normals.T) <= DEPENDENT).any(axis=1)
    return allowed


def _largest(signs: np.ndarray) -> np.ndarray:
    """Faces that are not on the border of another."""
    part = ((signs[:, None] == signs[None]) | (signs[:, None] == 0)).all(axis=2)
    np.fill_diagonal(part, False)
    return signs[~part.any(axis=1)]


def _faces(normals: Points) -> tuple[np.ndarray, Points]:
    """All faces of the planes n . v = 0: the signs of n . v, shape (k, m), and a motion v of each, shape (k, 3).

    Every face but the origin has a ray of the arrangement on its border, or is one: they are found around each ray.
    """
    spanning = _completed(normals)
    rays = _rays(spanning)
    motions: list[np.ndarray] = [np.zeros(3)]
    for ray in rays:
        heights = spanning @ ray
        through = np.abs(heights) <= DEPENDENT
        along = np.cross(spanning[through], ray)
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        along = np.vstack([along, -along])
        first, second = along[0], np.cross(ray, along[0])
        angles = np.sort(np.arctan2(along @ second, along @ first))
        middles = (angles + np.append(angles[1:], angles[0] + 2 * np.pi)) / 2
        short = _ASIDE * float(np.abs(heights[~through]).min(initial=1.0))
        around = [np.cos(a) * first + np.sin(a) * second for a in (*angles, *middles)]
        motions += [ray, *(ray + short * away for away in around)]
    table = np.array(motions)
    table[1:] /= np.linalg.norm(table[1:], axis=1, keepdims=True)
    values = table @ normals.T
    signs = np.where(np.abs(values) <= _ASIDE * DEPENDENT, 0, np.sign(values)).astype(int)
    _, kept = np.unique(signs, axis=0, return_index=True)
    return signs[np.sort(kept)], table[np.sort(kept)]


#: How far beside a ray the faces around it are looked at, relative to the nearest other plane [-].
_ASIDE = 0.3


def _completed(normals: Points) -> Points:
    """The normals, each line once, and others that make them span space: more planes cut no face wrongly."""
    lines: list[np.ndarray] = []
    for normal in normals:
        if all(np.linalg.norm(np.cross(normal, line)) > DEPENDENT for line in lines):
            lines.append(normal)
    _, values, right = np.linalg.svd(np.array(lines))
    rank = int(np.count_nonzero(values > DEPENDENT))
    return np.vstack([lines, right[rank:]])


def _rays(normals: Points) -> Points:
    """Where two planes meet, both ways, each once."""
    first, second = np.triu_indices(len(normals), 1)
    crossed = np.cross(normals[first], normals[second])
    crossed /= np.linalg.norm(crossed, axis=1, keepdims=True)
    kept: list[Point] = []
    for ray in (*crossed, *-crossed):
        if all(np.linalg.norm(ray - other) > DEPENDENT for other in kept):
            kept.append(ray)
    return np.array(kept)
