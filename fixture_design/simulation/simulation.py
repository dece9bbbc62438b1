"""One simulated run: the world, its sensor, recognition, and whoever moves the virtual target."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol, runtime_checkable

import numpy as np

from fixture_design.arrays import ArrayLike, Rows, Vector
from fixture_design.assembly import Assembly
from fixture_design.errors import InputError
from fixture_design.recognition import Classifier, Log
from fixture_design.simulation.belief import relative
from fixture_design.simulation.planar_world import PlanarWorld, add_planar_world
from fixture_design.simulation.setup import Setup
from fixture_design.simulation.systems import recognition_system, sensor_system
from fixture_design.simulation.true_state import true_contacts


@dataclass(frozen=True, eq=False)
class Sample:
    """What a controller is told; never the truth.

    Attributes:
        time: [s].  pose, velocity: the robot's, shape (3,).
        wrench: of the sensor, [f; m].  possible: ids of the states that remain possible.
    """

    time: float
    pose: Vector
    velocity: Vector
    wrench: Vector
    possible: tuple[str, ...]


@runtime_checkable
class Controller(Protocol):
    """Moves the virtual target of the impedance."""

    @property
    def start(self) -> Vector:
        """The pose to begin at, shape (3,)."""
        ...

    def target(self, sample: Sample) -> Vector:
        """The next target, shape (3,)."""
        ...


@dataclass(frozen=True, eq=False)
class Run:
    """A run that was simulated.

    Attributes:
        log: wrenches, displacements and true contacts at the moments when the sensor took them.
        poses: of the part, as the robot knew them then, shape (n, 3).  final: the last one, shape (3,).
        shift: where the fixed parts really are, shape (3,).
        possible: ids of the states that the recogniser had left when the sensor showed the row; a period behind it.
    """

    log: Log
    poses: Rows
    final: Vector
    shift: Vector
    possible: tuple[tuple[str, ...], ...]

    @property
    def true_final(self) -> Vector:
        """The last pose as the fixed parts see it, shape (3,)."""
        return relative(self.shift, self.final)


@dataclass(eq=False)
class Simulation:
    """A diagram with its simulator; `run` lets a controller move it.

    Attributes:
        classifier: of the recogniser in the loop.  world: the plant.
    """

    assembly: Assembly
    classifier: Classifier
    setup: Setup
    world: PlanarWorld
    _parts: Any = field(repr=False)

    @classmethod
    def of(
        cls, assembly: Assembly, classifier: Classifier, setup: Setup, shift: ArrayLike, known: str | None = None
    ) -> Simulation:
        """The diagram: plant, sensor, recognition.

        Args:
            shift: where the fixed parts really are.  known: the state at the start.

        Raises:
            InputError: a classifier of another assembly, or of what this world's sensor does not measure: wrenches in
                the part's axes, or with its weight.
            Besides as `add_planar_world` and `recognition_system`.
        """
        from pydrake.systems.analysis import Simulator  # noqa: PLC0415 - Drake where it is used
        from pydrake.systems.framework import DiagramBuilder  # noqa: PLC0415 - as above

        builder = DiagramBuilder()
        world = add_planar_world(builder, assembly, setup, shift)
        _require_fitting(classifier, assembly)
        sensor = builder.AddSystem(sensor_system(world.wrist, setup.sensor, classifier.signals.length, setup.period))
        recognition = builder.AddSystem(recognition_system(classifier, setup.period, known))
        plant = world.plant
        builder.Connect(plant.get_reaction_forces_output_port(), sensor.GetInputPort("reactions"))
        builder.Connect(plant.get_state_output_port(), sensor.GetInputPort("state"))
        builder.Connect(sensor.GetOutputPort("wrench"), recognition.GetInputPort("wrench"))
        if classifier.signals.measure != "force":
            builder.Connect(sensor.GetOutputPort("twist"), recognition.GetInputPort("twist"))
        simulator = Simulator(builder.Build())
        return cls(assembly, classifier, setup, world, (simulator, sensor, recognition))

    def run(
        self,
        controller: Controller,
        duration: float,
        every: int = 2,
        until: Callable[[np.ndarray], bool] = lambda _: False,
    ) -> Run:
        """Simulates from rest; every run begins anew.

        Args:
            duration: [s], a period or more.  every: periods between two targets.
            until: ends the run, of the part's pose relative to where the fixed parts really are.

        Raises:
            InputError: numbers that cannot be.
        """
        periods = _periods(duration, self.setup.period, every)
        simulator, sensor, recognition = self._parts
        simulator.reset_context(simulator.get_system().CreateDefaultContext())
        simulator.Initialize()
        plant, context = self.world.plant, simulator.get_mutable_context()
        of_plant = plant.GetMyMutableContextFromRoot(context)
        start: Any = controller.start  # Drake's stubs want another kind of array
        plant.SetPositions(of_plant, start)
        target = plant.get_desired_state_input_port(_model(plant)).FixValue(
            of_plant, np.concatenate([start, np.zeros(3)])
        )
        of_sensor, of_recognition = (system.GetMyContextFromRoot(context) for system in (sensor, recognition))
        rows: list[tuple[float, np.ndarray, np.ndarray, np.ndarray, tuple[str, ...], tuple[str, ...]]] = []
        pose, truth = start, ()
        for k in range(1, periods + 1):
            simulator.AdvanceTo(k * self.setup.period)
            # events at the end of a step are left to the next one: the sensor shows its sample of a period ago
            wrench, twist = (sensor.GetOutputPort(name).Eval(of_sensor) for name in ("wrench", "twist"))
            possible = recognition.possible(of_recognition)
            rows.append(((k - 1) * self.setup.period, wrench, twist, pose, truth, possible))
            state = plant.GetPositionsAndVelocities(of_plant)
            pose = state[:3]
            truth = true_contacts(self.world, plant.get_contact_results_output_port().Eval(of_plant), pose)
            if until(relative(self.world.shift, pose)):
                break
            if (k - 1) % every == 0:
                sample = Sample(k * self.setup.period, pose, state[3:], wrench, possible)
                target.GetMutableData().set_value(np.concatenate([controller.target(sample), np.zeros(3)]))
        times, wrenches, twists, poses, truths, states = zip(*rows, strict=True)
        return Run(Log.of(times, wrenches, twists, truths), np.array(poses), pose, self.world.shift, tuple(states))


def _model(plant: Any) -> Any:
    from pydrake.multibody.tree import default_model_instance  # noqa: PLC0415 - as above

    return default_model_instance()


def _require_fitting(classifier: Classifier, assembly: Assembly) -> None:
    if classifier.name != assembly.name:
        raise InputError(
            "the classifier is of another assembly", found=repr(classifier.name), expected=repr(assembly.name)
        )
    if classifier.signals.axes != "fixed":
        raise InputError(
            "the simulated sensor measures in fixed axes, the classifier in the part's", expected='axes="fixed"'
        )
    if classifier.signals.weight:
        raise InputError("the simulated robot carries the part, the classifier knows its weight", expected="mass=0")


def _periods(duration: float, period: float, every: int) -> int:
    if every < 1:
        raise InputError("a target is set every period, or every few", found=f"every={every}", expected="1 or more")
    if not (np.isfinite(duration) and round(duration / period) >= 1):
        raise InputError("a run lasts a period or more", found=f"{duration!r} s", expected=f"at least {period:g} s")
    return round(duration / period)
