"""Fixture bodies from layout to contacts: what theory says of corners, V-blocks, jaws, nests, pins and shafts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from fixture_design.contacts import Contact
from fixture_design.errors import GeometryError, PenetrationError
from fixture_design.geometry import contacts_of_elements
from fixture_design.layout import Answer, Body, Element, Layout, Motion, Part, Pose
from fixture_design.verification import check, verify
from tests.geometry.parts import Mesh, box, circle, part, prism, unit, write

S = 2**-0.5


def urdf(folder: Path, name: str, *shapes: str) -> Path:
    collisions = "".join(f"<collision>{shape}</collision>" for shape in shapes)
    file = folder / f"{name}.urdf"
    file.write_text(f'<robot name="{name}"><link name="{name}">{collisions}</link></robot>')
    return file


def boxes(folder: Path, name: str, *pairs: tuple[list[float], list[float]]) -> Path:
    """Boxes by their lowest and highest corners."""
    shapes = []
    for low, high in pairs:
        size, middle = np.subtract(high, low), np.add(high, low) / 2
        text = [" ".join(repr(float(x)) for x in values) for values in (middle, size)]
        shapes.append(f'<origin xyz="{text[0]}"/><geometry><box size="{text[1]}"/></geometry>')
    return urdf(folder, name, *shapes)


def meshed(folder: Path, name: str, mesh: Mesh) -> Path:
    file = write(folder, mesh, f"{name}.obj")
    return urdf(folder, name, f'<geometry><mesh filename="{file.name}"/></geometry>')


def along_y(mesh: Mesh) -> Mesh:
    """A prism over (x, y) from z = 0 upwards as one over (x, z) from y = 0 to the back."""
    vertices, triangles = mesh
    return vertices @ np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]), triangles


def vee(folder: Path) -> Path:
    """A V-block of 90 degrees with its bottom along y through the origin, y from -0.06 to 0."""
    outline = [[0, 0], [0.03, 0.03], [0.04, 0.03], [0.04, -0.01], [-0.04, -0.01], [-0.04, 0.03], [-0.03, 0.03]]
    return meshed(folder, "vee", along_y(prism(outline, 0.06)))


def layout_of(part: Part, *bodies: Body, **more: object) -> Layout:
    return Layout("test", part=part, bodies=bodies, friction=0.2, **more)  # type: ignore[arg-type]


def body(file: Path, pose: Pose | None = None, role: str = "locator", **more: object) -> Body:
    return Body(file.stem, role, file, pose or Pose.identity(3), **more)  # type: ignore[arg-type]


def contacts(layout: Layout) -> tuple[Contact, ...]:
    return contacts_of_elements(layout).contacts


def answers(layout: Layout) -> dict[str, str]:
    verdict = verify(layout)
    assert check(verdict) == []
    return {name: str(finding.answer) for name, finding in verdict.groups["all"].findings.items()}


def normals(found: tuple[Contact, ...]) -> set[tuple[float, ...]]:
    return {tuple((np.round(unit(n), 6) + 0.0).tolist()) for contact in found for n in contact.normals}


@pytest.fixture
def cube(tmp_path: Path) -> Part:
    return part(write(tmp_path, box(0.04, 0.04, 0.04), "cube.obj"))


def corner(folder: Path) -> Path:
    walls = [([-0.04, -0.04, -0.04], [0.06, 0.06, -0.02]), ([-0.04, -0.04, -0.02], [-0.02, 0.06, 0.03])]
    return boxes(folder, "corner", *walls, ([-0.02, -0.04, -0.02], [0.06, -0.02, 0.03]))


POSES = [Pose.identity(3), Pose.from_xyz_rpy([0.2, -0.1, 0.3], [0.3, -0.7, 1.1])]


@pytest.mark.parametrize("pose", POSES, ids=["at home", "elsewhere"])
def test_cube_in_a_corner(tmp_path: Path, cube: Part, pose: Pose) -> None:
    layout = layout_of(replace(cube, pose=pose), body(corner(tmp_path), pose))
    found = contacts(layout)
    assert [contact.name for contact in found] == [f"corner#{number}" for number in range(1, 8)]
    assert sum(len(contact.clauses) for contact in found) == 12
    assert all(len(clause) == 1 for contact in found for clause in contact.clauses)
    assert {contact.friction for contact in found} == {0.2}
    assert max(abs(contact.distance or 0.0) for contact in found) < 1e-15
    assert answers(layout) == {
        "deterministic": "yes",
        "accessible": "yes",
        "strongly_accessible": "yes",
        "form_closure": "no",
        "force_closure": "no",
    }


def test_block_in_a_vee_slides_along_it_and_lifts_out(tmp_path: Path, cube: Part) -> None:
    pose = Pose.from_xyz_rpy([0, -0.03, 0.02 / S], [0, np.pi / 4, 0])
    layout = layout_of(replace(cube, pose=pose), body(vee(tmp_path)))
    found = contacts(layout)
    assert normals(found) == {(round(-S, 6), 0.0, round(-S, 6)), (round(S, 6), 0.0, round(-S, 6))}
    assert sorted(len(contact.clauses) for contact in found) == [1, 1, 1, 1, 2, 2]
    found = answers(layout)
    assert (found["deterministic"], found["strongly_accessible"], found["force_closure"]) == ("no", "yes", "no")


def test_pentagon_in_a_vee(tmp_path: Path) -> None:
    """Sides of a house lie on both flanks: two by two corners."""
    house = [[0, 0], [0.02, 0.02], [0.02, 0.04], [-0.02, 0.04], [-0.02, 0.02]]
    pentagon = part(write(tmp_path, along_y(prism(house, 0.05)), "house.obj"))
    layout = layout_of(pentagon, body(vee(tmp_path), Pose.from_xyz_rpy([0, 0.005, 0], [0, 0, 0])))
    found = contacts(layout)
    assert len(found) == 6
    assert answers(layout)["strongly_accessible"] == "yes"
    # a stop at one end takes the last freedom
    stop = boxes(tmp_path, "stop", ([-0.01, -0.07, 0.001], [0.01, -0.05, 0.02]))
    assert answers(replace(layout, bodies=(*layout.bodies, body(stop))))["deterministic"] == "yes"


def test_block_between_jaws(tmp_path: Path, cube: Part) -> None:
    jaw = boxes(tmp_path, "jaw", ([-0.02, -0.03, -0.015], [0, 0.03, 0.015]))
    left = body(jaw, Pose.from_xyz_rpy([-0.02, 0, 0], [0, 0, 0]))
    right = replace(body(jaw, Pose.from_xyz_rpy([0.02, 0, 0], [0, 0, np.pi]), "clamp", friction=0.0), name="right")
    layout = layout_of(cube, left, right)
    found = contacts(layout)
    assert [contact.role for contact in found] == ["locator"] * 4 + ["clamp"] * 4
    assert [contact.friction for contact in found] == [0.2] * 4 + [0.0] * 4
    assert normals(found) == {(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)}
    assert {round(abs(float(contact.point[1])), 9) for contact in found} == {0.02}
    assert {round(abs(float(contact.point[2])), 9) for contact in found} == {0.015}
    result = answers(layout)
    assert (result["form_closure"], result["strongly_accessible"], result["force_closure"]) == ("no", "no", "yes")
    frictionless = replace(layout, friction=0.0)
    assert answers(frictionless)["force_closure"] == "no"


def test_step_on_a_nest(tmp_path: Path) -> None:
    """A stepped part over the edge of a nest: floor, step and riser touch, concave edge on convex edge included."""
    step = prism([[0, 0], [0.02, 0], [0.02, 0.01], [0.05, 0.01], [0.05, 0.03], [0, 0.03]], 0.04)
    nest = boxes(tmp_path, "nest", ([-0.01, -0.05, -0.02], [0.06, 0.01, 0]), ([0.02, -0.05, 0], [0.06, 0.01, 0.01]))
    layout = layout_of(part(write(tmp_path, along_y(step), "step.obj")), body(nest))
    found = contacts(layout)
    assert normals(found) == {(0.0, 0.0, -1.0), (1.0, 0.0, 0.0)}
    heights = {round(float(c.point[2]), 9) for c in found for n in c.normals if n[2] < 0}
    assert heights == {0.0, 0.01}
    assert answers(layout)["strongly_accessible"] == "yes"


def test_shaft_in_a_vee_touches_along_two_lines(tmp_path: Path) -> None:
    """However its strips lie: two ends on each flank, and free to turn about its axis."""
    shaft = write(tmp_path, along_y(prism(circle(0.015, 48), 0.05)), "shaft.obj")
    for turned in (0.0, 0.02, 0.0654):
        pose = Pose.from_xyz_rpy([0, 0, 0.015 / S], [0, turned, 0])
        layout = layout_of(replace(part(shaft), pose=pose), body(vee(tmp_path)))
        found = contacts(layout)
        assert len(found) == 4
        np.testing.assert_allclose(sorted(abs(c.point[0]) for c in found), [0.015 * S] * 4, atol=1e-9)
        np.testing.assert_allclose(sorted(c.point[1] for c in found), [-0.05, -0.05, 0, 0], atol=1e-9)
        assert normals(found) == {(round(-S, 6), 0.0, round(-S, 6)), (round(S, 6), 0.0, round(-S, 6))}
        finding = verify(layout).groups["all"].findings["deterministic"]
        assert finding.answer is Answer.NO


def test_shaft_of_rounded_coordinates_turns_under_its_clamp(tmp_path: Path) -> None:
    """Its fitted normals are off by 1e-7, which leaves the tie of its spin open; that the surface slips does not."""
    file = tmp_path / "shaft.stl"
    vertices, triangles = along_y(prism(circle(0.015, 48), 0.05))
    trimesh.Trimesh(vertices, triangles, process=False).export(file)
    pose = Pose.from_xyz_rpy([0, 0, 0.015 / S], [0, 0, 0])
    shaft = Part("shaft", "mesh", file, None, 1.0, pose)
    tops = tuple(Element(f"K{k}", "clamp", np.array([0.0, -0.01 * k, 0.015 / S + 0.015])) for k in range(1, 4))
    layout = replace(layout_of(shaft, body(vee(tmp_path))), elements=tops, friction=0.0)
    verdict = verify(layout)
    assert verdict.groups["all"].findings["form_closure"].answer is Answer.NO
    assert verdict.groups["all"].findings["deterministic"].answer is Answer.NO
    evidence = verdict.groups["all"].findings["form_closure"].evidence
    assert isinstance(evidence, Motion)
    assert evidence.rule is not None
    assert evidence.rule.name == "common slip"
    assert check(verdict) == []


@pytest.mark.parametrize("turned", [0.0, 0.03])
def test_pin_that_fills_a_bore_holds_all_around(tmp_path: Path, turned: float) -> None:
    plate = prism([[-0.04, -0.04], [0.04, -0.04], [0.04, 0.04], [-0.04, 0.04]], 0.02, [circle(0.015, 48)])
    pin = meshed(tmp_path, "pin", prism(circle(0.015, 48), 0.05))
    layout = layout_of(
        part(write(tmp_path, plate, "plate.obj")), body(pin, Pose.from_xyz_rpy([0, 0, -0.01], [0, 0, turned]))
    )
    found = contacts(layout)
    assert {round(float(contact.point[2]), 9) for contact in found} == {0.0, 0.02}
    for contact in found:
        ((normal,),) = contact.clauses
        np.testing.assert_allclose(unit(normal), -unit([*contact.point[:2], 0]), atol=1e-9)
    result = answers(layout)
    assert (result["accessible"], result["strongly_accessible"], result["deterministic"]) == ("yes", "no", "no")


def test_block_on_dowels_touches_each_along_a_line(tmp_path: Path, cube: Part) -> None:
    dowel = meshed(tmp_path, "dowel", prism(circle(0.005, 24), 0.03))
    places = {"a": [-0.025, -0.01, -0.02], "b": [-0.025, 0.01, -0.02], "c": [0.003, -0.025, -0.02]}
    dowels = [replace(body(dowel, Pose.from_xyz_rpy(at, [0, 0, 0.4])), name=name) for name, at in places.items()]
    found = contacts(layout_of(cube, *dowels))
    assert [contact.name for contact in found] == ["a#1", "a#2", "b#1", "b#2", "c#1", "c#2"]
    for contact, at in zip(found[::2], places.values(), strict=True):
        expected = [-0.02, at[1]] if contact.name < "c" else [at[0], -0.02]
        np.testing.assert_allclose(contact.point[:2], expected, atol=1e-8)
    assert {round(float(contact.point[2]), 9) for contact in found} == {-0.02, 0.01}


def test_edge_across_a_shaft_touches_in_a_point(tmp_path: Path) -> None:
    shaft = write(tmp_path, along_y(prism(circle(0.015, 48), 0.05)), "shaft.obj")
    ridge = meshed(tmp_path, "ridge", along_y(prism([[0, 0], [-0.01, -0.02], [0.01, -0.02]], 0.04)))
    turned = Pose.from_xyz_rpy([-0.02, -0.02, -0.015], [0, 0, np.pi / 2])
    (contact,) = contacts(
        layout_of(replace(part(shaft), pose=Pose.from_xyz_rpy([0, 0, 0], [0, 0.02, 0])), body(ridge, turned))
    )
    np.testing.assert_allclose(contact.point, [0, -0.02, -0.015], atol=1e-8)
    np.testing.assert_allclose([unit(n) for n in contact.normals], [[0, 0, -1]], atol=1e-6)


def test_small_gaps_and_overlaps_touch(tmp_path: Path, cube: Part) -> None:
    for offset in (-4e-6, 3e-6):
        pose = Pose.from_xyz_rpy([offset] * 3, [0, 0, 0])
        found = contacts(layout_of(replace(cube, pose=pose), body(corner(tmp_path))))
        # corners of the overlaps: 4 each, and where walls meet some more that are micrometres apart
        assert 12 <= sum(len(contact.clauses) for contact in found) <= 15
        assert normals(found) == {(-1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)}
        assert {round(contact.distance or 0.0, 12) for contact in found} == {offset}


def test_rounded_pose_is_still_face_on_face(tmp_path: Path, cube: Part) -> None:
    pose = Pose.from_xyz_rpy([0, -0.03, 0.0282843], [0, 0.785398, 0])
    found = contacts(layout_of(replace(cube, pose=pose), body(vee(tmp_path))))
    assert sorted(len(contact.clauses) for contact in found) == [1, 1, 1, 1, 2, 2]


def test_a_body_that_does_not_touch_is_noted_with_its_distance(tmp_path: Path, cube: Part) -> None:
    far = boxes(tmp_path, "far", ([-0.05, -0.05, -0.05], [0.05, 0.05, -0.0223]))
    found = contacts_of_elements(layout_of(cube, body(far)))
    assert found.contacts == ()
    assert found.notes == ("body 'far' does not touch the part: it is 2.3 mm away",)
    # an edge over a face: between edges, no vertex is as near
    bar = boxes(tmp_path, "bar", ([-0.05, -0.01, -0.01], [0.05, 0.01, 0.01]))
    (note,) = contacts_of_elements(layout_of(cube, body(bar, Pose.from_xyz_rpy([0, 0, 0.04], [np.pi / 4, 0, 0])))).notes
    assert note == "body 'bar' does not touch the part: it is 5.86 mm away"


@pytest.mark.parametrize(
    ("low", "high", "depth"),
    [
        ([-0.05, -0.05, -0.05], [0.05, 0.05, -0.019], 1e-3),
        ([-0.05, -0.005, 0.015], [0.05, 0.005, 0.03], 5e-3),
        ([-0.003, -0.003, -0.003], [0.003, 0.003, 0.003], 17e-3),
    ],
    ids=["floor", "bar across the part", "wholly inside"],
)
def test_penetration_is_an_error_with_place_and_depth(
    tmp_path: Path, cube: Part, low: list[float], high: list[float], depth: float
) -> None:
    with pytest.raises(PenetrationError, match=r"'intruder'.*overlap by.*'cube'") as caught:
        contacts(layout_of(cube, body(boxes(tmp_path, "intruder", (low, high)))))
    assert caught.value.body == "intruder"
    assert depth / 3 < caught.value.depth <= 1.3 * depth


def test_hulls_are_not_taken_for_the_bodies(tmp_path: Path, cube: Part) -> None:
    """The cube lies in the hull of the V, deep, and in free space all the same."""
    pose = Pose.from_xyz_rpy([0, -0.03, 0.0285], [0, np.pi / 4, 0])
    (note,) = contacts_of_elements(layout_of(replace(cube, pose=pose), body(vee(tmp_path)))).notes[-1:]
    assert "does not touch" in note


def test_faults_name_the_file(tmp_path: Path, cube: Part) -> None:
    vertices, triangles = box(0.01, 0.01, 0.01)
    layout = layout_of(cube, body(meshed(tmp_path, "open", (vertices, triangles[:-1]))))
    with pytest.raises(GeometryError, match=r"open.urdf.*not closed"):
        contacts(layout)


def test_dowel_given_as_a_cylinder_touches_along_its_exact_line(tmp_path: Path, cube: Part) -> None:
    dowel = urdf(tmp_path, "dowel", '<geometry><cylinder radius="0.005" length="0.03"/></geometry>')
    found = contacts(layout_of(cube, body(dowel, Pose.from_xyz_rpy([-0.025, 0.004, 0.01], [0, 0, 0.3]))))
    np.testing.assert_allclose([c.point for c in found], [[-0.02, 0.004, -0.005], [-0.02, 0.004, 0.02]], atol=1e-9)
    assert normals(found) == {(-1.0, 0.0, 0.0)}


@pytest.mark.parametrize(
    ("low", "high", "depth"),
    [
        ([-0.03, 0.01, -0.02], [0.03, 0.06, 0.02], 0.01),
        ([-0.01, 0.01, -0.02], [0.01, 0.06, 0.02], 0.01),
        ([-0.02, -0.02, -0.02], [0.02, 0.02, 0.02], 0.02),
        ([-0.002, -0.2, -0.02], [0.002, 0.2, 0.02], 0.02),
    ],
    ids=["wider jaw", "narrower jaw", "the same", "bar through it"],
)
def test_flush_overlap_is_penetration(
    tmp_path: Path, cube: Part, low: list[float], high: list[float], depth: float
) -> None:
    """Faces in each other's planes: no edge pierces a face."""
    with pytest.raises(PenetrationError) as caught:
        contacts(layout_of(cube, body(boxes(tmp_path, "intruder", (low, high)))))
    assert depth / 4 < caught.value.depth <= 1.01 * depth


