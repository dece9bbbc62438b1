"""A planar assembly in Drake: the moving part on a robot with an impedance, the fixed ones where they really are.

The part has three joints (x, y, theta) with Drake's implicit joint controllers, which are the impedance. Sides are
boxes, apices that take part are small balls: each contact is one of a ball with a box, exact, and names its features.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fixture_design.arrays import ArrayLike, Vector
from fixture_design.assembly import Assembly
from fixture_design.assembly.features import PlanarFeatures, planar_features
from fixture_design.errors import UnsupportedError
from fixture_design.simulation.rectangles import Rectangle, rounded
from fixture_design.simulation.setup import Robot, Setup, Surfaces

if TYPE_CHECKING:
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import RigidBody
    from pydrake.systems.framework import DiagramBuilder

#: How thick everything is across the plane [m]; no number depends on it.
_THICK = 0.04

#: Mass of links that only carry joints, relative to the robot's [-].
_CARRIER = 0.05


@dataclass(frozen=True)
class SimulatedFeature:
    """What a geometry of the simulation stands for.

    Attributes:
        moving: whether it is of the moving part.
        apex: its name; None for a body's sides.
        rows: the body's rows in its `PlanarFeatures`: of the apex, or of all sides.
    """

    moving: bool
    apex: str | None
    rows: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class PlanarWorld:
    """The plant with its scene, in a diagram that is not built yet.

    Attributes:
        wrist: index of the joint between robot and part, whose reaction a wrist sensor measures.
        features: by geometry id.  sides: features of the moving part in its frame, and of the fixed ones in theirs.
        shift: where the fixed parts really are, [x, y, theta], shape (3,).  radius: of rounded apices [m].
    """

    plant: MultibodyPlant
    scene: Any
    wrist: int
    features: dict[Any, SimulatedFeature]
    sides: tuple[PlanarFeatures, PlanarFeatures]
    shift: Vector
    radius: float


def add_planar_world(builder: DiagramBuilder, assembly: Assembly, setup: Setup, shift: ArrayLike) -> PlanarWorld:
    """Adds a planar assembly of rectangles to a diagram.

    Args:
        shift: by how much the fixed parts are displaced from where the assembly has them [m, m, rad].

    Raises:
        UnsupportedError: an assembly in space, or bodies that are no rectangles.
    """
    from pydrake.geometry import CollisionFilterDeclaration, GeometrySet  # noqa: PLC0415 - Drake where it is used
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, ContactModel  # noqa: PLC0415 - as above

    if assembly.space != "planar":
        raise UnsupportedError("only planar assemblies can be simulated so far", source=assembly.source)
    sides = planar_features(assembly)
    plant, scene = AddMultibodyPlantSceneGraph(builder, time_step=setup.time_step)
    plant.set_contact_model(ContactModel.kPoint)
    plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))  # the robot carries the part
    part, wrist = _robot(plant, setup.robot)
    where = np.asarray(shift, dtype=np.float64)
    shapes = _Shapes(plant, setup.surfaces)
    shapes.add(part, sides[0], True, np.zeros(3))
    shapes.add(plant.world_body(), sides[1], False, where)
    plant.Finalize()
    # balls meet boxes only: boxes among themselves, and balls, would say the same again
    filters = CollisionFilterDeclaration()
    for group in (shapes.balls, shapes.boxes):
        filters.ExcludeWithin(GeometrySet(group))
    scene.collision_filter_manager().Apply(filters)
    return PlanarWorld(plant, scene, wrist, shapes.features, sides, where, setup.surfaces.radius)


def _robot(plant: MultibodyPlant, robot: Robot) -> tuple[RigidBody, int]:
    """The part's body and its wrist joint: x, y and theta with controllers, then the flange, then the part."""
    from pydrake.math import RigidTransform  # noqa: PLC0415 - as above
    from pydrake.multibody.tree import (  # noqa: PLC0415 - as above
        PdControllerGains,
        PrismaticJoint,
        RevoluteJoint,
        SpatialInertia,
        UnitInertia,
        WeldJoint,
    )

    def body(name: str, mass: float) -> RigidBody:
        sphere = UnitInertia(*[robot.inertia / robot.mass] * 3)
        return plant.AddRigidBody(name, SpatialInertia(mass, _vector(0.0, 0.0, 0.0), sphere))

    light = _CARRIER * robot.mass
    x, y, flange, part = (
        body(name, mass)
        for name, mass in (("x", light), ("y", light), ("flange", robot.mass - 3 * light), ("part", light))
    )
    joints = (
        PrismaticJoint("x", plant.world_frame(), x.body_frame(), _vector(1.0, 0.0, 0.0)),
        PrismaticJoint("y", x.body_frame(), y.body_frame(), _vector(0.0, 1.0, 0.0)),
        RevoluteJoint("theta", y.body_frame(), flange.body_frame(), _vector(0.0, 0.0, 1.0)),
    )
    straight = PdControllerGains(p=robot.stiffness, d=robot.damping)
    turning = PdControllerGains(p=robot.turning_stiffness, d=robot.turning_damping)
    for joint, gains in zip(joints, (straight, straight, turning), strict=True):
        added = plant.AddJoint(joint)
        plant.AddJointActuator(added.name(), added).set_controller_gains(gains)
    wrist = plant.AddJoint(WeldJoint("wrist", flange.body_frame(), part.body_frame(), RigidTransform()))
    return part, int(wrist.index())


