"""What hands make of parts, and grasps whose answers are known by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fixture_design.contacts import Contact
from fixture_design.grasp import HandModel, Posture, grasp_at, load_hand, posed
from fixture_design.grasp.touching import touching
from fixture_design.io import read_layout, write_layout
from fixture_design.layout import Answer, Element, Layout, LineTip, PadTip, Part, PointTip, Pose, SoftTip, SphereTip
from fixture_design.verification import verify
from tests.grasp.hands import JAW, at, model_of, primitive

#: The pads' middles are here when the gripper is straight below the origin.
BELOW = at(0, 0, -0.115)


def _jaw(**changes):
    """The gripper with its fingertips changed."""
    model = model_of(JAW)
    return replace(model, fingertips=tuple(replace(tip, **changes) for tip in model.fingertips))


def _closed(layout: Layout) -> Answer | None:
    return verify(layout, sets=False).groups["all"].findings["force_closure"].answer


@pytest.mark.parametrize(
    ("changes", "tip", "closed"),
    [
        ({}, PadTip, Answer.YES),
        ({"pad": None, "along": None}, SoftTip, Answer.YES),
        ({"pad": None, "along": None, "soft": None}, PointTip, Answer.NO),
        ({"friction": 0.0}, PadTip, Answer.NO),
    ],
)
def test_a_box_between_jaws(changes, tip, closed):
    """Hard points leave the spin about the line between them; pads and soft skin hold it; nothing without friction."""
    part, geometry = primitive("cube")
    model = _jaw(**changes)
    found = touching(Posture(model, model.positions({"left_joint": 0.03}), BELOW), part, geometry)
    assert [type(element.tip) for element in found.layout.elements] == [tip, tip]
    assert not found.overlaps
    assert _closed(found.layout) is closed


def test_pads_are_lines_on_a_cylinder_along_it_and_points_on_a_sphere():
    for name, tip, opening in (("cylinder", LineTip, 0.02), ("sphere", SoftTip, 0.03)):
        part, geometry = primitive(name)
        model = _jaw()
        found = touching(Posture(model, model.positions({"left_joint": opening}), BELOW), part, geometry)
        assert [type(element.tip) for element in found.layout.elements] == [tip, tip]
        assert _closed(found.layout) is Answer.YES


def test_nothing_touches_in_the_air_and_what_is_inside_is_said():
    part, geometry = primitive("cube")
    model = _jaw()
    assert not touching(Posture(model, model.positions({"left_joint": 0.04}), BELOW), part, geometry).layout.elements
    found = touching(Posture(model, model.positions({"left_joint": 0.028}), BELOW), part, geometry)
    assert found.overlaps["left"] == pytest.approx(0.002, abs=1e-9)


def test_a_palm_that_touches_counts():
    """The gripper's body is at 60 mm: a cube that rests on it has contacts there, in the names of the link."""
    part, geometry = primitive("cube")
    model = _jaw()
    found = touching(Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -0.09)), part, geometry)
    assert {found.links[contact.name] for contact in found.layout.contacts} == {"body"}
    np.testing.assert_allclose([contact.point[2] for contact in found.layout.contacts], -0.03, atol=1e-9)


def _second_box(tmp_path):
    """The gripper with a box on its left pad that is in a part between the jaws."""
    urdf = tmp_path / "lumpy.urdf"
    lump = '<collision><origin xyz="0.01 0 0.025"/><geometry><box size="0.02 0.01 0.01"/></geometry></collision>'
    text = JAW.read_text()
    link = text.index('<link name="left_pad">') + len('<link name="left_pad">')
    urdf.write_text(text[:link] + lump + text[link:])
    return load_hand(replace(model_of(JAW).hand, model=urdf))


def test_a_link_whose_tip_touches_may_be_in_the_part_with_the_rest(tmp_path):
    part, geometry = primitive("cube")
    model = _second_box(tmp_path)
    posture = Posture(model, model.positions({"left_joint": 0.03}), BELOW)
    found = touching(posture, part, geometry)
    assert {element.name for element in found.layout.elements} == {"left", "right"}
    assert found.overlaps == {"left_pad": pytest.approx(0.01)}
    answer = posed(posture, part, geometry)
    assert answer.satisfied is Answer.NO
    assert "left_pad is 10 mm inside the part" in (answer.reason or "")


def test_a_hand_that_runs_into_itself_is_not_said_to_close(monkeypatch):
    part, geometry = primitive("cube")
    model = model_of(JAW)
    posture = Posture(model, model.positions({"left_joint": 0.03}), BELOW)
    assert posed(posture, part, geometry).satisfied is Answer.YES
    monkeypatch.setattr(HandModel, "collides_with_itself", lambda self, q: ("body", "left_pad"))
    answer = posed(posture, part, geometry)
    assert answer.satisfied is Answer.UNDECIDED
    assert "body and left_pad" in (answer.reason or "")


