"""Does a grasp that is called closed hold? Drake's dynamics, with gravity along six directions one after the other.

The hand's root rests. Its drives squeeze with forces that balance (`grasp.torques`), and hold their positions like
springs besides; joints that follow others are coupled. The part is a free rigid body, the hand is compliant, so that
contacts are patches (Drake's hydroelastic model, SAP solver). First it settles without gravity, then gravity pulls for
a while along each axis. The part is held if it hardly moves: how far it may, `Shake` says.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fixture_design.arrays import Weights
from fixture_design.geometry import PartGeometry
from fixture_design.geometry.distance import guarded, obj_text
from fixture_design.grasp.hand_model import HandModel
from fixture_design.grasp.model_text import model_text
from fixture_design.grasp.result import Grasp
from fixture_design.layout import Pose

#: Standard gravity [m/s^2].
_GRAVITY = 9.81

#: What part of the friction the squeeze uses, where it can, so that there is some left for the weight [-].
_FRICTION = (0.5, 0.8, 1.0)

#: Directions in which gravity pulls.
DIRECTIONS = np.vstack([np.eye(3), -np.eye(3)])


@dataclass(frozen=True)
class Shake:
    """How a grasp is shaken.

    Attributes:
        mass: of the part [kg].
        squeeze: what all fingers push with in all, in weights of the part [-], as far as the drives allow.
        settle, pull: how long it settles, and how long gravity pulls along each direction [s].
        step: of the simulation [s].
        stiffness: of the drives, and damping, of joints that turn [N m/rad, N m s/rad]; sliding ones have a thousand
            times as much [N/m].
        modulus: of the hand's skin [Pa].
        slip, turn: the part is held if it moves by no more than this [m, rad].
    """

    mass: float = 0.1
    squeeze: float = 30.0
    settle: float = 0.2
    pull: float = 0.6
    step: float = 2e-3
    stiffness: float = 20.0
    damping: float = 0.5
    modulus: float = 1e6
    slip: float = 0.01
    turn: float = 0.35


@dataclass(frozen=True, eq=False)
class Shaken:
    """How far the part moved [m] and turned [rad] under gravity along each of the `DIRECTIONS`; whether it was held."""

    moved: Weights
    turned: Weights
    held: tuple[bool, ...]

    @property
    def holds(self) -> bool:
        """Whether it was held in all directions."""
        return all(self.held)


def shaken(grasp: Grasp, geometry: PartGeometry, shake: Shake | None = None) -> Shaken | str:
    """What becomes of a grasp under gravity along six directions; or why its drives cannot squeeze.

    Args:
        geometry: of the part.

    Raises:
        GeometryError: Drake refuses the part or the hand.
    """
    shake = shake or Shake()
    model = grasp.posture.model
    total = shake.squeeze * shake.mass * _GRAVITY
    torques = next((t for share in _FRICTION if (t := grasp.drives(share).squeeze(total)) is not None), None)
    if torques is None:
        return "the drives have no squeeze that balances"
    world = guarded(lambda: _World.of(grasp, geometry, shake, torques), model.name)
    moved, turned = np.zeros(len(DIRECTIONS)), np.zeros(len(DIRECTIONS))
    for number, direction in enumerate(DIRECTIONS):
        moved[number], turned[number] = guarded(lambda way=direction: world.pulled(way, shake), model.name)
    held = tuple(bool(m <= shake.slip and t <= shake.turn) for m, t in zip(moved, turned, strict=True))
    return Shaken(moved, turned, held)


@dataclass(frozen=True, eq=False)
class _World:
    """The plant with hand and part, and where both begin."""

    plant: Any
    diagram: Any
    hand: Any
    body: Any
    model: HandModel
    q: Weights
    torques: Weights
    X_WP: Pose

    @classmethod
    def of(cls, grasp: Grasp, geometry: PartGeometry, shake: Shake, torques: Weights) -> _World:
        from pydrake.geometry import SceneGraphConfig
        from pydrake.math import RigidTransform, RotationMatrix
        from pydrake.multibody.parsing import Parser
        from pydrake.multibody.plant import (
            AddMultibodyPlantSceneGraph,
            ContactModel,
            DiscreteContactApproximation,
        )
        from pydrake.systems.framework import DiagramBuilder

        builder, part = DiagramBuilder(), grasp.layout.part
        assert part is not None  # grasps have one
        plant, scene = AddMultibodyPlantSceneGraph(builder, shake.step)
        plant.set_contact_model(ContactModel.kHydroelasticWithFallback)
        plant.set_discrete_contact_approximation(DiscreteContactApproximation.kSap)
        posture, frictions = grasp.posture, _frictions(grasp.posture.model)
        config = SceneGraphConfig()
        properties = config.default_proximity_properties
        properties.compliance_type, properties.hydroelastic_modulus = "compliant", shake.modulus
        properties.resolution_hint = 0.005
        scene.set_config(config)
        make: Any = RigidTransform
        turn: Any = RotationMatrix
        with tempfile.TemporaryDirectory() as folder:
            text = model_text(posture.model.hand.model, Path(folder), dynamic=True)
            (hand,) = Parser(plant).AddModels(text.file)
            _rub(plant, scene, hand, frictions, posture.model.hand.friction)
            body = _add_part(
                plant, geometry, shake, max(posture.model.hand.friction, *frictions.values()), Path(folder)
            )
            base = _root(plant, hand)
            X_WH = make(turn(posture.X_WH.rotation), posture.X_WH.translation)
            plant.WeldFrames(plant.world_frame(), base.body_frame(), X_WH)
            plant.set_gravity_enabled(hand, False)
            _drive(plant, posture.model, shake)
            plant.Finalize()
            diagram = builder.Build()
            diagram.CreateDefaultContext()
        return cls(plant, diagram, hand, body, posture.model, posture.q, torques, part.pose)

    def pulled(self, direction: np.ndarray, shake: Shake) -> tuple[float, float]:
        """How far the part moves and turns after it has settled, while gravity pulls along a direction."""
        from pydrake.math import RigidTransform, RotationMatrix
        from pydrake.systems.analysis import Simulator

        make: Any = RigidTransform
        turn: Any = RotationMatrix
        context = self.diagram.CreateDefaultContext()
        mine = self.plant.GetMyMutableContextFromRoot(context)
        places = [self.plant.GetJointByName(joint.name).position_start() for joint in self.model.joints]
        start = np.array(self.plant.GetPositions(mine))
        start[places] = self.q
        self.plant.SetPositions(mine, start)
        self.plant.SetFreeBodyPose(mine, self.body, make(turn(self.X_WP.rotation), self.X_WP.translation))
        wanted = self.q[self.model.free]
        self.plant.get_desired_state_input_port(self.hand).FixValue(mine, np.append(wanted, np.zeros(len(wanted))))
        self.plant.get_actuation_input_port(self.hand).FixValue(mine, self.torques)
        field = self.plant.mutable_gravity_field()
        field.set_gravity_vector(np.zeros(3))
        simulator: Any = Simulator(self.diagram, context)
        simulator.AdvanceTo(shake.settle)
        before = self.plant.EvalBodyPoseInWorld(mine, self.body)
        field.set_gravity_vector(_GRAVITY * direction)
        simulator.AdvanceTo(shake.settle + shake.pull)
        after = self.plant.EvalBodyPoseInWorld(mine, self.body)
        center = before.translation()
        turned = before.rotation().inverse().multiply(after.rotation()).ToAngleAxis().angle()
        return float(np.linalg.norm(after.translation() - center)), float(abs(turned))


def _frictions(model: HandModel) -> dict[str, float]:
    """The coefficient of each link with fingertips; the least of them where they differ."""
    found: dict[str, float] = {}
    for tip in model.fingertips:
        friction = model.hand.friction if tip.friction is None else tip.friction
        found[tip.link] = min(friction, found.get(tip.link, friction))
    return found


def _rub(plant: Any, scene: Any, hand: Any, frictions: Mapping[str, float], usual: float) -> None:
    """Gives the hand's shapes the friction with which Drake combines to that of the layout's contacts.

    Drake's parser gives every shape a coefficient of its own, which defaults of the scene do not replace, and combines
    two of them, a of a shape and m of the part, to 2 a m / (a + m). With m the largest of all, a = f m / (2 m - f)
    makes that f.
    """
    from pydrake.geometry import RoleAssign
    from pydrake.multibody.plant import CoulombFriction

    most = max(usual, *frictions.values())
    inspector = scene.model_inspector()
    for index in plant.GetBodyIndices(hand):
        body = plant.get_body(index)
        wanted = frictions.get(body.name(), usual)
        own = wanted * most / (2 * most - wanted) if most else 0.0
        for shape in plant.GetCollisionGeometriesForBody(body):
            properties = inspector.GetProximityProperties(shape)
            properties.UpdateProperty("material", "coulomb_friction", CoulombFriction(own, own))
            scene.AssignRole(plant.get_source_id(), shape, properties, RoleAssign.kReplace)


def _root(plant: Any, hand: Any) -> Any:
    joints = [plant.get_joint(index) for index in plant.GetJointIndices(hand)]
    children = {joint.child_body().index() for joint in joints}
    bodies = [plant.get_body(index) for index in plant.GetBodyIndices(hand)]
    return next(body for body in bodies if body.index() not in children)


def _add_part(plant: Any, geometry: PartGeometry, shake: Shake, friction: float, folder: Path) -> Any:
    """The part as a rigid body: its true surface, the inertia of its box."""
    from pydrake.geometry import AddContactMaterial, AddRigidHydroelasticProperties, Mesh, ProximityProperties
    from pydrake.math import RigidTransform
    from pydrake.multibody.plant import CoulombFriction
    from pydrake.multibody.tree import SpatialInertia, UnitInertia

    file = folder / "the_part.obj"
    file.write_text(obj_text(geometry.vertices, geometry.triangles), encoding="ascii")
    sides = geometry.high - geometry.low
    unit: Any = UnitInertia
    inertia: Any = SpatialInertia
    about = unit.SolidBox(*sides.tolist()).ShiftFromCenterOfMass(geometry.box_center)
    instance = plant.AddModelInstance("part of this grasp")
    body = plant.AddRigidBody("part", instance, inertia(shake.mass, geometry.box_center, about))
    properties: Any = ProximityProperties()
    AddRigidHydroelasticProperties(properties)
    AddContactMaterial(properties=properties, friction=CoulombFriction(friction, friction))
    plant.RegisterCollisionGeometry(body, RigidTransform(), Mesh(file, 1.0), "part", properties)
    return body


def _drive(plant: Any, model: HandModel, shake: Shake) -> None:
    """Drives at the joints that move on their own, and couplings of those that follow."""
    from pydrake.multibody.tree import PdControllerGains

    for joint in model.joints:
        found = plant.GetJointByName(joint.name)
        if joint.follows is not None:
            other = plant.GetJointByName(joint.follows)
            plant.AddCouplerConstraint(found, other, joint.multiplier, joint.offset)
            continue
        for actuator in _actuators(plant, found):
            plant.RemoveJointActuator(actuator)
        actuator = plant.AddJointActuator(f"drive of {joint.name}", found)
        factor = 1000.0 if joint.kind == "prismatic" else 1.0
        gains = PdControllerGains(p=factor * shake.stiffness, d=factor * shake.damping)
        actuator.set_controller_gains(gains)
    for joint in model.joints:
        if joint.follows is not None:
            for actuator in _actuators(plant, plant.GetJointByName(joint.name)):
                plant.RemoveJointActuator(actuator)


def _actuators(plant: Any, joint: Any) -> list[Any]:
    found = [plant.get_joint_actuator(index) for index in plant.GetJointActuatorIndices()]
    return [actuator for actuator in found if actuator.joint().index() == joint.index()]