class _Shapes:
    """Boxes and balls while they are registered."""

    def __init__(self, plant: MultibodyPlant, surfaces: Surfaces) -> None:
        self.plant, self.surfaces = plant, surfaces
        self.features: dict[Any, SimulatedFeature] = {}
        self.balls: list[Any] = []
        self.boxes: list[Any] = []

    def add(self, body: RigidBody, side: PlanarFeatures, moving: bool, pose: Vector) -> None:
        from pydrake.geometry import Box, Sphere  # noqa: PLC0415 - as above

        first = 0
        for polygon in side.polygons:
            shape, rows = Rectangle.of(polygon), tuple(range(first, first + len(polygon)))
            box = Box(*shape.sides, _THICK)
            at = (*_placed(shape.centre, pose), shape.angle + pose[2])
            self.boxes.append(self._register(body, box, at, SimulatedFeature(moving, None, rows)))
            for vertex, row in enumerate(rows):
                name = side.apex_names[row]
                if name is not None:
                    ball = Sphere(self.surfaces.radius)
                    centre = _placed(rounded(polygon, vertex, self.surfaces.radius), pose)
                    feature = SimulatedFeature(moving, name, (row,))
                    self.balls.append(self._register(body, ball, (*centre, 0.0), feature))
            first += len(polygon)

    def _register(self, body: RigidBody, shape: Any, at: tuple[float, ...], feature: SimulatedFeature) -> Any:
        from pydrake.math import RigidTransform, RotationMatrix  # noqa: PLC0415 - as above

        X_BG = RigidTransform(RotationMatrix.MakeZRotation(at[2]), _vector(at[0], at[1], 0.0))
        name = f"{'moving' if feature.moving else 'fixed'} {feature.apex or feature.rows[0]}"
        found = self.plant.RegisterCollisionGeometry(body, X_BG, shape, name, self._properties())
        self.features[found] = feature
        return found

    def _properties(self) -> Any:
        from pydrake.geometry import AddContactMaterial, ProximityProperties  # noqa: PLC0415 - as above
        from pydrake.multibody.plant import CoulombFriction  # noqa: PLC0415 - as above

        properties, surfaces = ProximityProperties(), self.surfaces
        # Drake puts the stiffnesses of two bodies in series
        AddContactMaterial(
            dissipation=surfaces.dissipation,
            point_stiffness=2 * surfaces.stiffness,
            friction=CoulombFriction(surfaces.friction, surfaces.friction),
            properties=properties,
        )
        return properties


def _placed(point: np.ndarray, pose: Vector) -> tuple[float, float]:
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return float(c * point[0] - s * point[1] + pose[0]), float(s * point[0] + c * point[1] + pose[1])


def _vector(*numbers: float) -> Any:
    """An array that Drake's stubs take, which want another kind."""
    return np.array(numbers, dtype=np.float64)
