"""Where the fixed parts may be: displacements that agree with the poses of the robot and with what is recognised.

A recognised state says that its pairs touch, and that nothing overlaps; the robot says where the part is. Of many
displacements of the fixed parts (particles) those stay for which some state that is possible has its pairs closed at
the robot's pose. So the answer of the recogniser is used as what it is, a set, and the displacements tell in turn which
of its states is the likely one: whose pairs are closed there, and whose forces there, F(q) of (4-9) at one
configuration instead of all, hold the wrench.
"""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import ArrayLike, Rows, Vector, Weights
from fixture_design.assembly import ContactStateGraph
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.cones.kernel import nonnegative_least_squares
from fixture_design.recognition import Classifier, Signals
from fixture_design.recognition.sample_cones import Physics, sample_cones

#: How far contacts may be from closed: rounded corners, contacts that give, the sensor's delay, standard deviation [m].
CLOSED = 4e-4

#: Sine of the angle by which a wrench may miss F(q) of a configuration that is known that well, standard deviation [-].
MISSED = 0.07

#: Particles, and the share of effective ones below which they are drawn anew.
_PARTICLES, _FEW = 400, 0.5

#: What drawn particles are moved by, so that they follow what only later samples tell apart: [m, m, rad].
_MOVED = np.array([1.5e-4, 1e-4, 4e-3])

#: The same where all are wrong, relative to the displacements that were expected at the start [-].
_LOST = 0.15

#: The share of particles that is drawn as at the start, each time, and with them all that are farther than this many
#: times what was expected [-].
_FRESH, _FARTHEST = 0.05, 2.5

#: Gaps of the best particle, relative to `CLOSED`, beyond which all of them are wrong [-].
_WRONG = 4.0

#: States with less than this share of the best one's support by their gaps are not asked for their forces [-].
_CONSIDERED = 0.05

#: A contact more explains about this many times more wrenches, and is this much less likely where it is not needed [-].
_CONTACT_MORE = 0.25

#: A state is the same at the next sample with this chance; else it is any that the recogniser leaves [-].
_STAYS = 0.8

#: An expected state is believed if it is supported by this share of what the best one is [-].
_SUPPORTED = 0.4


@dataclass(frozen=True, eq=False)
class States:
    """The states of a graph as rows of a matrix, for all particles at once.

    Attributes:
        ids, contacts: of the states.  pairs: rows of the pairs that take part.  touching: shape (states, pairs).
        signals, physics, floor: of the classifier.
    """

    geometry: ContactGeometry
    ids: tuple[str, ...]
    contacts: tuple[tuple[str, ...], ...]
    pairs: np.ndarray
    touching: np.ndarray

    signals: Signals
    physics: Physics
    floor: float

    @classmethod
    def of(cls, graph: ContactStateGraph, classifier: Classifier) -> States:
        """The states as a classifier of forces knows them."""
        geometry = geometry_of(graph.assembly)
        pairs = np.flatnonzero(geometry.takes_part)
        names = np.array(geometry.names)[pairs]
        touching = np.array([np.isin(names, state.contacts) for state in graph.states])
        ids, contacts = zip(*((state.id, state.contacts) for state in graph.states), strict=True)
        signals = replace(classifier.signals, measure="force", axes="fixed", weight=0.0)
        physics = Physics(classifier.made.friction, classifier.made.edges, np.zeros(2), np.zeros(2))
        return cls(geometry, ids, contacts, pairs, touching, signals, physics, classifier.noise.floor)

    def rows(self, ids: tuple[str, ...]) -> np.ndarray:
        return np.flatnonzero(np.isin(np.array(self.ids), ids))

    def gaps(self, q: Rows, rows: np.ndarray) -> np.ndarray:
        """How far each state is from having its pairs closed without an overlap, shape (n, states) [m]."""
        distances = self.geometry.equations(q, self.pairs[None]).distances
        widest = np.where(self.touching[rows][None], distances[:, None], 0.0).max(axis=2)
        return np.maximum(widest, self.geometry.overlap(q)[:, None])

    def missed(self, row: int, q: Vector, wrench: Vector) -> float:
        """Sine of the angle between a wrench and F(q) of a state; 0 for a wrench that tells nothing."""
        unit = self.signals.signal(wrench, None, self.floor)
        spans = sample_cones(self.geometry, self.contacts[row], q[None], True, self.signals, self.physics).forces[0]
        return float(np.linalg.norm(unit - nonnegative_least_squares(spans.T, unit) @ spans))


