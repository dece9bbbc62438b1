"""Flat triangles flipped away: each one and its neighbour across its long side share the place out anew."""

from __future__ import annotations

from collections import deque

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.geometry.piece import Piece, heights
from fixture_design.geometry.shapes import PerVertex, TriangleMask, Triangles

#: Flips a flat triangle before a mesh is given up [-]: one is enough, unless they border on each other.
_FLIPS = 10


def flat_ones(piece: Piece, triangles: Triangles, flat: PerVertex) -> TriangleMask:
    """Which triangles are no higher than ``flat`` of one of their vertices [m]."""
    return heights(piece.vertices, triangles) <= flat[triangles].max(axis=1)


class Flips:
    """A mesh while flat triangles are flipped away one by one; lists and a dictionary, so that each flip is cheap.

    Attributes:
        count: how many are gone.  highest: height of the highest one that was flipped [m].
    """

    def __init__(self, piece: Piece, flat: PerVertex) -> None:
        """A triangle counts as flat if its height is at most ``flat`` of one of its vertices [m]."""
        self.piece, self.flat = piece, flat
        self.count, self.highest = 0, 0.0
        self.corners: list[list[int]] = piece.triangles.tolist()
        self.across: dict[tuple[int, int], list[int]] = {}
        for number in range(len(self.corners)):
            self._enter(number)

    def triangles(self) -> Triangles:
        """What is left."""
        return np.array([corners for corners in self.corners if corners], dtype=np.int64).reshape(-1, 3)

    def run(self, numbers: Indices) -> None:
        """Take out these flat triangles, and what becomes one; those whose long edge has no use stay."""
        waiting = deque(numbers.tolist())
        stuck, budget = 0, _FLIPS * len(numbers)
        while waiting and stuck <= len(waiting) and budget:
            number = waiting.popleft()
            if not self.corners[number] or not self._is_flat(self.corners[number]):
                continue
            changed = self._flip(number)
            if changed is None:
                waiting.append(number)
                stuck += 1
                continue
            stuck, budget = 0, budget - 1
            waiting.extend(other for other in changed if self._is_flat(self.corners[other]))

    def _flip(self, needle: int) -> list[int] | None:
        """Take out one of them: the triangles that changed, None if it has to wait for others."""
        corners = self.corners[needle]
        points = self.piece.vertices[corners]
        # the longest side is from corner `start` to the next one; the third lies between them
        start = int(np.argmax(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)))
        first, second, middle = (corners[(start + step) % 3] for step in range(3))
        neighbours = self.across.get((second, first), [])
        if len(neighbours) != 1:
            return None
        neighbour = neighbours[0]
        apex = next(corner for corner in self.corners[neighbour] if corner not in (first, second))
        if apex == middle:
            # back to back
            self._replace(needle, [])
            self._replace(neighbour, [])
            self.count += 2
            return []
        # the neighbour is (second, first, apex); its edge second -> first becomes second -> middle -> first
        parts = [second, middle, apex], [middle, first, apex]
        if all(self._is_flat(part) for part in parts) and not self._is_longest(first, second, apex):
            return None
        self.highest = max(self.highest, float(heights(points, np.array([[0, 1, 2]]))[0]))
        self._replace(neighbour, parts[0])
        self._replace(needle, parts[1])
        self.count += 1
        return [neighbour, needle]

    def _is_longest(self, first: int, second: int, apex: int) -> bool:
        """Whether a neighbour's long side is the same one: two flat triangles then share it out to shorter ones."""
        start, end, other = self.piece.vertices[[first, second, apex]]
        return bool(max(np.linalg.norm(other - start), np.linalg.norm(other - end)) < np.linalg.norm(end - start))

    def _is_flat(self, corners: list[int]) -> bool:
        return bool(flat_ones(self.piece, np.array([corners], dtype=np.int64), self.flat)[0])

    def _replace(self, number: int, corners: list[int]) -> None:
        for edge in _sides(self.corners[number]):
            self.across[edge].remove(number)
        self.corners[number] = corners
        self._enter(number)

    def _enter(self, number: int) -> None:
        for edge in _sides(self.corners[number]):
            self.across.setdefault(edge, []).append(number)


def _sides(corners: list[int]) -> list[tuple[int, int]]:
    return [(corners[k], corners[(k + 1) % 3]) for k in range(len(corners))]
