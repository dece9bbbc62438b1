"""A hand that can be moved: where its links are for given joint positions, what they are made of, how they move.

H is the frame of the hand's root link. Joint positions are arrays in the order of `HandModel.joints`; joints that
follow others are among them, and `HandModel.completed` gives them theirs.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Mask, Point, Weights, read_only
from fixture_design.errors import GeometryError, UnknownNameError
from fixture_design.geometry.distance import guarded
from fixture_design.grasp.couplings import uncoupled_jaws
from fixture_design.grasp.hand import Fingertip, Hand, HandError, Joint, JointRule
from fixture_design.grasp.link_geometry import LinkGeometry, link_geometry
from fixture_design.grasp.model_text import ModelText, model_text
from fixture_design.layout import Pose
from fixture_design.tolerances import JOINT_SLACK

#: What a joint without limits is taken to do, a full turn or a metre, either way.
_UNLIMITED = {"revolute": math.pi, "prismatic": 1.0}

#: Links that overlap in this part of random configurations do so by construction [-], and by how much they may [m].
_ALWAYS, _GRAZE = 0.9, 1e-3

#: Random configurations looked at for that.
_LOOKED_AT = 40


@dataclass(frozen=True, eq=False)
class HandModel:
    """A hand loaded into Drake; made by `load_hand`.

    Attributes:
        hand: what it was made of.
        joints: all movable ones, in Drake's order.
        fingertips: the hand's, or those that were guessed.
        links: those that are made of something, by name.
        notes: for people.
    """

    hand: Hand
    joints: tuple[Joint, ...]
    fingertips: tuple[Fingertip, ...]
    links: Mapping[str, LinkGeometry]
    notes: tuple[str, ...]
    _plant: Any
    _diagram: Any
    _context: Any

    @property
    def name(self) -> str:
        return self.hand.name

    @cached_property
    def lower(self) -> Weights:
        return read_only([joint.lower for joint in self.joints])

    @cached_property
    def upper(self) -> Weights:
        return read_only([joint.upper for joint in self.joints])

    @cached_property
    def free(self) -> Indices:
        """Numbers of the joints that move on their own."""
        return np.array([number for number, joint in enumerate(self.joints) if joint.follows is None], dtype=np.int64)

    @cached_property
    def following(self) -> tuple[Float[np.ndarray, "j f"], Weights]:
        """M and o of  q = M q_free + o: joints that follow others, in chains if need be."""
        numbers = {joint.name: number for number, joint in enumerate(self.joints)}
        columns = {int(number): column for column, number in enumerate(self.free)}
        matrix, offset = np.zeros((len(self.joints), len(self.free))), np.zeros(len(self.joints))
        for number in range(len(self.joints)):
            at, factor, shift = number, 1.0, 0.0
            for _ in self.joints:
                joint = self.joints[at]
                if joint.follows is None:
                    break
                factor, shift, at = factor * joint.multiplier, shift + factor * joint.offset, numbers[joint.follows]
            matrix[number, columns[at]], offset[number] = factor, shift
        return read_only(matrix), read_only(offset)

    def completed(self, free: Weights) -> Weights:
        """All positions, from those of the joints that move on their own."""
        matrix, offset = self.following
        return matrix @ free + offset

    def positions(self, given: Mapping[str, float]) -> Weights:
        """Positions by joint name as an array; joints that are not given are in the middle, or follow.

        Raises:
            UnknownNameError: there is no such joint.
            HandError: a position outside of its range, or of a joint that follows another.
        """
        numbers = {joint.name: number for number, joint in enumerate(self.joints)}
        q, file = self.middle.copy(), self.hand.source or self.hand.model
        for name, value in given.items():
            if name not in numbers:
                raise UnknownNameError("joint", name, numbers, source=file)
            joint = self.joints[numbers[name]]
            if joint.follows is not None:
                problem = f"joint {name!r} follows {joint.follows!r}, and cannot be set"
                expected = "positions of joints that move on their own"
                raise HandError(problem, source=file, found=f"{value:g}", expected=expected)
            if not joint.lower - JOINT_SLACK <= value <= joint.upper + JOINT_SLACK:
                found, expected = f"{value:g}", f"from {joint.lower:g} to {joint.upper:g}"
                raise HandError(f"joint {name!r} does not go there", source=file, found=found, expected=expected)
            q[numbers[name]] = value
        return self.completed(q[self.free])

    @cached_property
    def middle(self) -> Weights:
        """All joints in the middle of their ranges, as far as they move on their own."""
        return self.completed(((self.lower + self.upper) / 2)[self.free])

    def random(self, count: int, rng: np.random.Generator) -> Float[np.ndarray, "n j"]:
        """Random positions; joints that follow may be out of their own range and are then not given."""
        low, high = self.lower[self.free], self.upper[self.free]
        drawn = low + (high - low) * rng.random((count, len(self.free)))
        q = drawn @ self.following[0].T + self.following[1]
        return q[self.within(q)]

    def within(self, q: Float[np.ndarray, "n j"]) -> Mask:
        """Which positions are within all ranges, but for rounding."""
        return np.all((q >= self.lower - JOINT_SLACK) & (q <= self.upper + JOINT_SLACK), axis=1)

    def poses(self, q: Weights) -> dict[str, Pose]:
        """X_HL of every link that is made of something or has a fingertip."""
        self._plant.SetPositions(self._context, np.asarray(q, dtype=np.float64))
        names = {*self.links, *(tip.link for tip in self.fingertips)}
        return {name: self._pose(name) for name in names}

    def tips(self, q: Weights) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3"]]:
        """Where the fingertips are and which way they look, in H."""
        poses = self.poses(q)
        at = [poses[tip.link].points(tip.at[None])[0] for tip in self.fingertips]
        facing = [poses[tip.link].vectors(tip.facing[None])[0] for tip in self.fingertips]
        return np.array(at).reshape(-1, 3), np.array(facing).reshape(-1, 3)

    def jacobian(self, q: Weights, link: str, p_LC: Point) -> Float[np.ndarray, "3 f"]:
        """dp_HC / dq of a point C that is fixed to a link, for the joints that move on their own [m/rad or 1]."""
        from pydrake.multibody.tree import JacobianWrtVariable

        self._plant.SetPositions(self._context, np.asarray(q, dtype=np.float64))
        frame, world = self._plant.GetBodyByName(link).body_frame(), self._plant.world_frame()
        by = JacobianWrtVariable.kQDot
        full = self._plant.CalcJacobianTranslationalVelocity(self._context, by, frame, p_LC, world, world)
        return full @ self.following[0]

    def spin_jacobian(self, q: Weights, link: str) -> Float[np.ndarray, "3 f"]:
        """The angular velocity of a link in H for each joint that moves on its own [1 or rad/m]."""
        from pydrake.multibody.tree import JacobianWrtVariable

        self._plant.SetPositions(self._context, np.asarray(q, dtype=np.float64))
        frame, world = self._plant.GetBodyByName(link).body_frame(), self._plant.world_frame()
        full = self._plant.CalcJacobianAngularVelocity(self._context, JacobianWrtVariable.kQDot, frame, world, world)
        return full @ self.following[0]

    @cached_property
    def efforts(self) -> Weights:
        """Largest torque or force of each joint that moves on its own; inf where nobody gives one."""
        return read_only([self.joints[number].effort for number in self.free.tolist()])

    def collides_with_itself(self, q: Weights) -> tuple[str, str] | None:
        """Two links of which one is in the other; None if there are none. Meshes count as their hulls here."""
        for pair in self._overlaps(q):
            if pair not in self._by_construction:
                return pair
        return None

    @cached_property
    def _by_construction(self) -> frozenset[tuple[str, str]]:
        """Pairs of links that overlap nearly always: hulls are fatter than links."""
        drawn = self.random(4 * _LOOKED_AT, np.random.default_rng(0))[:_LOOKED_AT]
        counts: dict[tuple[str, str], int] = {}
        for q in drawn:
            for pair in self._overlaps(q):
                counts[pair] = counts.get(pair, 0) + 1
        return frozenset(pair for pair, count in counts.items() if count >= _ALWAYS * max(len(drawn), 1))

    def _overlaps(self, q: Weights) -> set[tuple[str, str]]:
        self._plant.SetPositions(self._context, np.asarray(q, dtype=np.float64))
        query = self._plant.get_geometry_query_input_port().Eval(self._context)
        inspector, found = query.inspector(), set()
        for hit in guarded(query.ComputePointPairPenetration, self.name):
            if hit.depth > _GRAZE:
                frames = (inspector.GetFrameId(hit.id_A), inspector.GetFrameId(hit.id_B))
                names = sorted(self._plant.GetBodyFromFrameId(frame).name() for frame in frames)
                found.add((names[0], names[1]))
        return found

    def _pose(self, link: str) -> Pose:
        X_HL = self._plant.EvalBodyPoseInWorld(self._context, self._plant.GetBodyByName(link))
        return Pose(read_only(X_HL.rotation().matrix()), read_only(X_HL.translation()))


def load_hand(hand: Hand) -> HandModel:
    """The hand in Drake, its joints and links checked against what its sidecar says.

    Raises:
        HandError: Drake refuses the model; it is not one tree; it has no movable joint; joints follow each other in a
            circle.
        UnknownNameError: a joint or link that the hand file names is not there.
        FileFormatError, UnsupportedError: of the model's files, see `model_text`.
    """
    with tempfile.TemporaryDirectory() as folder:
        text = model_text(hand.model, Path(folder))
        try:
            plant, diagram, drake_joints = guarded(lambda: built_plant(text), hand.name)
        except GeometryError as error:
            raise HandError("Drake does not take this hand", source=hand.model, found=error.found) from error
        links = _links(plant, diagram, text, hand.model)
    joints = _joints(hand, drake_joints, text)
    if not joints:
        raise HandError("nothing of this hand moves", source=hand.model, expected="a revolute or prismatic joint")
    context = diagram.CreateDefaultContext()
    notes = tuple(note for link in links.values() for note in link.notes)
    unlimited = [joint.name for joint in joints if joint.follows is None and math.isinf(joint.effort)]
    if unlimited:
        notes = (*notes, f"no effort limit is given for {', '.join(unlimited)}: taken as strong as needed")
    model = HandModel(
        hand, joints, hand.fingertips, links, notes, plant, diagram, plant.GetMyMutableContextFromRoot(context)
    )
    _check_links(model)
    if not hand.fingertips:
        from fixture_design.grasp.guessed_tips import guessed_tips

        tips, said = guessed_tips(model)
        model = replace(model, fingertips=tips, notes=(*notes, *said))
    jaws = uncoupled_jaws(joints, model.fingertips)
    return replace(model, notes=(*model.notes, jaws)) if jaws else model


def built_plant(text: ModelText, beside: str | None = None) -> tuple[Any, Any, list[Any]]:
    """The plant with its root link welded to the world, its diagram, and its movable joints.

    Args:
        beside: the name of a free body that is to be there, too.
    """
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
    from pydrake.systems.framework import DiagramBuilder

    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
    models = Parser(plant).AddModels(text.file)
    if len(models) != 1:
        raise RuntimeError(f"the file holds {len(models)} models, not one")
    joints = [plant.get_joint(index) for index in plant.GetJointIndices(models[0])]
    children = {joint.child_body().name() for joint in joints}
    names = [plant.get_body(index).name() for index in plant.GetBodyIndices(models[0])]
    roots = [name for name in names if name not in children]
    if len(roots) > 1:
        raise RuntimeError(f"the links do not form one tree: {', '.join(roots)} are nobody's child")
    if roots:
        plant.WeldFrames(plant.world_frame(), plant.GetBodyByName(roots[0], models[0]).body_frame())
    if beside is not None:
        from pydrake.multibody.tree import SpatialInertia, default_model_instance

        plant.AddRigidBody(beside, default_model_instance(), SpatialInertia.SolidSphereWithMass(1.0, 0.1))
    plant.Finalize()
    return plant, builder.Build(), [joint for joint in joints if joint.num_positions()]


def _links(plant: Any, diagram: Any, text: ModelText, file: Path) -> dict[str, LinkGeometry]:
    inspector = diagram.GetSubsystemByName("scene_graph").model_inspector()
    found = {}
    for name in sorted(plant.get_body(index).name() for index in _bodies(plant)):
        shapes = plant.GetCollisionGeometriesForBody(plant.GetBodyByName(name))
        geometry = link_geometry(name, list(shapes), inspector, text.meshes, file)
        if geometry is not None:
            found[name] = geometry
    return found


def _bodies(plant: Any) -> list[Any]:
    from pydrake.multibody.tree import BodyIndex

    return [BodyIndex(number) for number in range(1, plant.num_bodies())]


def _joints(hand: Hand, found: Sequence[Any], text: ModelText) -> tuple[Joint, ...]:
    """Every movable joint with the file's rules, and the sidecar's before them."""
    names = [joint.name() for joint in found]
    for name in hand.joints:
        if name not in names:
            raise UnknownNameError("movable joint", name, names, source=hand.source)
    order = sorted(found, key=lambda joint: joint.position_start())
    joints = tuple(_joint(joint, text.rules.get(joint.name()), hand.joints.get(joint.name()), hand) for joint in order)
    _check_following(joints, hand)
    return joints


def _joint(found: Any, of_file: JointRule | None, of_sidecar: JointRule | None, hand: Hand) -> Joint:
    kind = found.type_name()
    if kind not in _UNLIMITED:
        expected = "revolute, prismatic and fixed joints"
        place, problem = f"joint {found.name()!r}", "a joint of a kind that hands do not have here"
        raise HandError(problem, source=hand.model, place=place, found=kind, expected=expected)
    most = _UNLIMITED[kind]
    low, high = float(found.position_lower_limits()[0]), float(found.position_upper_limits()[0])
    low, high = (low if math.isfinite(low) else -most), (high if math.isfinite(high) else most)
    given, said = of_file or JointRule(), of_sidecar or JointRule()
    by = said if said.follows is not None else given
    effort = said.effort or given.effort
    low, high = (low if said.lower is None else said.lower), (high if said.upper is None else said.upper)
    if low > high:
        raise HandError(f"joint {found.name()!r} has no range", source=hand.source, found=f"from {low:g} to {high:g}")
    return Joint(
        found.name(), kind, low, high, math.inf if effort is None else effort, by.follows, by.multiplier, by.offset
    )


def _check_following(joints: Sequence[Joint], hand: Hand) -> None:
    by_name = {joint.name: joint for joint in joints}
    for joint in joints:
        at, steps = joint, 0
        while at.follows is not None:
            if at.follows not in by_name:
                raise UnknownNameError("movable joint", at.follows, by_name, source=hand.source or hand.model)
            at, steps = by_name[at.follows], steps + 1
            if steps > len(joints):
                raise HandError(
                    "joints follow each other in a circle", source=hand.source or hand.model, found=joint.name
                )


def _check_links(model: HandModel) -> None:
    plant = model._plant
    names = [plant.get_body(index).name() for index in _bodies(plant)]
    for tip in model.hand.fingertips:
        if tip.link not in names:
            place = f"fingertip {tip.name!r}"
            raise UnknownNameError("link", tip.link, names, source=model.hand.source, place=place)
