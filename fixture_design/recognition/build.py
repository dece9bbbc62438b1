"""From a contact-state graph to its classifier."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations

import numpy as np

from fixture_design.arrays import ArrayLike
from fixture_design.assembly import ContactStateGraph
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.errors import InputError
from fixture_design.recognition.classifier import Classifier, Made, Noise, StateClass, Transition
from fixture_design.recognition.discriminants import Against, Faces, discriminants, smallest, united
from fixture_design.recognition.measurement import Interpolation, MeasurementSet, oriented_rows
from fixture_design.recognition.numbers_of import numbers_of
from fixture_design.recognition.sample_cones import Physics
from fixture_design.recognition.signals import Axes, Measure, Signals
from fixture_design.recognition.state_set import Recipe, state_set


def build_classifier(
    graph: ContactStateGraph,
    *,
    measure: Measure = "force",
    axes: Axes = "fixed",
    friction: float = 0.0,
    edges: int = 8,
    mass: float = 0.0,
    center: ArrayLike | None = None,
    gravity: ArrayLike | None = None,
    noise: Noise | None = None,
    interpolation: Interpolation = "neighbours",
    accuracy: float = 0.005,
    discriminants: bool = True,
    fewest: bool = False,
    length: float | None = None,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> Classifier:
    """Measurement sets of all states (4-10) and discriminants of all transitions (4-26).

    Args:
        measure: "force" (4-9), "displacement" (4-12), or "both" jointly.
        axes: of measured vectors: "fixed" in the world, or the moving "part"'s own, as a wrist sensor has them. Their
            origin is the moving part's (3-34).
        friction: mu of every contact.  edges: of friction pyramids in space, which lie around the cones.
        mass, center, gravity: of the moving part [kg], its centre of mass in its own frame [m], in the world [m/s^2],
            where its weight is part of the balance but not of what is measured. Without mass there is none.
        noise: stated bounds of the sensors, by which sets are widened.
        interpolation: "neighbours" (4-37), "none" (4-11), or "hull": one cone a state, as Table 6 has it.
        accuracy: sine of the angle to which neighbours are spaced, see `Recipe`.
        discriminants: whether transitions get theirs.  fewest: the smallest groups, instead of those of Table 7.
        length: what moments are divided by [m]; None: the root mean square distance of the moving features.
        seed: of the denser samples that sets are checked on.
        progress: is told in words how far it is.

    Raises:
        InputError: a graph without states, numbers that cannot be.
        UnsupportedError: shapes that have no contact geometry.
    """
    if not graph.states:
        raise InputError("the graph has no states", expected="a graph that `fixture-design states` found")
    geometry = geometry_of(graph.assembly)
    if seed < 0:
        raise InputError("a seed must be a whole number >= 0", found=str(seed))
    plane = 2 if geometry.dimension == 3 else 3
    physics = _physics(plane, friction, edges, mass, center, gravity)
    scale = geometry.radius if length is None else _positive("length", length)
    signals = Signals(measure, axes, plane, scale, float(np.linalg.norm(physics.force)))
    recipe = Recipe(signals, physics, interpolation, _positive("accuracy", accuracy), seed)
    sets = []
    for state in graph.states:
        progress(f"measurement set of {state.id}, {len(sets) + 1} of {len(graph.states)}")
        sets.append(state_set(graph, geometry, state, recipe))
    made = Made(friction, edges, interpolation, accuracy, seed, fewest)
    ids = [state.id for state in graph.states]
    successors = _successors(graph)
    states = tuple(
        StateClass(state.id, state.contacts, found, tuple(sorted(successors[state.id], key=ids.index)))
        for state, found in zip(graph.states, sets, strict=True)
    )
    found = transitions(states, fewest=fewest, progress=progress) if discriminants else ()
    return Classifier(graph.assembly.name, signals, states, found, noise or Noise(), made)


def transitions(
    states: tuple[StateClass, ...], *, fewest: bool = False, progress: Callable[[str], None] = lambda _: None
) -> tuple[Transition, ...]:
    """DT(N_i, N_j) of every state and each of its successors.

    Every cone of a successor is told from every cone of all others: some 0.3 ms each in the plane, 0.6 ms in space.

    Args:
        fewest: the smallest groups, each a set cover over all of N_i's other successors at once.
        progress: is told in words how far it is.
    """
    by_id = {state.id: state for state in states}
    against = {state.id: [Against.of(cone) for cone in state.measured.cones] for state in states}
    if fewest:
        found = []
        for count, state in enumerate(states):
            progress(f"discriminants after {state.id}, {count + 1} of {len(states)}")
            for target in state.successors:
                others = _others(state, target, against)
                found.append(Transition(state.id, target, _smallest(by_id[target].measured, others)))
        return tuple(found)
    pairs = {pair for state in states for pair in combinations(state.successors, 2)}
    told = {}
    both_ways = sorted(pairs | {(b, a) for a, b in pairs})
    for count, (first, second) in enumerate(both_ways):
        progress(f"discriminants of {first} from {second}, {count + 1} of {len(both_ways)}")
        rows = [oriented_rows(cone) for cone in by_id[first].measured.cones]
        told[first, second] = [united(discriminants(some, other) for other in against[second]) for some in rows]
    return tuple(
        Transition(state.id, target, _joined([told[target, other] for other in state.successors if other != target],
                                             len(by_id[target].measured)))
        for state in states
        for target in state.successors
    )  # fmt: skip


def _others(state: StateClass, target: str, against: dict[str, list[Against]]) -> list[Against]:
    return [cone for other in state.successors if other != target for cone in against[other]]


def _smallest(found: MeasurementSet, others: list[Against]) -> tuple[Faces, ...]:
    return tuple(smallest(oriented_rows(cone), others) for cone in found.cones)


def _joined(groups: list[list[Faces]], cones: int) -> tuple[Faces, ...]:
    """The intersection over successors, cone by cone."""
    return tuple(united(group[k] for group in groups) for k in range(cones))


def _successors(graph: ContactStateGraph) -> dict[str, set[str]]:
    """T_i (4-25): a state, and all beside it."""
    found = {state.id: {state.id} for state in graph.states}
    for edge in graph.transitions:
        found[edge.tight].add(edge.loose)
        found[edge.loose].add(edge.tight)
    return found


def _physics(
    plane: int, friction: float, edges: int, mass: float, center: ArrayLike | None, gravity: ArrayLike | None
) -> Physics:
    if not (np.isfinite(friction) and friction >= 0):
        raise InputError("friction must be a number >= 0", found=repr(friction))
    if edges < 3:
        raise InputError("a friction pyramid has 3 edges or more", found=str(edges))
    if not (np.isfinite(mass) and mass >= 0):
        raise InputError("a mass must be a number >= 0 [kg]", found=repr(mass))
    down = np.zeros(plane)
    down[-1] = -9.81
    return Physics(friction, edges, mass * _point("gravity", gravity, down), _point("center", center, np.zeros(plane)))


def _point(name: str, given: ArrayLike | None, default: np.ndarray) -> np.ndarray:
    if given is None:
        return default
    values = numbers_of(given, name)
    if values.shape != default.shape or not np.isfinite(values).all():
        raise InputError(f"{name} must be {len(default)} finite numbers", found=str(values.tolist()))
    return values


def _positive(name: str, value: float) -> float:
    if not (np.isfinite(value) and value > 0):
        raise InputError(f"{name} must be a number > 0", found=repr(value))
    return float(value)
