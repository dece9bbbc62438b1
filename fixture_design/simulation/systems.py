"""Drake systems: the wrist sensor of a simulation, and recognition, which serves a real robot's diagram as well."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from fixture_design.errors import InputError
from fixture_design.recognition import Classifier, Recogniser
from fixture_design.simulation.setup import WristSensor

if TYPE_CHECKING:
    from pydrake.systems.framework import Context, LeafSystem

#: What the output `state` of recognition shows while more than one state is possible, or none.
AMBIGUOUS = -1


def recognition_system(classifier: Classifier, period: float, known: str | Iterable[str] | None = None) -> LeafSystem:
    """Recognition as a Drake system: each period one sample, and what remains possible after it.

    Input ports: `wrench`, [f; m] that the robot applies to the part as `Classifier.recognize` takes it; `twist`,
    likewise, which may be left unconnected. Output ports: `state`, shape (1,), the row of the state in
    ``classifier.ids``, or -1 while it is not one alone; `possible`, shape (number of states,), 1 for each state that
    is, else 0; `margins`, likewise, by how much the latest sample is inside each state's set (-inf: not asked).

    Args:
        period: of samples [s].  known: the state at the start, or those that it may be.

    Raises:
        UnknownNameError: no such state.
        InputError: a period that is no positive number.
    """
    if not (isfinite(period) and period > 0):
        raise InputError("a period is a positive number", found=repr(period), expected="seconds")
    return _recognition_class()(classifier, period, Recogniser.start(classifier, known))


def sensor_system(wrist: int, sensor: WristSensor, length: float, period: float) -> LeafSystem:
    """A wrist sensor with its errors, and the robot's own measurements.

    Input ports: `reactions`, the plant's joint reactions; `state`, the plant's [q; dq/dt], shape (6,). Output ports:
    `wrench`, [f; m] applied to the part about its origin, fixed axes; `twist`, its displacement in a period;
    `exact`, the wrench without the sensor's errors; each of the last sample, shape (3,).

    Args:
        wrist: index of the joint between robot and part.  length: what moments are divided by in errors [m].
    """
    return _sensor_class()(wrist, sensor, length, period)


@cache
def _recognition_class() -> Any:
    """The class, made when Drake is needed."""
    from pydrake.systems.framework import BasicVector, LeafSystem  # noqa: PLC0415 - Drake where it is used

    class RecognitionSystem(LeafSystem):
        def __init__(self, classifier: Classifier, period: float, start: Recogniser) -> None:
            super().__init__()
            self._classifier, self._ids = classifier, classifier.ids
            size, count = classifier.signals.wrench_size, len(classifier.ids)
            self._wrench = self.DeclareVectorInputPort("wrench", BasicVector(size))
            self._twist = self.DeclareVectorInputPort("twist", BasicVector(size))
            # numbers, since Drake copies abstract states at every step, and a classifier with them
            at_start: Any = np.concatenate([self._mask(start.possible), np.full(count, -np.inf)])
            self.DeclareDiscreteState(at_start)
            self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._update)
            after = {self.xd_ticket()}
            self.DeclareVectorOutputPort("state", BasicVector(1), self._write_state, after)
            self.DeclareVectorOutputPort("possible", BasicVector(count), self._writer(slice(count)), after)
            self.DeclareVectorOutputPort("margins", BasicVector(count), self._writer(slice(count, None)), after)

        def possible(self, context: Context) -> tuple[str, ...]:
            mask = context.get_discrete_state_vector().value()[: len(self._ids)].tolist()
            return tuple(name for name, chosen in zip(self._ids, mask, strict=True) if chosen)

        def _update(self, context: Context, state: Any) -> None:
            wrench: Any = self._wrench.Eval(context)
            twist: Any = self._twist.Eval(context) if self._twist.HasValue(context) else None
            after = Recogniser(self._classifier, self.possible(context)).step(wrench, twist)
            assert after.latest is not None
            margins = [after.latest.margins.get(name, -np.inf) for name in self._ids]
            state.set_value(np.concatenate([self._mask(after.possible), margins]))

        def _mask(self, possible: tuple[str, ...]) -> np.ndarray:
            return np.isin(np.array(self._ids), possible).astype(np.float64)

        def _write_state(self, context: Context, output: Any) -> None:
            possible = self.possible(context)
            output.SetAtIndex(0, float(self._ids.index(possible[0])) if len(possible) == 1 else float(AMBIGUOUS))

        def _writer(self, numbers: slice) -> Any:
            def write(context: Context, output: Any) -> None:
                output.SetFromVector(context.get_discrete_state_vector().value()[numbers])

            return write

    return RecognitionSystem


@cache
def _sensor_class() -> Any:
    """The class, made when Drake is needed."""
    from pydrake.common.value import Value  # noqa: PLC0415 # pyright: ignore[reportAttributeAccessIssue] - as above
    from pydrake.multibody.math import SpatialForce  # noqa: PLC0415 - as above
    from pydrake.systems.framework import BasicVector, LeafSystem  # noqa: PLC0415 - as above

    class SensorSystem(LeafSystem):
        def __init__(self, wrist: int, sensor: WristSensor, length: float, period: float) -> None:
            super().__init__()
            self._wrist, self._sensor, self._period = wrist, sensor, period
            self._scale = np.array([1.0, 1.0, length])
            self._bias = np.random.default_rng(sensor.seed).uniform(-sensor.bias, sensor.bias, 3) * self._scale
            self._kept = float(np.exp(-period / sensor.delay)) if sensor.delay > 0 else 0.0
            self._reactions = self.DeclareAbstractInputPort("reactions", Value[list[SpatialForce]]())
            self._motion = self.DeclareVectorInputPort("state", BasicVector(6))
            self.DeclareDiscreteState(10)  # filtered wrench, measured wrench, twist, samples so far
            self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._update)
            after = {self.xd_ticket()}
            for name, first in (("exact", 0), ("wrench", 3), ("twist", 6)):
                self.DeclareVectorOutputPort(name, BasicVector(3), self._writer(first), after)

        def _update(self, context: Context, state: Any) -> None:
            before = context.get_discrete_state_vector().value()
            motion: Any = self._motion.Eval(context)
            reactions: Any = self._reactions.Eval(context)
            force = reactions[self._wrist]
            c, s = np.cos(motion[2]), np.sin(motion[2])
            f, m = force.translational(), force.rotational()
            exact = np.array([c * f[0] - s * f[1], s * f[0] + c * f[1], m[2]])  # out of the part's axes
            filtered = self._kept * before[:3] + (1 - self._kept) * exact
            size = float(np.linalg.norm(filtered / self._scale))
            rng = np.random.default_rng([self._sensor.seed, int(before[9])])  # so that a context repeats itself
            error = rng.normal(size=3) * (self._sensor.noise * size / np.sqrt(3.0)) * self._scale
            measured = filtered + error + self._bias
            state.set_value(np.concatenate([filtered, measured, motion[3:] * self._period, [before[9] + 1]]))

        def _writer(self, first: int) -> Any:
            def write(context: Context, output: Any) -> None:
                output.SetFromVector(context.get_discrete_state_vector().value()[first : first + 3])

            return write

    return SensorSystem
