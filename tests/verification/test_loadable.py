"""Loadable: contacts alone, real parts, pins, overhangs, bodies in the way, and a checker that is not fooled."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter

from fixture_design.contacts import Contact, Provenance, Role
from fixture_design.errors import InputError
from fixture_design.io import read_layout
from fixture_design.io.verdict_record import verdict_to_dict
from fixture_design.io.verdict_schema import VerdictRecord
from fixture_design.layout import (
    Answer,
    Body,
    Element,
    Finding,
    Layout,
    LineTip,
    Obstacle,
    PadTip,
    Part,
    PinTip,
    PointTip,
    Pose,
    SphereTip,
    StraightWays,
    Tip,
    Verdict,
)
from fixture_design.verification import check, verify
from fixture_design.verification.loading_proofs import loadable_fault
from tests.geometry.parts import Mesh, box, circle, l_shape, polygon_part, prism, shared, write

REPOSITORY = Path(__file__).resolve().parents[2]
BRACKET = REPOSITORY / "urdf" / "bracket" / "bracket.layout.yaml"
X, Y, Z = np.eye(3)
MM = 1e-3
VERDICTS = TypeAdapter(VerdictRecord)
LOADABLE = {"locators": ("loadable",), "all": ("loadable",)}


def judged(layout: Layout) -> Verdict:
    verdict = verify(replace(layout, require=LOADABLE))
    assert check(verdict) == []
    VERDICTS.validate_json(json.dumps(verdict_to_dict(verdict)))
    return verdict


def finding(layout: Layout, group: str = "locators") -> Finding:
    return judged(layout).groups[group].findings["loadable"]


def ways_of(found: Finding) -> StraightWays:
    assert isinstance(found.use, StraightWays)
    return found.use


def walls(*normals: Sequence[float], space: str = "spatial") -> Layout:
    contacts = [
        Contact.on_facet(f"C{k}", "locator", 0.1 * k * np.ones(len(n)), n) for k, n in enumerate(normals, start=1)
    ]
    return Layout("walls", space, contacts=tuple(contacts))  # type: ignore[arg-type]


def element(name: str, at: Sequence[float], tip: Tip | None = None, role: Role = "locator", **more: object) -> Element:
    return Element(name, role, np.array(at, dtype=float), tip or PointTip(), **more)  # type: ignore[arg-type]


def mesh_part(folder: Path, mesh: Mesh, pose: Pose | None = None) -> Part:
    return Part("part", "mesh", write(folder, mesh), None, 1.0, pose or Pose.identity(3))


def mesh_body(folder: Path, name: str, mesh: Mesh, role: Role = "locator", at: Sequence[float] = (0, 0, 0)) -> Body:
    write(folder, mesh, f"{name}.obj")
    geometry = f'<geometry><mesh filename="{name}.obj"/></geometry>'
    urdf = folder / f"{name}.urdf"
    urdf.write_text(f'<robot name="{name}"><link name="l"><collision>{geometry}</collision></link></robot>')
    return Body(name, role, urdf, Pose.from_xyz_rpy(at, [0, 0, 0]))


# --- contacts alone ---------------------------------------------------------------------------------------------------


def test_three_two_one() -> None:
    found = finding(walls(-Z, -Z, -Z, -Y, -Y, -X))
    assert found.answer is Answer.YES
    ways = ways_of(found)
    np.testing.assert_allclose(ways.direction, np.ones(3) / np.sqrt(3))
    assert found.margin == pytest.approx(1 / np.sqrt(3))
    assert ways.length is None
    assert ways.against == ways.slides == ways.open == ()


def test_a_slot_and_a_bore_slide_and_say_so() -> None:
    slot = finding(walls(-Z, Y, -Y))
    assert slot.answer is Answer.YES
    assert ways_of(slot).slides == ("C2", "C3")
    assert slot.margin == 0.0
    bore = finding(walls(X, -X, Y, -Y))
    assert bore.answer is Answer.YES
    assert len(ways_of(bore).slides) == 4


def test_closed_on_all_sides() -> None:
    found = finding(walls(X, -X, Y, -Y, Z, -Z))
    assert found.answer is Answer.NO
    assert ways_of(found).direction is None
    assert ways_of(found).weights is not None


def test_clamps_and_supports_are_open_and_named() -> None:
    layout = walls(-Z, Y, -Y)
    clamp = Contact.on_facet("K1", "clamp", [0, 0, 1.0], Z)
    support = Contact.on_facet("S1", "support", [0, 0, 2.0], Z)
    found = finding(replace(layout, contacts=(*layout.contacts, clamp, support)), "all")
    assert found.answer is Answer.YES
    assert ways_of(found).open == ("K1", "S1")
    finger = Contact.on_facet("F1", "finger", [0, 0, 1.0], Z)
    held = finding(replace(layout, contacts=(*layout.contacts, finger)), "all")
    assert ways_of(held).contacts == ("C1", "C2", "C3", "F1")
    np.testing.assert_allclose(np.abs(ways_of(held).direction), X, atol=1e-15)


def test_no_contacts_no_answer_and_all_open_is_yes() -> None:
    layout = Layout("clamps", contacts=(Contact.on_facet("K1", "clamp", [0, 0, 1], Z),))
    verdict = judged(layout)
    assert verdict.groups["locators"].findings["loadable"].answer is None
    found = verdict.groups["all"].findings["loadable"]
    assert found.answer is Answer.YES
    assert ways_of(found).contacts == ()


def test_alternatives_and_the_branches_that_need_weights() -> None:
    sides = walls([-1, 0], [0, 1], [0, -1], space="planar")
    corner = Contact.of("A", "locator", [0, 0], [[[1, 0], [1, 1]]])
    found = finding(replace(sides, contacts=(*sides.contacts, corner)))
    assert found.answer is Answer.NO
    assert ways_of(found).weights is None
    assert len(ways_of(found).branches) == 2
    open_corner = Contact.of("A", "locator", [0, 0], [[[1, 0], [0, 1]]])
    assert finding(replace(sides, contacts=(*sides.contacts, open_corner))).answer is Answer.YES


def test_walls_that_are_not_known_well_enough() -> None:
    layout = walls(-Z, Y, -Y)
    rough = replace(layout.contacts[1], provenance=Provenance("approximate", 0.02), feature="facet 7")
    found = finding(replace(layout, contacts=(layout.contacts[0], rough, layout.contacts[2])))
    assert found.answer is Answer.UNDECIDED
    assert "facet 7 (C2" in (found.reason or "")


# --- parts ------------------------------------------------------------------------------------------------------------


def test_the_bracket_on_its_locators_and_with_a_pin() -> None:
    layout = read_layout(BRACKET)
    found = finding(layout)
    assert found.answer is Answer.YES
    assert ways_of(found).against == ("L1", "L2", "L3", "L4", "L5", "L6")
    pin = element("P1", [0.042, 0.02, 0.005], PinTip(0.012 - 2e-5, 2e-5, "round"), axis=Z)
    rests = replace(layout, elements=(*layout.elements[:3], pin, *layout.elements[6:]))
    for group in ("locators", "all"):
        found = finding(rests, group)
        assert found.answer is Answer.YES
        assert set(ways_of(found).open) >= {"P1#1", "P1#2", "P1#3", "P1#4"}
        np.testing.assert_allclose(ways_of(found).direction, Z, atol=1e-12)


def plate(folder: Path) -> Part:
    holes = [circle(0.004, 48, (-0.03, 0.0)), circle(0.004, 48, (0.03, 0.0))]
    return mesh_part(folder, prism([[-0.05, -0.02], [0.05, -0.02], [0.05, 0.02], [-0.05, 0.02]], 0.01, holes))


@pytest.mark.parametrize("turned", [(0, 0, 0), (0.3, -0.8, 2.0)])
def test_two_pins_and_three_rests_by_lifting(tmp_path: Path, turned: tuple[float, float, float]) -> None:
    X_WP = Pose.from_xyz_rpy([0.2, -0.1, 0.05], turned)
    part = replace(plate(tmp_path), pose=X_WP)
    rests = [(-0.04, -0.015, 0), (0.04, -0.015, 0), (0, 0.015, 0)]
    to_w, turn = lambda at: X_WP.points(np.array([at], dtype=float))[0], X_WP.vectors
    axis, across = turn(Z[None])[0], turn(Y[None])[0]
    elements = [element(f"L{k}", to_w(at), SphereTip(0.003)) for k, at in enumerate(rests, start=1)]
    elements += [
        element("P1", to_w((-0.03, 0, 0.005)), PinTip(0.008 - 2e-5, 2e-5, "round"), axis=axis),
        element("P2", to_w((0.03, 0, 0.005)), PinTip(0.008 - 4e-5, 4e-5, "diamond", across), axis=-axis),
    ]
    found = finding(Layout("plate", part=part, elements=tuple(elements)))
    assert found.answer is Answer.YES
    np.testing.assert_allclose(ways_of(found).direction, axis, atol=1e-9)
    # something above the plate leaves no other way
    above = element("L4", to_w((0.0, 0, 0.01)), PointTip(), role="finger")
    stuck = finding(Layout("plate", part=part, elements=(*elements, above)))
    assert stuck.answer is not Answer.YES


def test_pins_alone_are_left_along_them_only(tmp_path: Path) -> None:
    pin = element("P1", (-0.03, 0, 0.005), PinTip(0.008 - 2e-5, 2e-5, "round"), axis=-3 * Z)
    layout = Layout("plate", part=plate(tmp_path), elements=(pin,))
    found = finding(layout)
    assert found.answer is Answer.YES
    assert abs(ways_of(found).direction @ Z) == pytest.approx(1)
    # a blind hole is left on one side; the plate is at z = 0 to 10 mm, the floor below it
    (tmp_path / "blind").mkdir()
    hole, floor = plate(tmp_path), prism([[-0.05, -0.02], [0.05, -0.02], [0.05, 0.02], [-0.05, 0.02]], 0.01)
    assert hole.file is not None
    body = mesh_body(tmp_path / "blind", "floor", floor, at=(0, 0, -0.01))
    lifted = finding(replace(layout, bodies=(body,)))
    np.testing.assert_allclose(ways_of(lifted).direction, Z, atol=1e-12)


def test_an_overhang_hits_a_locator_on_the_way(tmp_path: Path) -> None:
    """An L with its notch down over a point: up is free; locators under the notch and beside it close the rest."""
    part = mesh_part(tmp_path, prism([[0, 0], [0.02, 0], [0.02, 0.02], [0.04, 0.02], [0.04, 0.04], [0, 0.04]], 0.02))
    base = [element(f"B{k}", (x, 0, z)) for k, (x, z) in enumerate([(0.005, 0.005), (0.015, 0.005), (0.01, 0.015)])]
    ends = [element("E1", (0.005, 0.03, 0)), element("E2", (0.005, 0.03, 0.02))]
    beside = [element("S1", (0, 0.01, 0.01)), element("S2", (0.02, 0.01, 0.01))]
    up_only = finding(Layout("L", part=part, elements=(*base, *ends, *beside)))
    assert up_only.answer is Answer.YES
    np.testing.assert_allclose(ways_of(up_only).direction, Y, atol=1e-12)
    assert ways_of(up_only).slides == ("E1", "E2", "S1", "S2")
    # a pad above the arm, with 5 mm of room: given as a contact elsewhere, it stands in the only way
    arm = Contact.on_facet("A1", "locator", [0.03, 0.045, 0.01], [0, -1, 0])
    blocked = finding(Layout("L", part=part, elements=(*base, *ends, *beside), contacts=(arm,)))
    assert blocked.answer is Answer.NO
    ways = ways_of(blocked)
    assert ways.obstacle is not None
    assert ways.obstacle.name == "A1"
    assert ways.obstacle.after == pytest.approx(0.005, abs=1e-9)
    np.testing.assert_allclose(ways.obstacle.point, [0.03, 0.045, 0.01], atol=1e-12)
    # a clamp there is open
    clamp = replace(arm, name="K1", role="clamp")
    assert finding(Layout("L", part=part, elements=(*base, *ends, *beside), contacts=(clamp,))).answer is Answer.YES


@pytest.mark.parametrize("tip", [PointTip(), SphereTip(0.002), PadTip(0.004, 0.004, Z), LineTip(0.004, Z)])
def test_each_kind_of_tip_is_in_the_way_of_a_hook(tmp_path: Path, tip: Tip) -> None:
    """A block between two walls of tips, with a foot that reaches under one of them."""
    hook = prism([[0, 0], [0.04, 0], [0.04, 0.01], [0.02, 0.01], [0.02, 0.04], [0, 0.04]], 0.02)
    part = mesh_part(tmp_path, hook)
    ends = [element("E1", (0.01, 0.03, 0)), element("E2", (0.01, 0.03, 0.02))]
    sides = [element("S1", (0, 0.02, 0.01)), element("S2", (0.02, 0.03, 0.01), tip)]
    found = finding(Layout("hook", part=part, elements=(*ends, *sides)))
    # up, S2 meets the foot; down it is free
    assert found.answer is Answer.YES
    np.testing.assert_allclose(ways_of(found).direction, -Y, atol=1e-12)
    below = element("B1", (0.01, 0, 0.01))
    shut = finding(Layout("hook", part=part, elements=(*ends, *sides, below)))
    assert shut.answer is Answer.NO
    obstacle = ways_of(shut).obstacle
    assert obstacle is not None
    assert obstacle.name == "S2"
    reach = {SphereTip: 0.002, PadTip: 0.002}.get(type(tip), 0.0)
    assert obstacle.after == pytest.approx(0.02 - reach, abs=2e-4)


def test_a_body_above_the_part(tmp_path: Path) -> None:
    """A block in a channel, under the foot of an L: it must go along the channel, and may not if that has ends."""
    part = mesh_part(tmp_path, box(0.02, 0.02, 0.02))
    rests = [
        element(f"L{k}", (x, y, -0.01)) for k, (x, y) in enumerate([(-0.005, -0.005), (0.005, -0.005), (0, 0.005)])
    ]
    angle = prism([[0.01, -0.02], [0.03, -0.02], [0.03, 0.03], [-0.01, 0.03], [-0.01, 0.02], [0.01, 0.02]], 0.03)
    # drawn in x and y, it stands in x and z
    upright = angle[0] @ np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]) + np.array([0, 0.015, 0])
    over = mesh_body(tmp_path, "angle", (upright, angle[1]))
    found = finding(Layout("block", part=part, elements=tuple(rests), bodies=(over,)))
    assert found.answer is Answer.YES
    ways = ways_of(found)
    assert ways.direction is not None
    assert ways.direction @ Z < 0.99
    assert "angle" in ways.against
    others = (replace(over, role="clamp"), replace(over, role="support"))
    for other in others:
        free = ways_of(finding(Layout("block", part=part, elements=tuple(rests), bodies=(other,)), "all"))
        assert free.direction is not None
        assert free.direction @ Z < 0.99
        assert free.aside == ()
        assert "angle" not in free.against
        assert any(name.startswith("angle") for name in free.open)
    sides = [element("S1", (0, -0.01, 0)), element("S2", (0, 0.01, 0)), element("S3", (-0.01, 0, 0))]
    for other in others:
        up = ways_of(finding(Layout("block", part=part, elements=(*rests, *sides), bodies=(other,)), "all"))
        assert up.aside == ("angle",)
    shut = finding(Layout("block", part=part, elements=(*rests, *sides), bodies=(over,)))
    assert shut.answer is Answer.NO
    assert ways_of(shut).obstacle is not None
    assert ways_of(shut).obstacle.name == "angle"  # type: ignore[union-attr]


@pytest.mark.parametrize("room", [0.0, 1e-4])
def test_a_tee_in_its_slot(tmp_path: Path, room: float) -> None:
    """It lifts out of no slot; it slides out along it unless both ends are shut."""
    tee = [[-2, 0], [2, 0], [2, 6], [6, 6], [6, 10], [-6, 10], [-6, 6], [-2, 6]]
    part = mesh_part(tmp_path, prism([[x * MM, y * MM] for x, y in tee], 0.03))
    r = room / MM
    outline = [
        [-2 - r, -2],
        [-2 - r, 6 - r],
        [-6 - r, 6 - r],
        [-6 - r, 10],
        [6 + r, 10],
        [6 + r, 6 - r],
        [2 + r, 6 - r],
        [2 + r, -2],
    ]
    block = [[12, -2], [12, 14], [-12, 14], [-12, -2]]
    slot = mesh_body(tmp_path, "slot", prism([[x * MM, y * MM] for x, y in outline[::1] + block[::1]][::-1], 0.03))
    layout = Layout("tee", part=part, bodies=(slot,))
    found = finding(layout)
    assert found.answer is Answer.YES
    np.testing.assert_allclose(np.abs(ways_of(found).direction), Z, atol=1e-12)
    ends = [
        mesh_body(tmp_path, f"end{k}", box(0.02, 0.02, 0.01), at=(0, 0.005, z)) for k, z in enumerate((-0.005, 0.035))
    ]
    shut = finding(replace(layout, bodies=(slot, *ends)))
    assert shut.answer is not Answer.YES
    if room == 0.0:
        assert shut.answer is Answer.NO


def test_a_planar_tee_in_its_slot() -> None:
    tee = polygon_part(np.array([[-2, 0], [2, 0], [2, 6], [6, 6], [6, 10], [-6, 10], [-6, 6], [-2, 6]]) * MM)
    sides = [element("S1", [-2 * MM, 3 * MM]), element("S2", [2 * MM, 3 * MM])]
    found = finding(Layout("tee", "planar", part=tee, elements=tuple(sides)))
    assert found.answer is Answer.YES
    np.testing.assert_allclose(ways_of(found).direction, [0, 1], atol=1e-12)
    roof = Contact.on_facet("R1", "locator", [5 * MM, 13 * MM], [0, 1])
    floor = element("F1", [0, 0])
    shut = finding(Layout("tee", "planar", part=tee, elements=(*sides, floor), contacts=(roof,)))
    assert shut.answer is Answer.NO
    held = finding(Layout("tee", "planar", part=tee, elements=(*sides, element("R1", [5 * MM, 10 * MM]))))
    assert held.answer is Answer.NO
    obstacle = ways_of(held).obstacle
    assert obstacle is not None
    assert obstacle.name in ("S1", "S2")
    assert obstacle.after == pytest.approx(3 * MM, abs=2e-5)


@pytest.mark.parametrize("file", ["featuretype", pytest.param("robotiq_adapter", marks=pytest.mark.slow)])
def test_real_parts(file: str) -> None:
    shared("SOURCES.md")
    layout = read_layout(REPOSITORY / "tests" / "layouts" / f"{file}.layout.yaml")
    if layout.part is None or layout.part.file is None or not layout.part.file.is_file():
        pytest.skip(f"no shared data beside the repository: {file}")
    verdict = judged(layout)
    assert [r.answer for r in verdict.requirements] == [Answer.YES, Answer.YES]
    assert ways_of(verdict.groups["all"].findings["loadable"]).open == ("K1", "K2", "K3")


def test_the_vee_block() -> None:
    found = finding(read_layout(REPOSITORY / "urdf" / "vblock" / "vblock.layout.yaml"))
    assert found.answer is Answer.YES
    assert set(ways_of(found).against) == {"vblock", "stop"}


def test_a_part_that_does_not_fit_the_space() -> None:
    layout = replace(walls([0, 1], space="planar"), part=Part("part", "mesh", BRACKET, None, 1.0, Pose.identity(2)))
    with pytest.raises(InputError, match="does not fit"):
        verify(replace(layout, require=LOADABLE))


def test_a_shape_in_other_units_and_turned(tmp_path: Path) -> None:
    part = mesh_part(tmp_path, l_shape(0.04, 0.02))
    tips = [((0.01, 0, 0.01), -Y), ((0.03, 0, 0.01), -Y), ((0, 0.02, 0.01), -X), ((0.01, 0.01, 0), -Z)]
    roof = ((0.035, 0.03, 0.01), Y)
    for factor, X_WP in ((1.0, Pose.identity(3)), (100.0, Pose.from_xyz_rpy([1, 2, 3], [0.4, 0.5, 0.6]))):
        turned = Pose(X_WP.rotation, X_WP.translation)
        contacts = [
            Contact.on_facet(f"C{k}", "locator", turned.points(factor * np.array([p]))[0], turned.vectors(n[None])[0])
            for k, (p, n) in enumerate([*tips, roof])
        ]
        assert part.file is not None
        scaled = replace(part, scale=factor, pose=turned)
        layout = Layout("L", part=scaled, contacts=tuple(contacts), surface_gap=1e-5 * factor)
        found = finding(layout)
        assert found.answer is Answer.YES
        np.testing.assert_allclose(ways_of(found).direction @ turned.rotation, [1, 0, 1] / np.sqrt(2), atol=0.35)


@pytest.mark.parametrize(("shaft", "bore"), [(24, 32)])
def test_a_shaft_in_a_bore_of_other_facets(tmp_path: Path, shaft: int, bore: int) -> None:
    """Facets of the two cut into each other from the start; along the axis that is no obstacle, and a collar is one."""
    square = [[-0.02, -0.02], [0.02, -0.02], [0.02, 0.02], [-0.02, 0.02]]
    ring = mesh_body(tmp_path, "ring", prism(square, 0.02, [circle(0.005, bore)]))
    part = mesh_part(tmp_path, prism(circle(0.005, shaft), 0.04))
    layout = Layout("shaft", part=part, bodies=(ring,))
    found = finding(layout)
    assert found.answer is Answer.YES
    assert abs(ways_of(found).direction @ Z) == pytest.approx(1, abs=1e-9)
    lids = [mesh_body(tmp_path, f"lid{k}", box(0.04, 0.04, 0.01), at=(0, 0, z)) for k, z in enumerate((-0.03, 0.06))]
    assert finding(replace(layout, bodies=(ring, *lids))).answer is not Answer.YES


@pytest.mark.parametrize("space", ["spatial", "planar"])
def test_a_contact_given_inside_the_part_says_nothing(tmp_path: Path, space: str) -> None:
    """Its point is a mistake, or the part's shape is: no way is called clear past it."""
    if space == "spatial":
        part = mesh_part(tmp_path, box(0.02, 0.02, 0.02))
        contact = Contact.on_facet("C1", "locator", [0, 0, -0.007], -Z)
    else:
        part = polygon_part([[-0.01, -0.01], [0.01, -0.01], [0.01, 0.01], [-0.01, 0.01]])
        contact = Contact.on_facet("C1", "locator", [0, -0.007], [0, -1])
    found = finding(Layout("inside", space, part=part, contacts=(contact,)))  # type: ignore[arg-type]
    assert found.answer is Answer.UNDECIDED
    assert "C1" in (found.reason or "")


