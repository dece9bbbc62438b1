"""The classifier of a contact-state graph: measurement sets of its states, discriminants of its transitions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from fixture_design.arrays import ArrayLike, Vector, Weights
from fixture_design.errors import InputError, UnknownNameError
from fixture_design.recognition.discriminants import Faces
from fixture_design.recognition.measurement import MeasurementSet
from fixture_design.recognition.signals import Signals
from fixture_design.recognition.stacked import Stacked


@dataclass(frozen=True)
class Noise:
    """Stated bounds of what sensors are off, by which all sets are widened.

    Attributes:
        force: largest error of a wrench, relative to it, [f; m / length] [-].  displacement: likewise of a twist [-].
        floor: wrenches shorter than this tell nothing [N]: they are zero, but for noise. Not used with a known weight.
    """

    force: float = 0.0
    displacement: float = 0.0
    floor: float = 0.0

    def __post_init__(self) -> None:
        for name in ("force", "displacement", "floor"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0):
                raise InputError(f"a noise bound ({name}) must be a number >= 0", found=repr(value))
        for name in ("force", "displacement"):
            if (value := getattr(self, name)) >= 1:
                expected = "below 1: an error as large as what is measured leaves nothing; 0.05 is 5 %"
                raise InputError(f"a noise bound ({name}) is relative", found=repr(value), expected=expected)


@dataclass(frozen=True)
class Made:
    """How a classifier was made, for its file.

    Attributes:
        friction, edges, interpolation, accuracy, seed: as `build_classifier` was told.  smallest: whether discriminants
            are the fewest.
    """

    friction: float = 0.0
    edges: int = 0
    interpolation: str = "hull"
    accuracy: float = 0.0
    seed: int = 0
    smallest: bool = False


@dataclass(frozen=True, eq=False)
class StateClass:
    """A state as a classifier knows it.

    Attributes:
        id, contacts: as the graph has them.  measured: its measurement set S_i.
        successors: T_i, ids of the states that may come next; itself among them (4-25).
    """

    id: str
    contacts: tuple[str, ...]
    measured: MeasurementSet
    successors: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Transition:
    """DT(N_i, N_j) (4-26).

    Attributes:
        source, target: ids of N_i and N_j.
        faces: for every cone of S_j the indices of its faces that tell it from all other successors of N_i.
    """

    source: str
    target: str
    faces: tuple[Faces, ...]


@dataclass(frozen=True, eq=False)
class Recognition:
    """What one measurement says.

    Attributes:
        states: ids of the states that remain possible, in the graph's order.
        margins: of every state asked, by how much the measurement is inside its set, widened [-]: sine of the angle to
            the nearest face; negative outside.
        expected: False if no state that was allowed is possible; ``states`` are then those of all that are.
        told: False if nothing was measured that could tell: every allowed state remains.
    """

    states: tuple[str, ...]
    margins: Mapping[str, float]
    expected: bool = True
    told: bool = True

    @property
    def state(self) -> str | None:
        """The state, if one alone is possible."""
        return self.states[0] if len(self.states) == 1 else None


@dataclass(frozen=True, eq=False)
class Classifier:
    """Tells contact states from forces, displacements, or both.

    Attributes:
        name: of the assembly.  signals: what is measured, in which units and axes.
        states: in the graph's order.  transitions: with their discriminants; may be none.
        noise: stated bounds.  made: how.

    Example:
        >>> classifier = build_classifier(graph, friction=0.2, noise=Noise(force=0.05))  # doctest: +SKIP
        >>> classifier.recognize([0.0, -5.0, 2.0], previous="N2").states  # doctest: +SKIP
        ('N2',)
    """

    name: str
    signals: Signals
    states: tuple[StateClass, ...]
    transitions: tuple[Transition, ...] = ()
    noise: Noise = field(default_factory=Noise)
    made: Made = field(default_factory=Made)

    def recognize(
        self, wrench: ArrayLike | None, twist: ArrayLike | None = None, previous: str | Iterable[str] | None = None
    ) -> Recognition:
        """The states that a measurement leaves possible.

        A state is possible if the measurement is in its set, widened by the set's own bound and by the noise. With
        both, p . dq must not be negative either, by more than that: a part that is pushed does not move against the
        push; with a known weight, whose work p . dq leaves out, this is not asked. A measurement that has no direction
        (shorter than the floor) is in all sets; with a known weight there is no floor, since no force tells something.

        Args:
            wrench: p = [f; m], the force that the robot applies to the part (2-16), the opposite of what the contacts
                apply: pressed onto a floor, it points down. Shape (3,) or (6,) [N, N m]; moments about the moving
                part's origin, in the axes that `signals` states.
            twist: dq = [dx; dtheta] of any length, likewise [m, rad].
            previous: the state before, or those it may have been: then only these and their successors are asked, and
                all others if none of them is possible.

        Raises:
            InputError: numbers that do not fit, or are not finite.
            UnknownNameError: no such state.
        """
        signal, force = self._signal(wrench, twist)
        margins = self.margins_of(signal)
        asked = self._everything if previous is None else self._asked(previous)
        contrary = self.contrary(signal)
        possible = [] if contrary else asked[margins[asked] >= 0].tolist()
        expected = bool(possible) or previous is None
        if not expected and not contrary:
            asked = self._everything
            possible = np.flatnonzero(margins >= 0).tolist()
        ids = self.ids
        values = margins.tolist()
        return Recognition(
            tuple(ids[k] for k in possible), {ids[k]: values[k] for k in asked.tolist()}, expected, force
        )

    def margins_of(self, signal: Vector) -> Weights:
        """By how much a signal is inside each state's set, widened; shape (number of states,)."""
        return self._stacked.margins(signal)

    @property
    def ids(self) -> tuple[str, ...]:
        """The states' ids."""
        return self._ids

    def state(self, name: str) -> StateClass:
        """The state with this id.

        Raises:
            UnknownNameError: there is none.
        """
        return self.states[self._index(name)]

    def with_noise(self, noise: Noise) -> Classifier:
        """The same classifier for another sensor."""
        return replace(self, noise=noise)

    def successors(self, states: Iterable[str]) -> tuple[str, ...]:
        """All states that may come after any of these, themselves among them, in order."""
        names = set(states)
        found = set(names)
        for name in names:
            found.update(self.state(name).successors)
        return tuple(name for name in self._ids if name in found)

    @cached_property
    def _ids(self) -> tuple[str, ...]:
        return tuple(state.id for state in self.states)

    @cached_property
    def _everything(self) -> np.ndarray:
        return np.arange(len(self.states))

    @cached_property
    def _places(self) -> dict[str, int]:
        return {state.id: index for index, state in enumerate(self.states)}

    @cached_property
    def _next(self) -> dict[str, np.ndarray]:
        return {name: np.array([self._index(other) for other in self.successors([name])]) for name in self._ids}

    @cached_property
    def _stacked(self) -> Stacked:
        sets = [state.measured for state in self.states]
        return Stacked.of(sets, self.signals.force_size, self.noise.force, self.noise.displacement)

    def _index(self, name: str) -> int:
        if name not in self._places:
            raise UnknownNameError("state", name, self._places)
        return self._places[name]

    def _asked(self, previous: str | Iterable[str]) -> np.ndarray:
        if isinstance(previous, str):
            found = self._next.get(previous)
            return self._next[self.states[self._index(previous)].id] if found is None else found
        return np.array([self._index(name) for name in self.successors(previous)], dtype=int)

    def _signal(self, wrench: ArrayLike | None, twist: ArrayLike | None) -> tuple[Vector, bool]:
        """The signal, and whether it tells anything."""
        signal = self.signals.signal(wrench, twist, self.noise.floor)
        return signal, bool(signal.any())

    def contrary(self, signal: Vector) -> bool:
        """Whether force and displacement, both measured, do negative work beyond noise and widening."""
        size = self.signals.wrench_size
        return self.signals.measure == "both" and float(signal[:size] @ signal[size:]) < -self.work_allowance

    @cached_property
    def work_allowance(self) -> float:
        """How negative the work of unit vectors of force and displacement may be [-]; 2 where that is not asked."""
        if self.signals.measure != "both" or self.signals.weight:
            return 2.0
        widest = max(s.measured.widening.force + s.measured.widening.displacement for s in self.states)
        return widest + self.noise.force + self.noise.displacement
