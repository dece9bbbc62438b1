"""Contact states and transitions of two polygons by another route: slices at fixed angles, solved one by one.

At a fixed angle every contact pair is a line in (x, y): states with up to two contacts are points between and at the
intersections of these lines. Angles are those of a grid, those where two edges are parallel, and those where three
lines meet, found by sign changes of a determinant. Overlap is judged by shapely.
"""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import shapely
from scipy.optimize import brentq
from shapely.geometry import Polygon

State = frozenset[str]


class DenseSearch:
    """Two polygons (or a polygon and several), all features named as the package names them."""

    def __init__(self, moving: np.ndarray, fixed: list[np.ndarray], reach: float) -> None:
        self.moving, self.fixed, self.reach = moving, fixed, reach
        self.names: list[str] = []
        self.pairs: list[tuple[bool, np.ndarray, np.ndarray, np.ndarray]] = []
        bodies, offset = [moving, *fixed], 0
        features = []
        for polygon in bodies:
            after = np.roll(polygon, -1, axis=0) - polygon
            before = polygon - np.roll(polygon, 1, axis=0)
            convex = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] > 1e-12
            features += [(k + offset + 1, polygon[k], polygon[(k + 1) % len(polygon)], convex[k], polygon is moving)
                         for k in range(len(polygon))]  # fmt: skip
            offset += len(polygon)
        for number, point, _, convex, mine in features:
            for other, start, end, _, theirs in features:
                if convex and mine != theirs:
                    self.pairs.append((mine, point, start, end))
                    name = [f"apex {number}", f"facet {other}"]
                    self.names.append(" - ".join(name if mine else name[::-1]))

    def lines(self, theta: float) -> np.ndarray:
        """n . (x, y) = c of every pair at this angle, shape (P, 3)."""
        R = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
        rows = []
        for mine, point, start, end in self.pairs:
            along = end - start if mine else R @ (end - start)
            normal = np.array([along[1], -along[0]]) / np.linalg.norm(along)
            # the apex on the line: n . (R point + x - start) = 0, or n . (point - x - R start) = 0
            c = normal @ (start - R @ point) if mine else normal @ (point - R @ start)
            rows.append([*normal, c])
        return np.array(rows)

    def state(self, q: np.ndarray) -> State | None:
        """The state by plain distances; None where the parts overlap."""
        return self.states_of(q[None])[0]

    def states_of(self, q: np.ndarray, near: float = 1e-9) -> list[State | None]:
        """The states of configurations (n, 3); None where the parts overlap, by the area of the intersection."""
        c, s = np.cos(q[:, 2]), np.sin(q[:, 2])
        R = np.moveaxis(np.array([[c, -s], [s, c]]), -1, 0)
        moved = shapely.polygons(np.einsum("nij,vj->nvi", R, self.moving) + q[:, None, :2])
        area = np.max([shapely.area(shapely.intersection(moved, Polygon(polygon))) for polygon in self.fixed], axis=0)
        touching = []
        for mine, point, start, end in self.pairs:
            placed = [R @ x + q[:, :2] for x in ((point,) if mine else (start, end))]
            a, b = (start, end) if mine else placed
            p = placed[0] if mine else point
            along = b - a
            share = np.clip(((p - a) * along).sum(axis=-1) / (along * along).sum(axis=-1), 0, 1)
            touching.append(np.linalg.norm(p - a - share[:, None] * along, axis=-1) <= near)
        table = np.array(touching).T
        names = np.array(self.names)
        return [None if overlap > 1e-10 else frozenset(names[row].tolist())
                for overlap, row in zip(area, table, strict=True)]  # fmt: skip

    def slice_states(self, theta: float) -> dict[State, np.ndarray]:
        """States at one angle: intersections of lines, points between them, and beside those."""
        return self.arranged(self.lines(theta), theta, np.zeros(2), self.reach, 1e-3)

    def arranged(self, lines: np.ndarray, theta: float, center: np.ndarray, reach: float, aside: float) -> dict:
        """States of the arrangement of lines within reach of a point; cells are looked at ``aside`` from the lines."""
        corners = [x for a, b in combinations(lines, 2) if (x := _meet(a, b)) is not None]
        corners = [x for x in corners if np.linalg.norm(x - center) <= reach]
        everything = np.array(corners).reshape(-1, 2)
        points = list(corners)
        for line in lines:
            n, along = line[:2], np.array([-line[1], line[0]])
            foot = center + n * (line[2] - n @ center)
            if np.linalg.norm(foot - center) > reach:
                continue
            near = everything[np.abs(everything @ n - line[2]) < 1e-10]
            places = [-reach, *np.unique(np.round((near - foot) @ along, 12)).tolist(), reach]
            middles = [(a + b) / 2 for a, b in pairwise(places)]
            points += [foot + along * t for t in middles]
            points += [foot + along * t + sign * aside * n for t in middles for sign in (-1, 1)]
        configurations = np.array([[*x, theta] for x in points]).reshape(-1, 3)
        found: dict[State, np.ndarray] = {}
        for q, state in zip(configurations, self.states_of(configurations), strict=True):
            if state is not None:
                found.setdefault(state, q)
        return found

    def special_angles(self) -> list[float]:
        """Where an edge of one part is parallel to one of the other, facing it."""

        def angles(polygon: np.ndarray) -> np.ndarray:
            along = np.roll(polygon, -1, axis=0) - polygon
            return np.arctan2(along[:, 1], along[:, 0])

        mine = angles(self.moving)
        theirs = np.concatenate([angles(polygon) for polygon in self.fixed])
        return [_wrap(b + np.pi - a) for a in mine for b in theirs]

    def triple_points(self, count: int) -> list[np.ndarray]:
        """Configurations where the lines of three pairs meet, by sign changes on a grid of angles."""
        grid = np.linspace(-np.pi, np.pi, count + 1) + 1e-4
        triples = np.array(list(combinations(range(len(self.pairs)), 3)))
        values = np.array([np.linalg.det(self.lines(theta)[triples]) for theta in grid])
        rows, columns = np.nonzero(values[:-1] * values[1:] < 0)
        found = []
        for row, column in zip(rows, columns, strict=True):
            low, high, triple = grid[row], grid[row + 1], triples[column]
            if not self.may_touch((low + high) / 2, triple, grid[1] - grid[0]):
                continue
            theta = brentq(lambda t, rows=triple: np.linalg.det(self.lines(t)[rows]), low, high, xtol=1e-15)
            lines = self.lines(theta)[triple]
            x, *_ = np.linalg.lstsq(lines[:, :2], lines[:, 2], rcond=None)
            if np.linalg.norm(x) <= self.reach and np.abs(lines[:, :2] @ x - lines[:, 2]).max() < 1e-9:
                found.append(np.array([*x, theta]))
        return found

    def may_touch(self, theta: float, triple: np.ndarray, step: float) -> bool:
        """Whether the meeting point is roughly on all three segments: saves most of the bisections."""
        lines = self.lines(theta)[triple]
        x, *_ = np.linalg.lstsq(lines[:, :2], lines[:, 2], rcond=None)
        R = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
        for mine, point, start, end in (self.pairs[k] for k in triple):
            a, b, p = (start, end, R @ point + x) if mine else (R @ start + x, R @ end + x, point)
            share = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
            if np.linalg.norm(p - a - share * (b - a)) > 60 * step:
                return False
        return True

    def states(self, count: int = 60) -> dict[State, list[np.ndarray]]:
        """All states that the search finds, each with its configurations."""
        found: dict[State, list[np.ndarray]] = {}
        for theta in [*np.linspace(-np.pi, np.pi, count, endpoint=False), *self.special_angles()]:
            for state, q in self.slice_states(theta).items():
                found.setdefault(state, []).append(q)
        triples = np.array(self.triple_points(4 * count)).reshape(-1, 3)
        for q, state in zip(triples, self.states_of(triples), strict=True):
            if state is not None and len(state) >= 3:
                found.setdefault(state, []).append(q)
        return found

    def transitions(self, states: dict[State, list[np.ndarray]], most: int = 6) -> set[tuple[State, State]]:
        """(State with more contacts, state with fewer): what begins at some configurations of each state.

        All those where facets are along each other are looked at, and up to ``most`` others.
        """
        special = np.array(self.special_angles())
        found: set[tuple[State, State]] = set()
        for state, configurations in states.items():
            chosen = [q for q in configurations if np.abs(special - q[2]).min() < 1e-12]
            chosen += configurations[:: max(1, len(configurations) // most)]
            for q in chosen:
                found |= {(state, looser) for looser in self.loosenings(q)}
        return found

    def loosenings(self, q: np.ndarray, touching: State | None = None, turn: float = 1e-3) -> set[State]:
        """States that begin at q: those of slices near it, of the lines of what touches at q, in a small disc."""
        touching = self.state(q) if touching is None else touching
        assert touching is not None
        chosen = [k for k, name in enumerate(self.names) if name in touching]
        found: set[State] = set()
        for theta in (q[2] - turn, q[2], q[2] + turn):
            near = self.arranged(self.lines(theta)[chosen], theta, q[:2], 10 * turn, turn / 10)
            found |= {state for state in near if state < touching}
        return found


def _meet(a: np.ndarray, b: np.ndarray) -> np.ndarray | None:
    if abs(a[0] * b[1] - a[1] * b[0]) < 1e-9:
        return None
    return np.linalg.solve(np.array([a[:2], b[:2]]), np.array([a[2], b[2]]))


def _wrap(angle: float) -> float:
    return float(np.arctan2(np.sin(angle), np.cos(angle)))