# --- the checker ------------------------------------------------------------------------------------------------------


def tampered(layout: Layout, group: str = "locators", **changes: object) -> str | None:
    verdict = judged(layout)
    found = verdict.groups[group].findings["loadable"]
    by_name = {contact.name: contact for contact in verdict.contacts}
    forged = replace(found, use=replace(ways_of(found), **changes))  # type: ignore[arg-type]
    return loadable_fault(forged, [by_name[name] for name in verdict.groups[group].contacts])


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"direction": -X}, "not admitted"),
        ({"direction": 2 * Z}, "length one"),
        ({"direction": np.array([np.nan, 0, 0])}, "finite"),
        ({"direction": None}, "finite"),
        ({"direction": np.array([0.0, 1.0])}, "right length"),
        ({"direction": Z}, "leaves"),
        ({"leaving": 0.9}, "leaves"),
        ({"slides": ("C1",)}, "slides"),
        ({"contacts": ("C1", "C2")}, "asked"),
        ({"open": ("C1",)}, "asked"),
        ({"spans": -np.eye(3)}, "generator"),
        ({"lines": np.eye(3)}, "generator"),
        ({"length": -1.0}, "long"),
        ({"obstacle": Obstacle("K9", 0.1, X)}, "in the way"),
    ],
)
def test_forged_ways_out_are_refused(changes: dict[str, object], word: str) -> None:
    layout = walls(-Z, -Z, -Z, -Y, -Y, -X)
    assert tampered(layout) is None
    assert word in (tampered(layout, **changes) or "")


