"""Following motions a little way in the real geometry: which states they lead to, and whether they exist.

The first order proposes a motion and the contacts that it keeps; a short way along it, with these contacts held by
their equations, the geometry tells which state that is. A motion counts only if it comes out the same at several
lengths, down to a thousandth of the way to the next contact.
"""

from __future__ import annotations

from collections.abc import Iterator
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
class Proposed:
    """Motions of which one length tells a state, each from an admissible configuration.

    Attributes:
        start: where from.  displacements: shape (n, d), angles times the radius, unit length.
        kept: shape (n, m), the pairs that stay, each at least once; -1 stands for none.
        longest: how far they may go, shape (n,) [m].
        decisive: where they are at the last length that must agree: the state that they lead to, if they exist.
    """

    start: Sorted
    displacements: np.ndarray
    kept: np.ndarray
    longest: np.ndarray
    decisive: Sorted

    def __getitem__(self, rows: np.ndarray) -> Proposed:
        return Proposed(
            self.start[rows], self.displacements[rows], self.kept[rows], self.longest[rows], self.decisive[rows]
        )

    def __len__(self) -> int:
        return len(self.start)


@dataclass(frozen=True, eq=False)
class Followed:
    """Motions that exist.

    Attributes:
        rows: which of the motions given, shape (k,).
        ends: where each leads to: the farthest configuration that still has the state.
    """

    rows: Indices
    ends: Sorted


def propose(
    geometry: ContactGeometry, start: Sorted, displacements: np.ndarray, kept: np.ndarray
) -> tuple[Proposed, Sorted]:
    """The motions that tell a state at the last length that must agree; arguments as in `Proposed`.

    Nearly all that fail do so there: they need not be looked at any further. Where others are that do not say clearly
    what touches, but may tell of a state, comes second.
    """
    longest = _longest(geometry, start, displacements)
    decisive = _moved(geometry, start.q, displacements, kept, _SHARES[_MUST_AGREE - 1] * longest)
    proposed = Proposed(start, displacements, kept, longest, decisive)
    return proposed[np.flatnonzero(decisive.clear)], decisive[decisive.admissible & ~decisive.clear]


def follow(geometry: ContactGeometry, proposed: Proposed) -> Followed:
    """The motions that lead to one and the same state at the shortest lengths, as far as they do."""
    start, displacements, kept = proposed.start, proposed.displacements, proposed.kept
    if not len(start):
        return Followed(np.zeros(0, dtype=int), start)
    ways = [
        proposed.decisive
        if k == _MUST_AGREE - 1
        else _moved(geometry, start.q, displacements, kept, share * proposed.longest)
        for k, share in enumerate(_SHARES)
    ]
    # the shortest lengths may be too short to tell what touches; what they say is not wrong, but nothing
    silent = np.logical_and.accumulate([way.admissible & ~way.clear for way in ways])
    first = silent.sum(axis=0)
    agreeing, last = np.zeros(len(start), dtype=int), np.zeros(len(start), dtype=int)
    going = np.ones(len(start), dtype=bool)
    patterns = np.array([way.touching for way in ways])
    for k, way in enumerate(ways):
        begins = np.minimum(first, len(ways) - 1)
        same = way.clear & (way.touching == patterns[begins, np.arange(len(start))]).all(axis=1)
        going &= same | (k < first)
        agreeing += going & same
        last[going & same] = k
    rows = np.flatnonzero(agreeing >= _MUST_AGREE)
    return Followed(rows, joined(ways)[last[rows] * len(start) + rows])


def _longest(geometry: ContactGeometry, start: Sorted, displacements: np.ndarray) -> np.ndarray:
    """How far the motions may go without meeting what is not in contact now, shape (n,), as lengths [m]."""
    slow = time_to_contact(geometry, start.q, displacements / weights(geometry), start)
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
    for rows, chosen in filled(kept):
        end[rows], left = solved(geometry, q[rows], chosen, ends=False)
        arrived[rows] = left <= SOLVED * geometry.size
    return end, arrived


def filled(kept: np.ndarray) -> Iterator[tuple[Indices, np.ndarray]]:
    """Rows of pairs (n, m; -1 for none) without gaps: a repeated pair changes nothing, so that it can fill them.

    Rows of about as many pairs come together, so that few are repeated; those without any do not come.
    """
    counts = (kept >= 0).sum(axis=1)
    kept = np.take_along_axis(kept, np.argsort(kept < 0, axis=1, kind="stable"), axis=1)
    classes = np.ceil(np.log2(np.maximum(counts, 1))).astype(int)
    if len(kept) <= _FEW:
        classes[:] = classes.max(initial=0)
    for number in np.unique(classes[counts > 0]).tolist():
        rows = np.flatnonzero((classes == number) & (counts > 0))
        own = kept[rows, : counts[rows].max()]
        yield rows, np.where(own >= 0, own, own[:, :1])


#: So few rows are not worth being told apart.
_FEW = 200
