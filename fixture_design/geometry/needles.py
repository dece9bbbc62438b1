"""Triangles without area taken out, so that the surface stays what it was."""

from __future__ import annotations

from collections import deque
from dataclasses import replace

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.geometry.piece import Piece, heights
from fixture_design.geometry.shapes import Triangles
from fixture_design.tolerances import ZERO_COORDINATE

#: Flips a needle before a mesh is given up [-]: one is enough, unless needles border on needles.
_FLIPS = 10


def without_needles(piece: Piece) -> Piece:
    """The closed piece without triangles of zero area: repeated corners dropped, needles flipped away.

    A needle has its three corners on a line; it closes the gap between one long edge and two short ones. Splitting the
    neighbour across the long edge at the needle's middle corner takes it out and leaves the surface as it was.

    Raises:
        GeometryError: needles that border only on each other, so that nothing is left to split.
    """
    repeated = (piece.triangles == np.roll(piece.triangles, 1, axis=1)).any(axis=1)
    piece, before = replace(piece, triangles=piece.triangles[~repeated]), piece
    needles = _needles(piece, piece.triangles)
    if not len(needles):
        count = int(repeated.sum())
        return replace(piece, notes=piece.note(_text(count))) if count else before
    flips = _Flips(piece)
    flips.run(needles)
    triangles = flips.triangles()
    if len(left := _needles(piece, triangles)):
        place = piece.vertices[triangles[left[0]]].mean(axis=0)
        raise piece.error(
            f"the mesh has {len(left)} triangles without area that cannot be taken out",
            found=f"one at {np.round(place, 6).tolist()} m",
            expected="triangles with an area; repair the mesh in the program that made it",
        )
    return replace(piece, triangles=triangles, notes=piece.note(_text(int(repeated.sum()) + flips.count)))


def _text(count: int) -> str:
    return f"{count} triangles without area taken out"


def _needles(piece: Piece, triangles: Triangles) -> Indices:
    return np.flatnonzero(heights(piece.vertices, triangles) <= ZERO_COORDINATE * piece.size)


class _Flips:
    """A mesh while its needles are flipped away one by one; lists and a dictionary, so that each flip is cheap."""

    def __init__(self, piece: Piece) -> None:
        self.piece = piece
        self.count = 0
        self.corners: list[list[int]] = piece.triangles.tolist()
        self.across: dict[tuple[int, int], list[int]] = {}
        for number in range(len(self.corners)):
            self._enter(number)

    def triangles(self) -> Triangles:
        """What is left."""
        return np.array([corners for corners in self.corners if corners], dtype=np.int64).reshape(-1, 3)

    def run(self, needles: Indices) -> None:
        """Take out these needles, and what becomes one; those are left to whose long edge nothing can be done."""
        waiting = deque(needles.tolist())
        stuck, budget = 0, _FLIPS * len(needles)
        while waiting and stuck <= len(waiting) and budget:
            number = waiting.popleft()
            if not self.corners[number] or not self._is_needle(self.corners[number]):
                continue
            changed = self._flip(number)
            if changed is None:
                waiting.append(number)
                stuck += 1
                continue
            stuck, budget = 0, budget - 1
            waiting.extend(other for other in changed if self._is_needle(self.corners[other]))

    def _flip(self, needle: int) -> list[int] | None:
        """Take out one needle: the triangles that changed, None if it has to wait for others."""
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
        if all(self._is_needle(part) for part in parts):
            return None
        self._replace(neighbour, parts[0])
        self._replace(needle, parts[1])
        self.count += 1
        return [neighbour, needle]

    def _is_needle(self, corners: list[int]) -> bool:
        return len(_needles(self.piece, np.array([corners], dtype=np.int64))) > 0

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