def test_forged_weights_are_refused() -> None:
    layout = walls(X, -X, Y, -Y, Z, -Z)
    weights = ways_of(finding(layout)).weights
    assert weights is not None
    assert tampered(layout) is None
    for forged in (
        None,
        {**weights, "C1": (1.0,)},
        {**weights, "C1": (-weights["C1"][0],)},
        {**weights, "C1": (np.nan,)},
        {**weights, "C1": weights["C1"] * 2},
        {name: value for name, value in weights.items() if name != "C1"},
        # balanced, with rank 2: nothing about z
        {name: (0.0,) if name in ("C5", "C6") else value for name, value in weights.items()},
    ):
        assert tampered(layout, weights=forged) is not None
    # a slot has no such weights at all
    slot = judged(walls(-Z, Y, -Y))
    claimed = {"C1": (0.0,), "C2": (0.5,), "C3": (0.5,)}
    found = slot.groups["locators"].findings["loadable"]
    for direction in (None, ways_of(found).direction):
        forged_no = Finding(Answer.NO, residual=0.0, use=replace(ways_of(found), weights=claimed, direction=direction))
        assert loadable_fault(forged_no, slot.contacts) is not None
    assert loadable_fault(Finding(Answer.NO, residual=0.0), slot.contacts) is not None


