"""A task as the search sees it: arrays, indices, and what is asked of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fixture_design.arrays import Indices, Mask, Point, Points, Rows, Vector
from fixture_design.design.candidates import Candidates, Several, stops
from fixture_design.design.duties import Duties
from fixture_design.design.hitting import free_motion
from fixture_design.design.locating import Features, apart
from fixture_design.design.pushing import Program
from fixture_design.design.standing import Standing
from fixture_design.design.task import Limits, Objective
from fixture_design.tolerances import DEFAULT, PLANE_KNOWN_TO


@dataclass(frozen=True, eq=False)
class Problem:
    """What is searched for.

    Attributes:
        candidates: all of them, elements of the start layout last.
        locators, clamps: indices of elements of the start that stay; clamps are all that are no locators.
        spare: indices of clamps of the start that may leave, preferred to new ones.
        locates: whether the locators must determine the part, as far as any candidates can.
        leaves: whether the part must come out of the locators in a straight line.
        determines: whether the locators must determine the part, so that there are as many rows as freedoms.
        enters: whether the locators must leave the part some motion.
        opens: whether some motion must leave all locators at once, be it a screw.
        slides: whether the part may slide along locators on its straight way out, although some motion leaves all.
        closes: None, or whether all must close, and whether "with friction".
        features: what accuracy is measured by; None for the volume.
        generous: whether friction cones are taken a little larger than they are, for bounds, and not smaller.
        standing: which of them would run into each other; None where nobody knows.
        barred: directions out, each with the candidates that the part would run into along it, shape (n,).
        duties: what is to be balanced by preloads; None where nobody asks.
        cancelled: asked now and then.
    """

    candidates: Candidates
    limits: Limits
    objective: tuple[Objective, ...]
    locators: tuple[int, ...] = ()
    clamps: tuple[int, ...] = ()
    spare: tuple[int, ...] = ()
    locates: bool = True
    leaves: bool = True
    determines: bool = True
    enters: bool = True
    opens: bool = True
    slides: bool = False
    closes: str | None = "without friction"
    features: Features | None = None
    standing: Standing | None = None
    generous: bool = False
    barred: tuple[tuple[Point, Mask], ...] = ()
    duties: Duties | None = None
    cancelled: Callable[[], bool] = lambda: False

    @cached_property
    def new(self) -> Indices:
        """The candidates that are no elements yet."""
        return np.array([i for i, e in enumerate(self.candidates.elements) if e is None], dtype=np.int64)

    @cached_property
    def clampable(self) -> Indices:
        """Those that may become a clamp: new ones, and clamps of the start."""
        return np.concatenate([self.new, np.array(self.spare, dtype=np.int64)])

    @property
    def lets_go(self) -> bool:
        """Whether the straight way out must leave all locators at once."""
        return self.leaves and self.opens and not self.slides

    @property
    def kept(self) -> Indices:
        """All elements that stay."""
        return np.array([*self.locators, *self.clamps], dtype=np.int64)

    @property
    def supporting(self) -> int:
        """How many of `clamps` are none, but supports, fingers or bodies: these count towards no limit of clamps."""
        elements = [self.candidates.elements[index] for index in self.clamps]
        return sum(element is not None and element.role != "clamp" for element in elements)

    @cached_property
    def closing_rows(self) -> Several:
        """The rows that must close, shape (n, k, d)."""
        if self.generous:
            return self.bounding_rows
        return self.candidates.rows_with_friction if self.closes == "with friction" else self.candidates.rows

    @cached_property
    def bounding_rows(self) -> Several:
        """Rows that close whenever those with the true friction cones do, for bounds: of pyramids around the cones."""
        return self.candidates.rows_around_friction if self.closes == "with friction" else self.candidates.rows

    @cached_property
    def rows(self) -> Rows:
        """Unit face vectors of all normals, one under the other: row r is of candidate r // `each`."""
        return np.ascontiguousarray(self.candidates.rows.reshape(-1, self.candidates.dimension))

    @property
    def each(self) -> int:
        return self.candidates.rows.shape[1]

    @cached_property
    def places(self) -> Points:
        """For each of `rows` its candidate's place."""
        return np.repeat(self.candidates.places, self.each, axis=0)

    @cached_property
    def never_stopped(self) -> Vector | None:
        """A unit motion that not even all candidates stop; None where they do, or nothing has to close."""
        if self.closes is None:
            return None
        rows = np.ascontiguousarray(self.bounding_rows.reshape(-1, self.candidates.dimension))
        return free_motion(rows, self.candidates.tolerances)

    @cached_property
    def pushing(self) -> Program | None:
        """What the least preloads are reckoned by; None where nobody asks for preloads."""
        if self.duties is None:
            return None
        return Program(self._rough(outer=False), self.candidates.pushes(rough=False), self.duties)

    @cached_property
    def pushing_bound(self) -> Program | None:
        """The same with pyramids around the friction cones, for bounds."""
        if self.duties is None:
            return None
        return Program(self._rough(outer=True), self.candidates.pushes(rough=False), self.duties)

    def _rough(self, *, outer: bool) -> Several:
        return self.candidates.pushes(rough=bool(self.candidates.friction.any()), outer=outer)

    def rows_of(self, candidates: Indices | tuple[int, ...]) -> Indices:
        """Numbers of the rows by which candidates locate, independent ones of each."""
        numbers = (np.asarray(candidates, dtype=np.int64)[:, None] * self.each + np.arange(self.each)).ravel()
        return numbers[self._locating[numbers]]

    @cached_property
    def noticed(self) -> Rows:
        """Orthonormal rows that span all that candidates can notice."""
        return np.linalg.svd(self.rows, full_matrices=False)[2][: self.candidates.freedoms]

    @cached_property
    def _locating(self) -> Mask:
        """Which of `rows` locate: of those of one candidate independent ones."""
        return np.any(self.candidates.locating.reshape(len(self.rows), -1), axis=1)

    @cached_property
    def several(self) -> bool:
        """Whether some new element would locate in more than one row, as a pad does."""
        return bool((np.any(self.candidates.locating[self.new], axis=2).sum(axis=1) > 1).any())

    def owners(self, rows: Indices) -> Indices:
        """The candidates of rows, each once."""
        return np.unique(rows // self.each)

    @property
    def vague(self) -> bool:
        """Whether some candidate, most often an element of the start, may do more than its rows say."""
        return bool(self.candidates.vague.any())

    @property
    def uncertain(self) -> bool:
        """Whether some normals are known less well than a file's digits leave those of plane facets."""
        return bool(self.candidates.errors.max(initial=0.0) > PLANE_KNOWN_TO)

    @property
    def barely_stopped(self) -> bool:
        """Whether the motion that is never stopped is, by no more than rounding does."""
        zero = self.candidates.tolerances.zero
        return self.never_stopped is not None and bool(stops(self.bounding_rows, self.never_stopped, zero).any())

    @property
    def crowded(self) -> bool:
        """Whether it matters which candidates are chosen together."""
        return self.limits.spacing > 0 or self.standing is not None

    def joins(self, pool: Indices, chosen: Indices | tuple[int, ...] | list[int]) -> Mask:
        """Which of a pool of candidates are far enough from all chosen ones, and not in their way."""
        chosen = np.asarray(chosen, dtype=np.int64)
        free = apart(self.candidates.places, chosen, pool, self.limits.spacing)
        return free if self.standing is None else free & self.standing.free(chosen, pool)

    def together(self, chosen: Indices) -> bool:
        """Whether candidates may all be chosen together."""
        return all(self.joins(chosen[place + 1 :], chosen[[place]]).all() for place in range(len(chosen)))

    def passing(self, pool: Indices, out: Point | None) -> Indices:
        """Those of a pool that are not known to be in the part's way out."""
        for direction, hit in self.barred if out is not None else ():
            if float(direction @ out) > 1 - DEFAULT.near:
                pool = pool[~hit[pool]]
        return pool