@dataclass(frozen=True, eq=False)
class Belief:
    """Particles and their weights.

    Attributes:
        shifts: displacements [x, y, theta] of the fixed parts, shape (n, 3).  weights: their sum is 1.
        chances: of the states, after the latest sample; their sum is 1.
        spread: standard deviations expected at the start, shape (3,).
    """

    states: States
    shifts: Rows
    weights: Weights
    chances: Weights
    spread: Vector

    @classmethod
    def start(
        cls, graph: ContactStateGraph, classifier: Classifier, spread: ArrayLike, rng: np.random.Generator
    ) -> Belief:
        """Before anything was touched: no displacement expected, give or take ``spread`` [m, m, rad]."""
        widths = np.asarray(spread, dtype=np.float64)
        shifts = widths * rng.normal(size=(_PARTICLES, 3))
        states = States.of(graph, classifier)
        even = np.full(_PARTICLES, 1 / _PARTICLES), np.full(len(states.ids), 1 / len(states.ids))
        return cls(states, shifts, *even, widths)

    def after(
        self,
        pose: Vector,
        wrench: Vector,
        possible: tuple[str, ...],
        rng: np.random.Generator,
        expected: Container[str] = (),
    ) -> Estimate:
        """The belief after a sample.

        Args:
            pose: the part's, in the robot's frame.  wrench: measured, likewise.
            possible: ids that the recogniser left.  expected: ids that are preferred where others are hardly likelier.
        """
        rows = self.states.rows(possible)
        gaps = self.states.gaps(relative(self.shifts, pose), rows)
        best = gaps.min(axis=1)
        weights = self.weights * np.exp(-0.5 * (best / CLOSED) ** 2) + np.finfo(float).tiny
        weights /= weights.sum()
        fits = weights[:, None] * np.exp(-0.5 * (gaps / CLOSED) ** 2)
        support = fits.sum(axis=0) + np.finfo(float).tiny
        shifts = [self._mean(share, weights) for share in fits.T]
        for k in np.flatnonzero(support >= _CONSIDERED * support.max()):
            there = turned(wrench, -shifts[k][2])
            missed = self.states.missed(int(rows[k]), relative(shifts[k], pose), there)
            support[k] *= np.exp(-0.5 * (missed / MISSED) ** 2)
        support *= _CONTACT_MORE ** self.states.touching[rows].sum(axis=1)
        support *= _STAYS * self.chances[rows] + (1 - _STAYS) / len(self.chances)
        chances = np.zeros(len(self.chances))
        chances[rows] = support / max(float(support.sum()), np.finfo(float).tiny)
        ids = [self.states.ids[row] for row in rows]
        likely = np.flatnonzero(support >= _SUPPORTED * support.max())
        chosen = max(likely, key=lambda k: (ids[k] in expected, support[k]))
        lost = bool(best.min() > _WRONG * CLOSED)
        return Estimate(replace(self._drawn(weights, lost, rng), chances=chances), ids[chosen], shifts[chosen])

    def _mean(self, share: Weights, weights: Weights) -> Vector:
        total = float(share.sum())
        return share @ self.shifts / total if total > 0 else weights @ self.shifts

    def _drawn(self, weights: Weights, lost: bool, rng: np.random.Generator) -> Belief:
        count = len(weights)
        if not lost and 1 / (weights @ weights) > _FEW * count:
            return replace(self, weights=weights)
        chosen = np.searchsorted(np.cumsum(weights), (np.arange(count) + rng.uniform()) / count)
        widths = _LOST * self.spread if lost else _MOVED
        shifts = self.shifts[np.minimum(chosen, count - 1)] + widths * rng.normal(size=(count, 3))
        fresh = np.array((np.abs(shifts) > _FARTHEST * self.spread).any(axis=1))
        fresh[: int(_FRESH * count)] = True  # what was given up too early may come back
        shifts[fresh] = self.spread * rng.normal(size=(int(fresh.sum()), 3))
        return replace(self, shifts=shifts, weights=np.full(count, 1 / count))


@dataclass(frozen=True, eq=False)
class Estimate:
    """What is believed after a sample.

    Attributes:
        state: id of the likely one of the possible states.  shift: where the fixed parts then are, shape (3,).
    """

    belief: Belief
    state: str
    shift: Vector


def relative(frame: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Planar poses seen from planar frames, shapes (..., 3): X_FP of X_WF and X_WP."""
    c, s = np.cos(frame[..., 2]), np.sin(frame[..., 2])
    x, y = pose[..., 0] - frame[..., 0], pose[..., 1] - frame[..., 1]
    return np.stack([c * x + s * y, -s * x + c * y, pose[..., 2] - frame[..., 2]], axis=-1)


def turned(vector: Vector, angle: float) -> Vector:
    """A planar displacement or wrench in axes that are turned by minus the angle, shape (3,)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1], vector[2]])
