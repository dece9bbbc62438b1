"""From a hand's files to a `HandModel`: Drake's plant, the joints' rules, links, and fingertips given or guessed."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from fixture_design.errors import GeometryError, UnknownNameError
from fixture_design.geometry.distance import guarded
from fixture_design.grasp.couplings import uncoupled_jaws
from fixture_design.grasp.hand import Hand, HandError, Joint, JointRule
from fixture_design.grasp.hand_model import HandModel
from fixture_design.grasp.link_geometry import LinkGeometry, link_geometry
from fixture_design.grasp.model_text import ModelText, model_text

#: What a joint without limits is taken to do, a full turn or a metre, either way.
_UNLIMITED = {"revolute": math.pi, "prismatic": 1.0}


def load_hand(hand: Hand) -> HandModel:
    """The hand in Drake, its joints and links checked against what its sidecar says.

    Raises:
        HandError: Drake refuses the model; it is not one tree; it has no movable joint; joints follow each other in a
            circle; a fingertip is off its link, or looks into it.
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
    if hand.fingertips:
        from fixture_design.grasp.tip_checks import check_tips

        model = replace(model, notes=(*notes, *check_tips(model)))
    else:
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
    unlimited = not (math.isfinite(low) or math.isfinite(high))
    low, high = (low if math.isfinite(low) else -most), (high if math.isfinite(high) else most)
    given, said = of_file or JointRule(), of_sidecar or JointRule()
    by = said if said.follows is not None else given
    effort = said.effort or given.effort
    unlimited = unlimited and said.lower is None and said.upper is None
    low, high = (low if said.lower is None else said.lower), (high if said.upper is None else said.upper)
    if low > high:
        raise HandError(f"joint {found.name()!r} has no range", source=hand.source, found=f"from {low:g} to {high:g}")
    return Joint(
        found.name(),
        kind,
        low,
        high,
        math.inf if effort is None else effort,
        by.follows,
        by.multiplier,
        by.offset,
        unlimited,
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