def test_a_branch_left_out_is_refused() -> None:
    sides = walls([-1, 0], [0, 1], [0, -1], space="planar")
    corner = Contact.of("A", "locator", [0, 0], [[[1, 0], [1, 1]]])
    layout = replace(sides, contacts=(*sides.contacts, corner))
    branches = ways_of(finding(layout)).branches
    assert "covered" in (tampered(layout, branches=branches[:1]) or "")
    both = {**branches[0], "A": (0.1, 0.1)}
    assert tampered(layout, branches=(both, branches[1])) is not None


def test_a_blocked_line_needs_both_its_ends(tmp_path: Path) -> None:
    part = mesh_part(tmp_path, box(0.02, 0.02, 0.02))
    tips = [((0.01, 0, 0), X), ((-0.01, 0, 0), -X), ((0, 0.01, 0), Y), ((0, -0.01, 0), -Y)]
    contacts = [Contact.on_facet(f"C{k}", "locator", p, n) for k, (p, n) in enumerate(tips)]
    lids = [Contact.on_facet(f"L{s}", "clamp", [0, 0, s * 0.03], [0, 0, s]) for s in (1, -1)]
    layout = Layout("line", part=part, contacts=(*contacts, *(replace(lid, role="locator") for lid in lids)))
    # all six are given as contacts, so that these alone shut it
    assert finding(layout).answer is Answer.NO
    bodies = [mesh_body(tmp_path, f"lid{k}", box(0.03, 0.03, 0.01), at=(0, 0, s * 0.03)) for k, s in enumerate((1, -1))]
    lidded = Layout("line", part=part, contacts=tuple(contacts), bodies=tuple(bodies))
    ways = ways_of(finding(lidded))
    assert finding(lidded).answer is Answer.NO
    assert {obstacle.name for obstacle in ways.tried} == {"lid0", "lid1"}
    assert ways.obstacle is not None
    assert ways.obstacle.after == pytest.approx(0.015)
    for changes in (
        {"tried": ways.tried[:1]},
        {"tried": ()},
        {"obstacle": None},
        {"obstacle": replace(ways.obstacle, name="nothing")},
        {"direction": X},
        {"weights": None},
        {"direction": None},
    ):
        assert tampered(lidded, **changes) is not None
    # one lid, and it leaves the other way
    assert finding(replace(lidded, bodies=tuple(bodies[:1]))).answer is Answer.YES