def test_hulls_prove_nothing():
    """A hull is fatter than the link: that it is in the part does not say that the link is."""
    part, geometry = primitive("cube")
    model = model_of(JAW)
    links = {**model.links, "body": replace(model.links["body"], notes=("its convex hull is used",))}
    posture = Posture(replace(model, links=links), model.positions({"left_joint": 0.03}), at(0, 0, -0.08))
    answer = posed(posture, part, geometry)
    assert answer.satisfied is Answer.UNDECIDED
    assert "body is 10 mm inside" in (answer.reason or "")


def test_a_tilted_pad_holds_nothing():
    part, geometry = primitive("cube")
    model = _jaw()
    pose = Pose.from_xyz_rpy([0, 0, 0], [0, 0.1, 0])
    turned = Pose(pose.rotation, pose.rotation @ BELOW.translation)
    found = touching(Posture(model, model.positions({"left_joint": 0.03}), turned), part, geometry, gap=2e-3)
    assert not found.layout.elements
    assert any("past the surface" in note for note in found.notes)


def test_the_layout_file_gives_the_same_verdict(tmp_path):
    part, geometry = primitive("cube")
    model = _jaw()
    found = touching(Posture(model, model.positions({"left_joint": 0.03}), at(0, 0, -0.09)), part, geometry)
    write_layout(found.layout, tmp_path / "grasp.yaml")
    again = read_layout(tmp_path / "grasp.yaml")
    ours, theirs = verify(found.layout, sets=False), verify(again, sets=False)
    assert theirs.satisfied is ours.satisfied is Answer.YES
    assert len(theirs.contacts) == len(ours.contacts)
    margins = [v.groups["all"].findings["force_closure"].margin for v in (ours, theirs)]
    assert margins[0] == pytest.approx(margins[1])


@pytest.mark.parametrize(("friction", "closed"), [(0.0, Answer.NO), (0.3, Answer.NO), (0.7, Answer.YES)])
def test_a_sphere_in_three_fingers(friction, closed):
    """On a great circle, 120 degrees apart, forces in its plane balance with any friction, but those of hard points at
    30 degrees to the sides must also reach each other: all three cones do, whatever the coefficient > 0. Below the
    equator, by 20 degrees, the cones must reach back up: tan(20 degrees) = 0.364.
    """
    part, _ = primitive("sphere")
    low = np.radians(-20.0)
    directions = [
        np.array([np.cos(low) * np.cos(angle), np.cos(low) * np.sin(angle), np.sin(low)])
        for angle in 2 * np.pi * np.arange(3) / 3
    ]
    elements = tuple(
        Element(f"F{k}", "finger", 0.03 * direction, SphereTip(0.01)) for k, direction in enumerate(directions)
    )
    assert _closed(Layout("ball", part=part, friction=friction, elements=elements, surface_gap=1e-4)) is closed


@pytest.mark.parametrize(("friction", "closed"), [(0.0, Answer.NO), (0.2, Answer.YES)])
def test_a_square_between_two_fingers_in_the_plane(friction, closed):
    """Two hard points hold a planar part with any friction: there is no spin about the line between them."""
    square = Part("square", "polygon", None, np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]]), 1.0, Pose.identity(2))
    elements = (Element("A", "finger", np.array([1.0, 0])), Element("B", "finger", np.array([-1.0, 0])))
    assert _closed(Layout("square", "planar", square, friction=friction, elements=elements)) is closed


@pytest.mark.parametrize(("friction", "closed"), [(0.0, Answer.NO), (0.1, Answer.YES)])
def test_a_disc_in_three_fingers_in_the_plane(friction, closed):
    """Frictionless fingers never stop a disc from turning."""
    angles = 2 * np.pi * np.arange(3) / 3
    contacts = tuple(
        Contact.on_facet(f"F{k}", "finger", [np.cos(a), np.sin(a)], [np.cos(a), np.sin(a)], friction)
        for k, a in enumerate(angles)
    )
    assert _closed(Layout("disc", "planar", contacts=contacts)) is closed


def test_jaws_hold_a_weight_as_their_drive_and_friction_allow():
    """80 N on the drive of two coupled jaws are 40 N each; with friction 0.5 both carry 40 N upwards."""
    part, geometry = primitive("cube")
    model = model_of(JAW)
    posture = Posture(model, model.positions({"left_joint": 0.03}), BELOW)
    found = grasp_at(posture, part, geometry, np.array([0.0, 0, -10, 0, 0, 0]))
    assert found.closed is Answer.YES
    assert found.quality.least_weight == pytest.approx(1.0)
    assert found.weakest is not None
    assert found.weakest.force <= 40 + 1e-6
    assert found.held is not None
    assert found.held.torques["left_joint"] == pytest.approx(-20.0)
    assert sum(found.held.forces.values(), np.zeros(3))[2] == pytest.approx(10.0)
    heavy = grasp_at(posture, part, geometry, np.array([0.0, 0, -41, 0, 0, 0]))
    assert heavy.held is None
