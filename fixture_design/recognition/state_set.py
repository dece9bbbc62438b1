"""The measurement set of one state of a graph: from its samples, those of its closure, and denser ones as a check."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fixture_design.assembly import ContactState, ContactStateGraph
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.spatial import SpatialGeometry
from fixture_design.recognition.chart import chart_of, spread
from fixture_design.recognition.checking import displacements_outside, forces_outside
from fixture_design.recognition.measurement import Interpolation, MeasurementSet, Widening, measurement_set
from fixture_design.recognition.sample_cones import Physics, SampleCones, sample_cones
from fixture_design.recognition.signals import Signals
from fixture_design.recognition.simplices import Simplices, StateEquations, simplices_of
from fixture_design.tolerances import TOUCHING

#: Random starts for denser samples of a state, from which its bound is found.
_DENSER = 300

#: Rounds in which samples that stick out are added, and how many at most in each.
_ROUNDS, _ADDED = 4, 8

#: Configurations between those that were checked may be further outside by this factor [-].
_ALLOWANCE = 1.2

#: Simplices next to a sample by whose displacement sets its own is bounded.
_NEXT = 3


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
    def forces(self) -> Signals:
        """Signals of forces alone."""
        return replace(self.signals, measure="force")

    @property
    def spacing(self) -> float:
        return float(np.sqrt(8 * self.accuracy))


def state_set(
    graph: ContactStateGraph, geometry: ContactGeometry, state: ContactState, recipe: Recipe
) -> MeasurementSet:
    """S_i of a state, widened so that it holds the sets of all samples there are, and of denser ones.

    The samples are those of the state and of all states with more contacts, where the same contacts hold: its closure
    has the extremes of its forces. Configurations between these and the state's ends may be further out: of some 200 to
    320 fresh ones of a state of Figure 14 with coincident apices and friction 0.2 none to nine, by 0.023 at most.
    """
    alone = _pairs_alone(geometry, state)
    pool = _pool(graph, geometry, state, recipe, alone)
    cones = _cones(geometry, state, pool, recipe, alone)
    if recipe.interpolation != "neighbours":
        groups = [tuple(range(len(pool)))] if recipe.interpolation == "hull" else [(k,) for k in range(len(pool))]
        found = measurement_set(cones, groups, recipe.signals)
        return found.widened(Widening(_largest(_force_outside(found, cones, recipe)), 0.0))
    return _interpolated(geometry, state, cones, recipe, alone)


def _pool(
    graph: ContactStateGraph, geometry: ContactGeometry, state: ContactState, recipe: Recipe, alone: bool
) -> np.ndarray:
    """Configurations to choose from: the graph's samples; with interpolation the closure's and denser ones too."""
    if recipe.interpolation != "neighbours":
        return state.samples
    equations = StateEquations.of(geometry, state.contacts)
    rng = np.random.default_rng(recipe.seed)
    denser, _ = equations.onto(geometry.random(rng, _DENSER))
    tighter = [other.samples for other in graph.states if set(state.contacts) < set(other.contacts)]
    # two apices in one point are one contact with clauses of its own; what more touches is not that contact's
    return np.concatenate([state.samples, denser, *(tighter if alone else [])])


def _pairs_alone(geometry: ContactGeometry, state: ContactState) -> bool:
    """Whether every pair that touches is a contact of its own: no apices in one point, of polyhedra none on a rim."""
    if state.coincident or not isinstance(geometry, SpatialGeometry):
        return not state.coincident
    pairs = [geometry.names.index(name) for name in state.contacts]
    return not geometry.at_apices(state.samples, TOUCHING * geometry.size)[:, pairs].any()


def _cones(geometry: ContactGeometry, state: ContactState, q: np.ndarray, recipe: Recipe, alone: bool) -> SampleCones:
    return sample_cones(geometry, state.contacts, q, alone, recipe.signals, recipe.physics)


def _interpolated(
    geometry: ContactGeometry, state: ContactState, pool: SampleCones, recipe: Recipe, alone: bool
) -> MeasurementSet:
    """Spread samples, their simplices, and the samples that stick out added until few do."""
    equations = StateEquations.of(geometry, state.contacts)
    chart = chart_of(geometry, state.contacts, pool, alone)
    chosen = spread(chart.points, recipe.spacing)
    for _ in range(_ROUNDS):
        part = pool.taking(chosen)
        simplices = simplices_of(chart, chosen, part.q, equations)
        outside = _force_outside(measurement_set(part, simplices.members, recipe.forces, simplify=False), pool, recipe)
        beyond = np.flatnonzero(outside > recipe.accuracy)
        if not len(beyond):
            break
        order = beyond[np.argsort(-outside[beyond], kind="stable")]
        chosen = chosen + _apart(chart.points, order, recipe.spacing / 4)[:_ADDED]
    part = pool.taking(chosen)
    simplices = simplices_of(chart, chosen, part.q, equations)
    found = measurement_set(part, simplices.members, recipe.signals)
    middles = _cones(geometry, state, simplices.middles, recipe, alone)
    widening = Widening(
        _largest(_force_outside(found, pool + middles, recipe)),
        _displacements(part, simplices, chart.points, chart.points[chosen], pool, recipe),
    )
    return found.widened(widening)


def _force_outside(found: MeasurementSet, samples: SampleCones, recipe: Recipe) -> np.ndarray:
    if recipe.signals.measure == "displacement" and found.cones.dimension == recipe.signals.size:
        return np.zeros(len(samples))
    return forces_outside(found, samples, recipe.forces)


def _largest(values: np.ndarray) -> float:
    return _ALLOWANCE * float(values.max(initial=0.0))


def _displacements(
    part: SampleCones,
    simplices: Simplices,
    everywhere: np.ndarray,
    points: np.ndarray,
    pool: SampleCones,
    recipe: Recipe,
) -> float:
    """The bound of displacement sets: of each sample of the pool by the best of the simplices next to it."""
    if recipe.signals.measure == "force":
        return 0.0
    middles = np.array([points[list(members)].mean(axis=0) for members in simplices.members])
    worst = 0.0
    for point, alternatives in zip(everywhere, pool.displacements, strict=True):
        near = np.argsort(((middles - point) ** 2).sum(axis=1), kind="stable")[:_NEXT]
        groups = [[part.displacements[k] for k in simplices.members[index]] for index in near]
        size = recipe.signals.wrench_size
        worst = max(worst, min(displacements_outside(alternatives, group, size) for group in groups))
    return _ALLOWANCE * worst


def _apart(points: np.ndarray, order: np.ndarray, distance: float) -> list[int]:
    """The first of the order, and of the others those that are not near one already taken."""
    taken: list[int] = []
    for index in order.tolist():
        if all(np.linalg.norm(points[index] - points[other]) > distance for other in taken):
            taken.append(index)
    return taken
