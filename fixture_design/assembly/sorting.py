"""Which contact state a configuration is in: every pair's distance, and whether the parts overlap (3-7)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Bool

from fixture_design.arrays import Indices, Mask
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.tolerances import APART, SOLVED, TOUCHING

#: A contact state N_i: the names of the contacting pairs, sorted.
State = tuple[str, ...]

#: Configurations that are looked at together, so that the arrays stay in the processor's cache.
_TOGETHER = 2048


@dataclass(frozen=True, eq=False)
class Sorted:
    """Configurations with what touches in each.

    Attributes:
        q: shape (n, c).  touching: shape (n, P), all pairs, also those that take no part.
        distances: shape (n, P) [m].
        admissible: whether q is in the region and the parts do not overlap.
        clear: admissible, and every distance is one that certainly touches or certainly does not.
    """

    q: np.ndarray
    touching: Bool[np.ndarray, "n P"]
    distances: np.ndarray
    admissible: Mask
    clear: Mask

    def __getitem__(self, rows: np.ndarray) -> Sorted:
        return Sorted(self.q[rows], self.touching[rows], self.distances[rows], self.admissible[rows], self.clear[rows])

    def __len__(self) -> int:
        return len(self.q)


def sort_configurations(geometry: ContactGeometry, q: np.ndarray) -> Sorted:
    """Sorts configurations of shape (n, c) into states."""
    parts = [_sorted(geometry, q[k : k + _TOGETHER]) for k in range(0, max(len(q), 1), _TOGETHER)]
    return joined(parts)


def joined(parts: Sequence[Sorted]) -> Sorted:
    """One after the other."""
    return Sorted(
        *(np.concatenate([getattr(p, key) for p in parts])
          for key in ("q", "touching", "distances", "admissible", "clear"))
    )  # fmt: skip


def _sorted(geometry: ContactGeometry, q: np.ndarray) -> Sorted:
    distances = geometry.distances(q)
    touching = distances <= TOUCHING * geometry.size
    inside = geometry.inside(q)
    admissible = inside.copy()
    admissible[inside] = geometry.overlap(q[inside]) <= TOUCHING * geometry.size
    certain = (distances <= SOLVED * geometry.size) | (distances >= APART * geometry.size)
    clear = admissible & certain.all(axis=1)
    return Sorted(q, touching, distances, admissible, clear)


def state_of(geometry: ContactGeometry, touching: Mask) -> State:
    """The names of the pairs that touch and take part."""
    return names_of(geometry, touching[None])[0]


def names_of(geometry: ContactGeometry, touching: Bool[np.ndarray, "n P"]) -> list[State]:
    """As `state_of`, of each row."""
    order = np.argsort(geometry.names)
    names = np.array(geometry.names, dtype=object)[order]
    rows, places = np.nonzero((touching & geometry.takes_part)[:, order])
    ends = np.searchsorted(rows, np.arange(len(touching) + 1)).tolist()
    found = names[places].tolist()
    return [tuple(found[first:last]) for first, last in pairwise(ends)]


def states_of(geometry: ContactGeometry, touching: Bool[np.ndarray, "n P"]) -> list[State]:
    """As `state_of`, of each row; many rows are the same, and have the same one."""
    first, places = alike(touching)
    states = names_of(geometry, touching[first])
    return [states[place] for place in places.tolist()]


def alike(touching: Bool[np.ndarray, "n P"]) -> tuple[Indices, Indices]:
    """Where each different row is first, and for each row which of them it is."""
    packed = np.packbits(touching, axis=1)
    keys = packed.view(f"V{packed.shape[1]}").ravel() if packed.size else np.zeros(len(packed))
    _, first, places = np.unique(keys, return_index=True, return_inverse=True)
    return first, places.ravel()


def numbered(places: Indices) -> Indices:
    """Of each row, how many before it have the same number."""
    order = np.argsort(places, kind="stable")
    firsts = np.searchsorted(places[order], places[order])
    found = np.empty(len(places), dtype=int)
    found[order] = np.arange(len(order)) - firsts
    return found
