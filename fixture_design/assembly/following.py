"""Following motions a little way in the real geometry: which states they lead to, and whether they exist.

The first order proposes a motion and the contacts that it keeps; a short way along it, with these contacts held by
their equations, the geometry tells which state that is. A motion counts only if it comes out the same at several
lengths, down to a thousandth of the way to the next contact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, Mask
from fixture_design.assembly.contact_geometry import ContactGeometry, weights
from fixture_design.assembly.least_squares import solved
from fixture_design.assembly.sorting import Sorted, joined, sort_configurations
from fixture_design.tolerances import SOLVED

#: Lengths of a motion, relative to the longest, the shortest first. The first few that tell what touches must agree,
#: the third of all among them: after it there are too few.
_SHARES = (0.003, 0.03, 0.1, 0.3, 1.0)
_MUST_AGREE = 3

#: The longest motion: this share of the way to the next contact, and no more than this share of the radius [-].
_OF_THE_WAY, _OF_THE_RADIUS = 0.3, 0.05

#: Holding contacts may change a motion by this many times its length: more is another place.
_ASIDE = 1.0


@dataclass(frozen=True, eq=False)
class Followed:
    """Motions that exist.

    Attributes:
        rows: which of the motions given, shape (k,).
        ends: where each leads to: the farthest configuration that still has the state.
    """

    rows: Indices
    ends: Sorted


def follow(geometry: ContactGeometry, q: np.ndarray, displacements: np.ndarray, kept: np.ndarray) -> Followed:
    """Follows motions from admissible configurations.

    Args:
        q: shape (n, c).  displacements: shape (n, d), angles times the radius, unit length.
        kept: shape (n, m), the pairs that stay, each at least once; -1 stands for none.

    Returns:
        the motions that lead to one and the same state at the shortest lengths, as far as they do.
    """
    if not len(q):
        return Followed(np.zeros(0, dtype=int), sort_configurations(geometry, q))
    longest = _longest(geometry, q, displacements)
    # at the last length that must agree nearly all fail that do: they need not be looked at any further
    decisive = _moved(geometry, q, displacements, kept, _SHARES[_MUST_AGREE - 1] * longest)
    lasting = np.flatnonzero(decisive.clear)
    followed = _followed(
        geometry, q[lasting], displacements[lasting], kept[lasting], longest[lasting], decisive[lasting]
    )
    return Followed(lasting[followed.rows], followed.ends)


def _followed(
    geometry: ContactGeometry,
    q: np.ndarray,
    displacements: np.ndarray,
    kept: np.ndarray,
    longest: np.ndarray,
    decisive: Sorted,
) -> Followed:
    ways = [
        decisive if k == _MUST_AGREE - 1 else _moved(geometry, q, displacements, kept, share * longest)
        for k, share in enumerate(_SHARES)
    ]
    # the shortest lengths may be too short to tell what touches; what they say is not wrong, but nothing
    silent = np.logical_and.accumulate([way.admissible & ~way.clear for way in ways])
    first = silent.sum(axis=0)
    agreeing, last = np.zeros(len(q), dtype=int), np.zeros(len(q), dtype=int)
    going = np.ones(len(q), dtype=bool)
    patterns = np.array([way.touching for way in ways])
    for k, way in enumerate(ways):
        begins = np.minimum(first, len(ways) - 1)
        same = way.clear & (way.touching == patterns[begins, np.arange(len(q))]).all(axis=1)
        going &= same | (k < first)
        agreeing += going & same
        last[going & same] = k
    rows = np.flatnonzero(agreeing >= _MUST_AGREE)
    return Followed(rows, joined(ways)[last[rows] * len(q) + rows])


def _longest(geometry: ContactGeometry, q: np.ndarray, displacements: np.ndarray) -> np.ndarray:
    """How far the motions may go without meeting what is not in contact now, shape (n,), as lengths [m]."""
    here = sort_configurations(geometry, q)
    u = displacements / weights(geometry)
    slow = time_to_contact(geometry, q, u, here)
    return np.minimum(_OF_THE_WAY * slow, _OF_THE_RADIUS * geometry.radius)


def time_to_contact(geometry: ContactGeometry, q: np.ndarray, u: np.ndarray, here: Sorted) -> np.ndarray:
    """How long motions of velocity u certainly meet nothing that they do not touch now, shape (n,).

    A pair's distance changes by at most |dx| + lever |dtheta|.
    """
    turns = geometry.turns
    speed = np.linalg.norm(np.delete(u, turns, axis=1), axis=1)[:, None]
    speed = speed + geometry.reach(q) * np.linalg.norm(u[:, turns], axis=1)[:, None]
    times = here.distances / np.maximum(speed, np.finfo(float).tiny)
    return np.where(here.touching, np.inf, times).min(axis=1)


def _moved(
    geometry: ContactGeometry, q: np.ndarray, displacements: np.ndarray, kept: np.ndarray, lengths: np.ndarray
) -> Sorted:
    """Configurations some way along, contacts held; those that cannot be held are not clear."""
    aim = geometry.moved(q, displacements / weights(geometry) * lengths[:, None])
    end, arrived = held(geometry, aim, kept)
    aside = np.linalg.norm(geometry.between(aim, end) * weights(geometry), axis=1)
    found = sort_configurations(geometry, end)
    good = arrived & (aside <= _ASIDE * lengths)
    return Sorted(found.q, found.touching, found.distances, found.admissible & good, found.clear & good)


def held(geometry: ContactGeometry, q: np.ndarray, kept: np.ndarray) -> tuple[np.ndarray, Mask]:
    """Configurations near q where the pairs in ``kept`` (n, m; -1 for none) touch, and whether they do."""
    end, arrived = q.copy(), np.ones(len(q), dtype=bool)
    some = (kept >= 0).any(axis=1)
    if some.any():
        # a repeated pair changes nothing, so that it can fill the rows
        filled = np.where(kept[some] >= 0, kept[some], kept[some].max(axis=1, keepdims=True))
        end[some], left = solved(geometry, q[some], filled, ends=False)
        arrived[some] = left <= SOLVED * geometry.size
    return end, arrived
