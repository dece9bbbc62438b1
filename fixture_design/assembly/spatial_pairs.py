"""Contact pairs of polyhedral bodies: apex on facet, facet on apex, edge across edge (3-3, 3-5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.assembly.edge_pairs import EdgePairs
from fixture_design.assembly.facet_pairs import FacetPairs
from fixture_design.assembly.pair_equations import PairEquations
from fixture_design.assembly.triples import components_first


@dataclass(frozen=True, eq=False)
class SpatialPairs:
    """All pairs: apices on facets, facets on apices, edges across edges, in this order.

    Attributes:
        names: the moving feature first.
    """

    names: tuple[str, ...]
    groups: tuple[FacetPairs, FacetPairs, EdgePairs]
    sizes: Indices

    def equations(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray, *, ends: bool = True) -> PairEquations:
        """Values and gradients of chosen pairs (n, m); without ``ends`` of the gaps only."""
        chosen = np.broadcast_to(chosen, (len(R), chosen.shape[1]))
        flat, row = chosen.ravel(), np.repeat(np.arange(len(R)), chosen.shape[1])
        R, position = components_first(R), components_first(position)
        count = 3 if ends else 1
        values, gradients = np.zeros((count, len(flat))), np.zeros((count, 6, len(flat)))
        for group, start, size in zip(self.groups, self._starts(), self.sizes.tolist(), strict=True):
            own = np.flatnonzero((flat >= start) & (flat < start + size))
            if own.size:
                rows = row[own]
                found = group.equations(R[..., rows], position[:, rows], flat[own] - start, ends=ends)
                values[: len(found[0]), own], gradients[: len(found[1]), :, own] = found
        return PairEquations(
            np.ascontiguousarray(values.T).reshape(*chosen.shape, count),
            np.ascontiguousarray(np.moveaxis(gradients, -1, 0)).reshape(*chosen.shape, count, 6),
        )

    def distances(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """H of every pair, shape (n, P) [m]."""
        return np.concatenate([group.distances(R, position) for group in self._some()], axis=1)

    def arms(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        """From the moving body's origin to the contact points of chosen pairs (n, m), fixed axes, (n, m, 3) [m]."""
        chosen = np.broadcast_to(chosen, (len(R), chosen.shape[1]))
        arms = np.zeros((*chosen.shape, 3))
        for group, start, size in zip(self.groups, self._starts(), self.sizes.tolist(), strict=True):
            inside = (chosen >= start) & (chosen < start + size)
            if inside.any():
                found = group.arms(R, position, np.clip(chosen - start, 0, size - 1))
                arms = np.where(inside[..., None], found, arms)
        return arms

    def beyond(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """How far apices are beyond rims and crossings beyond ends, not positive within, shape (n, P) [m]."""
        return np.concatenate([group.beyond(R, position) for group in self._some()], axis=1)

    def levers(self, position: np.ndarray) -> np.ndarray:
        """How fast turning changes each pair's distance, shape (n, P) [m]."""
        return np.concatenate([group.levers(position) for group in self._some()], axis=1)

    def _some(self) -> list[FacetPairs | EdgePairs]:
        return [group for group, size in zip(self.groups, self.sizes, strict=True) if size]

    def _starts(self) -> list[int]:
        return [0, int(self.sizes[0]), int(self.sizes[:2].sum())]
