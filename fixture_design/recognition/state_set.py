"""The measurement set of one state of a graph: from its samples, those of its closure, and denser ones as a check."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.assembly import ContactState, ContactStateGraph
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.recognition.chart import chart_of, spread
from fixture_design.recognition.checking import displacements_outside, forces_outside
from fixture_design.recognition.measurement import Interpolation, MeasurementSet, Widening, measurement_set
from fixture_design.recognition.sample_cones import Physics, SampleCones, sample_cones
from fixture_design.recognition.signals import Signals
from fixture_design.recognition.simplices import StateEquations, simplices_of

#: Random starts for denser samples of a state.
_DENSER = 300

#: Rounds in which samples that stick out are added, and how many at most in each.
_ROUNDS, _ADDED = 4, 8


@dataclass(frozen=True, eq=False)
class Recipe:
    """How measurement sets are made.

    Attributes:
        accuracy: how far samples may be outside a set before they are added to those it is made of [-]; neighbours are
            spaced so that the curvature between them is about that: the error is an eighth of the spacing squared.
        seed: of the denser samples.
    """

    signals: Signals
    physics: Physics
    interpolation: Interpolation
    accuracy: float
    seed: int

    @property
    def spacing(self) -> float:
        return float(np.sqrt(8 * self.accuracy))


def state_set(graph: ContactStateGraph, geometry: ContactGeometry, state: ContactState, recipe: Recipe) -> MeasurementSet:
    """S_i of a state, widened so that it holds the sets of all samples there are, and of denser ones.

    The samples are those of the state and of all states with more contacts, where the same contacts hold: its closure
    has the extremes of its forces.
    """
    pool = _pool(graph, geometry, state, recipe)
    cones = _cones(geometry, state, pool, recipe)
    if recipe.interpolation != "neighbours":
        groups = [tuple(range(len(pool)))] if recipe.interpolation == "hull" else [(k,) for k in range(len(pool))]
        found = measurement_set(cones, groups, recipe.signals)
        return _widened(found, cones, recipe)
    return _interpolated(geometry, state, cones, recipe)


def _pool(
    graph: ContactStateGraph, geometry: ContactGeometry, state: ContactState, recipe: Recipe
) -> np.ndarray:
    """Configurations to choose from: the graph's samples alone, but with interpolation the closure's and denser ones."""
    if recipe.interpolation != "neighbours" or not state.contacts:
        return state.samples
    equations = StateEquations.of(geometry, state.contacts)
    rng = np.random.default_rng(recipe.seed)
    denser, _ = equations.onto(geometry.random(rng, _DENSER))
    tighter = [other.samples for other in graph.states if set(state.contacts) < set(other.contacts)]
    # two apices in one point are one contact with clauses of its own; what more touches is not that contact's
    return np.concatenate([state.samples, denser, *([] if state.coincident else tighter)])


def _cones(geometry: ContactGeometry, state: ContactState, q: np.ndarray, recipe: Recipe) -> SampleCones:
    return sample_cones(geometry, state.contacts, q, not state.coincident, recipe.signals, recipe.physics)


def _interpolated(
    geometry: ContactGeometry, state: ContactState, pool: SampleCones, recipe: Recipe
) -> MeasurementSet:
    """Spread samples, their simplices, and the samples that stick out added until few do."""
    equations = StateEquations.of(geometry, state.contacts)
    chart = chart_of(geometry, state.contacts, pool.q, not state.coincident, recipe.signals)
    chosen = spread(chart.points, recipe.spacing)
    for last in [False] * _ROUNDS + [True]:
        part = pool.taking(chosen)
        simplices = simplices_of(chart, chosen, part.q, equations)
        found = measurement_set(part, simplices.members, recipe.signals, simplify=last)
        outside = _outside(found, pool, recipe)
        beyond = np.flatnonzero(outside.max(axis=0) > recipe.accuracy)
        if last or not len(beyond):
            break
        order = beyond[np.argsort(-outside.max(axis=0)[beyond], kind="stable")]
        chosen += _apart(chart.points, order, recipe.spacing / 4)[:_ADDED]
    found = measurement_set(part, simplices.members, recipe.signals)
    middles = _cones(geometry, state, simplices.middles, recipe)
    return _widened(found, pool + middles, recipe)


def _apart(points: np.ndarray, order: np.ndarray, distance: float) -> list[int]:
    """The first of the order, and of the others those that are not near one already taken."""
    taken: list[int] = []
    for index in order.tolist():
        if all(np.linalg.norm(points[index] - points[other]) > distance for other in taken):
            taken.append(index)
    return taken


def _outside(found: MeasurementSet, samples: SampleCones, recipe: Recipe) -> np.ndarray:
    """How far samples are outside, of both blocks: shape (2, n)."""
    signals = recipe.signals
    none = np.zeros(len(samples))
    force = none if signals.measure == "displacement" else forces_outside(found, samples, signals)
    return np.array([force, none if signals.measure == "force" else displacements_outside(found, samples, signals)])


def _widened(found: MeasurementSet, samples: SampleCones, recipe: Recipe) -> MeasurementSet:
    force, displacement = _outside(found, samples, recipe).max(axis=1)
    return found.widened(Widening(float(force), float(displacement)))