@pytest.mark.parametrize("turned", [0.0, 0.0654])
def test_a_shaft_sunk_by_less_than_its_facets_are_off_it_is_judged_by_its_surface(
    tmp_path: Path, turned: float
) -> None:
    """48 strips of a 15 mm shaft are 32 um off it; it may be sunk 10 um, and rests on vertices or on a strip."""
    shaft = part(write(tmp_path, along_y(prism(circle(0.015, 48), 0.05)), "shaft.obj"))
    floor = boxes(tmp_path, "floor", ([-0.05, -0.1, -0.02], [0.05, 0.1, 0.0]))
    for sunk in (8e-6, 12e-6, 25e-6, 60e-6):
        pose = Pose.from_xyz_rpy([0, 0, 0.015 - sunk], [0, turned, 0])
        layout = layout_of(replace(shaft, pose=pose), body(floor))
        if sunk <= 1e-5:
            assert len(contacts(layout)) == 2
            continue
        with pytest.raises(PenetrationError) as caught:
            contacts(layout)
        # deeper than facets are off it a vertex is found, which may be that much higher
        low = sunk if sunk < 4e-5 else sunk - 3.3e-5
        assert 0.99 * low <= caught.value.depth <= 1.01 * sunk


def test_jaws_that_all_but_face_each_other_are_no_certain_no(tmp_path: Path, cube: Part) -> None:
    """Each leans open by 0.2 mrad, within the gap all over: what is that near may be parallel or not."""
    jaw = boxes(tmp_path, "jaw", ([-0.02, -0.03, -0.015], [0, 0.03, 0.015]))
    left = body(jaw, Pose.from_xyz_rpy([-0.02, 0, 0], [0, -2e-4, 0]))
    right = replace(body(jaw, Pose.from_xyz_rpy([0.02, 0, 0], [0, -2e-4, np.pi])), name="right")
    layout = layout_of(cube, left, right)
    for contact in contacts(layout):
        off = min(np.linalg.norm(unit(n) - s * np.array([1, 0, 0])) for n in contact.normals for s in (-1, 1))
        assert contact.provenance.normal_error >= off or off > 1e-4
    assert answers(layout)["strongly_accessible"] != "no"
