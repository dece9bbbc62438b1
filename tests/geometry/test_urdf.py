"""URDF parts: meshes and simple shapes of fixed links, and every way in which a file can be wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fixture_design.errors import FileFormatError, GeometryError, InputError, UnsupportedError
from fixture_design.geometry import PartGeometry, contact_of, load_part
from fixture_design.layout import Pose
from tests.geometry.parts import box, element, part, shared, unit, write

BOX = '<geometry><box size="1 1 1"/></geometry>'
LINKS = '<link name="a"/><link name="b"/>'
MESH = '<geometry><mesh filename="{name}" {more}/></geometry>'


def model(folder: Path, body: str, name: str = "robot.urdf") -> Path:
    file = folder / name
    file.write_text(f'<?xml version="1.0"?>\n<robot name="r">{body}</robot>\n')
    return file


def one_link(geometry: str, kind: str = "collision", origin: str = "") -> str:
    return f'<link name="base"><{kind}>{origin}{geometry}</{kind}></link>'


def joint(name: str, parent: str, child: str, kind: str = "fixed", origin: str = "") -> str:
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{origin}</joint>'


def load(folder: Path, body: str) -> PartGeometry:
    return load_part(part(model(folder, body)))


def extent(geometry: PartGeometry) -> list[list[float]]:
    return np.round([geometry.low, geometry.high], 9).tolist()


def test_mesh_with_scale_and_origin(tmp_path: Path) -> None:
    write(tmp_path, box(50, 30, 20), "b.stl")
    origin = '<origin xyz="0.1 0 0" rpy="0 0 1.5707963267948966"/>'
    geometry = load(tmp_path, one_link(MESH.format(name="b.stl", more='scale="0.001 0.001 0.001"'), origin=origin))
    assert extent(geometry) == [[0.085, -0.025, -0.01], [0.115, 0.025, 0.01]]
    assert geometry.notes == ()


def test_mirrored_mesh_is_still_wound_outward_without_a_note(tmp_path: Path) -> None:
    write(tmp_path, box(0.05, 0.03, 0.02), "b.obj")
    geometry = load(tmp_path, one_link(MESH.format(name="b.obj", more='scale="-1 1 1"')))
    assert geometry.notes == ()
    assert geometry.surface.at(np.zeros(3))[0] == pytest.approx(-0.01)


def test_fixed_links_are_joined_in_the_root_frame(tmp_path: Path) -> None:
    boxes = "".join(
        f'<link name="{n}"><collision><geometry><box size="0.02 0.02 0.02"/></geometry></collision></link>'
        for n in "ab"
    )
    geometry = load(tmp_path, boxes + joint("j", "a", "b", origin='<origin xyz="0 0 0.02" rpy="0 0 0"/>'))
    assert extent(geometry) == [[-0.01, -0.01, -0.01], [0.01, 0.01, 0.03]]
    assert len(geometry.facets) == 12
    # the seam between the two is a flat place
    contact = contact_of(element([0.01, 0.001, 0.01]), geometry, Pose.identity(3), 0.0, 1e-5)
    assert [[unit(n).tolist() for n in clause] for clause in contact.clauses] == [[[1, 0, 0]]]


def test_joints_compose_down_the_chain(tmp_path: Path) -> None:
    links = '<link name="a"/><link name="b"/>' + one_link('<geometry><box size="0.02 0.04 0.06"/></geometry>')
    origin = '<origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>'
    geometry = load(tmp_path, links + joint("j", "a", "b", origin=origin) + joint("k", "b", "base", origin=origin))
    assert extent(geometry) == [[0.99, 0.98, -0.03], [1.01, 1.02, 0.03]]


def test_visual_geometry_stands_in_with_a_note(tmp_path: Path) -> None:
    geometry = load(tmp_path, one_link('<geometry><box size="0.1 0.1 0.1"/></geometry>', "visual"))
    assert any("link 'base'" in note and "visual" in note for note in geometry.notes)


@pytest.mark.parametrize("name", ["package://parts/meshes/b.obj", "../meshes/b.obj", "file"])
def test_file_names(tmp_path: Path, name: str) -> None:
    (tmp_path / "meshes").mkdir()
    (tmp_path / "urdf").mkdir()
    (tmp_path / "package.xml").write_text("<package><name>parts</name></package>")
    mesh = write(tmp_path / "meshes", box(0.05, 0.03, 0.02), "b.obj")
    name = f"file://{mesh}" if name == "file" else name
    file = model(tmp_path / "urdf", one_link(MESH.format(name=name, more="")))
    assert len(load_part(part(file)).facets) == 6


@pytest.mark.parametrize(
    ("body", "error", "words"),
    [
        (one_link(MESH.format(name="gone.stl", more="")), FileFormatError, ["link 'base'", "gone.stl", "no mesh file"]),
        (one_link(MESH.format(name="", more="")), FileFormatError, ["link 'base'", "no filename"]),
        (one_link(MESH.format(name="package://nope/a.stl", more="")), FileFormatError, ["'nope'", "package.xml"]),
        (one_link(MESH.format(name="https://x/a.stl", more="")), UnsupportedError, ["link 'base'", "https"]),
        (one_link(MESH.format(name="b.obj", more='scale="0 1 1"')), FileFormatError, ["scale"]),
        (one_link(MESH.format(name="b.obj", more='scale="1 2"')), FileFormatError, ["1 or 3 numbers", "'1 2'"]),
        (one_link('<geometry><box size="1 -1 1"/></geometry>'), FileFormatError, ["positive", "1 -1 1"]),
        (one_link('<geometry><box size="1 nan 1"/></geometry>'), FileFormatError, ["link 'base'", "1 nan 1"]),
        (one_link('<geometry><box/></geometry>'), FileFormatError, ["3 numbers in 'size'"]),
        (one_link('<geometry><cylinder radius="1"/></geometry>'), FileFormatError, ["1 numbers in 'length'"]),
        (one_link('<geometry><cylinder radius="1" length="0"/></geometry>'), FileFormatError, ["length '0'"]),
        (one_link('<geometry><sphere radius="-1"/></geometry>'), FileFormatError, ["link 'base'", "radius '-1'"]),
        (one_link('<geometry><capsule length="1"/></geometry>'), FileFormatError, ["1 numbers in 'radius'"]),
        (one_link('<geometry><ellipsoid a="1"/></geometry>'), UnsupportedError, ["<ellipsoid>", "boxes"]),
        (one_link('<geometry><drake:ellipsoid a="1"/></geometry>'), UnsupportedError, ["<ellipsoid>", "link 'base'"]),
        (one_link("<geometry/>"), FileFormatError, ["no geometry"]),
        ("", FileFormatError, ["no links"]),
        ('<link name="a"/>', FileFormatError, ["no geometry"]),
        ('<link name="a"/><link name="a"/>', FileFormatError, ["same name", "'a'"]),
        ('<link name="a"/><link name="b"/>', FileFormatError, ["one tree"]),
        (LINKS + joint("j", "a", "b", "revolute"), UnsupportedError, ["joint 'j'", "rigid", "revolute"]),
        (LINKS + joint("j", "a", "c"), FileFormatError, ["joint 'j'", "no such link", "'c'"]),
        (LINKS + joint("j", "a", "b") * 2, FileFormatError, ["two parents", "'b'"]),
        ('<link name="r"/>' + LINKS + joint("j", "a", "b") + joint("k", "b", "a"), FileFormatError, ["loop"]),
        (one_link(BOX, origin='<origin xyz="a b c"/>'), FileFormatError, ["not a number"]),
    ],
)  # fmt: skip
def test_bad_models_say_where_and_what(tmp_path: Path, body: str, error: type[InputError], words: list[str]) -> None:
    with pytest.raises(error) as caught:
        load(tmp_path, body)
    for word in ["robot.urdf", *words]:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("text", "error", "words"),
    [
        ("<robot><link", FileFormatError, ["not XML", "line 1"]),
        ("", FileFormatError, ["not XML"]),
        ("<sdf/>", FileFormatError, ["not URDF", "<sdf>"]),
        ('<robot xmlns:xacro="http://ros.org/wiki/xacro"><xacro:macro name="a"/></robot>', UnsupportedError, ["xacro"]),
    ],
)
def test_files_that_are_no_urdf(tmp_path: Path, text: str, error: type[InputError], words: list[str]) -> None:
    (tmp_path / "robot.urdf").write_text(text)
    with pytest.raises(error) as caught:
        load_part(part(tmp_path / "robot.urdf"))
    for word in ["robot.urdf", *words]:
        assert word in str(caught.value)


def test_missing_urdf(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"gone\.urdf: there is no such file"):
        load_part(part(tmp_path / "gone.urdf"))


def test_open_mesh_in_a_urdf_names_file_link_and_mesh(tmp_path: Path) -> None:
    vertices, triangles = box(0.05, 0.03, 0.02)
    write(tmp_path, (vertices, triangles[1:]), "hole.obj")
    with pytest.raises(GeometryError, match=r"robot\.urdf: link 'base', collision, mesh 'hole\.obj': .*3 open edges"):
        load(tmp_path, one_link(MESH.format(name="hole.obj", more="")))


def test_drakes_prefix_needs_no_declaration(tmp_path: Path) -> None:
    body = one_link('<geometry><drake:capsule radius="0.01" length="0.02"/></geometry><drake:proximity_properties/>')
    geometry = load(tmp_path, body)
    np.testing.assert_allclose(np.ptp(geometry.vertices, axis=0), [0.02, 0.02, 0.04])


def test_many_shapes_of_many_links(tmp_path: Path) -> None:
    links = "".join(
        f'<link name="l{number}"><collision><geometry><box size="0.01 0.01 0.01"/></geometry></collision>'
        f'<collision><origin xyz="0 0 0.02"/><geometry><sphere radius="0.002"/></geometry></collision></link>'
        for number in range(20)
    )
    joints = "".join(
        joint(f"j{number}", f"l{number}", f"l{number + 1}", origin='<origin xyz="0.02 0 0"/>') for number in range(19)
    )
    geometry = load(tmp_path, links + joints)
    assert extent(geometry) == [[-0.005, -0.005, -0.005], [0.385, 0.005, 0.022]]
    assert geometry.shell_of_triangle.max() == 39


@pytest.mark.parametrize(
    "path",
    [
        "airo-models/airo_models/grippers/robotiq_2f_85/urdf/robotiq_2f_85.urdf",
        "example-robot-data/example-robot-data/robots/allegro_hand_description/urdf/allegro_right_hand.urdf",
        "dex-urdf/robots/hands/barrett_hand/bhand_model.urdf",
    ],
)
def test_hands_are_no_rigid_parts(path: str) -> None:
    with pytest.raises(UnsupportedError, match=r"joint '.*': a part must be rigid; found type 'revolute'"):
        load_part(part(shared(path)))


def test_real_model() -> None:
    geometry = load_part(part(shared("IsaacGymEnvs/assets/factory/urdf/factory_round_peg_8mm_tight.urdf")))
    assert np.ptp(geometry.vertices, axis=0)[2] == pytest.approx(0.05)
    kinds = [facet.provenance.kind for facet in geometry.facets]
    assert kinds.count("exact") == 2
