"""`fixture-design grasp`: exit codes, words, JSON, files."""

from __future__ import annotations

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from fixture_design.cli.program import app
from fixture_design.errors import InputError
from fixture_design.io import read_layout
from fixture_design.layout import Pose
from tests.grasp.hands import JAW, primitive, public_hand

AT = ["--joint", "left_joint=0.03", "--pose", "0,0,-0.115"]


def _run(*arguments: object):
    return CliRunner().invoke(app, ["grasp", *map(str, arguments)])


@pytest.fixture(scope="module")
def cube():
    return primitive("cube")[0].file


def test_a_search_writes_layout_and_page_and_exits_with_0(cube, tmp_path):
    found = _run(JAW, cube, "--most", 1, "--tries", 10, "-o", tmp_path / "g.yaml", "--html", tmp_path / "g.html")
    assert found.exit_code == 0
    assert found.stdout.startswith("closed: 1 grasp")
    assert {element.role for element in read_layout(tmp_path / "g.yaml").elements} == {"finger"}
    assert "hand: parallel jaw" in (tmp_path / "g.html").read_text()


def test_json_is_all_there_is_on_stdout(cube):
    found = _run(JAW, cube, *AT, "--load", "0,0,-10", "--json")
    assert found.exit_code == 0
    (grasp,) = json.loads(found.stdout)["grasps"]
    assert grasp["closed"] == "yes"
    assert grasp["held"]["torques"]["left_joint"] == pytest.approx(-20.0)


def test_json_has_the_moments_of_soft_tips(tmp_path):
    """Pads on a ball touch it in a patch each: a moment about the line between them is theirs alone."""
    ball = primitive("sphere")[0].file
    found = _run(JAW, ball, *AT, "--load", "0,0,0,0.004,0,0", "--json")
    (grasp,) = json.loads(found.stdout)["grasps"]
    assert sum(moment[0] for moment in grasp["held"]["moments"].values()) == pytest.approx(-0.004, abs=1e-9)


def test_a_layout_brings_its_part(cube, tmp_path):
    _run(JAW, cube, *AT, "-o", tmp_path / "g.yaml")
    assert _run(JAW, tmp_path / "g.yaml", *AT).exit_code == 0


def test_a_refused_grasp_is_written_as_one_and_requires_nothing(cube, tmp_path):
    for options, code, words in (
        (["--load", "0,0,-1000"], 3, "undecided: the drives do not hold the load"),
        (["--table", "0"], 1, "no grasp: "),
    ):
        assert _run(JAW, cube, *AT, *options, "-o", tmp_path / "g.yaml").exit_code == code
        layout = read_layout(tmp_path / "g.yaml")
        assert words in layout.name
        told = CliRunner().invoke(app, ["verify", str(tmp_path / "g.yaml")])
        assert "all requirements hold" not in told.stdout
        assert words in told.stdout
    (load,) = [one for one in _written(cube, tmp_path, "--load", "0,0,-10").loads if one.name == "asked for"]
    assert load.force is not None
    np.testing.assert_allclose(load.force, [0, 0, -10])


def _written(part, folder, *options):
    assert _run(JAW, part, *AT, *options, "-o", folder / "g.yaml").exit_code == 0
    return read_layout(folder / "g.yaml")


def test_a_layout_brings_its_gravity_and_loads_and_what_it_does_not_bring_is_told(cube, tmp_path):
    file = tmp_path / "given.yaml"
    file.write_text(
        f"schema: fixture_design/layout/1\npart: {{urdf: {cube}, mass: 1}}\ngravity: [0, 0, -9.81]\nfriction: 0.2\n"
        "elements: [{name: L1, role: locator, at: [0, 0, -0.03]}]\n"
        "loads: [{name: cutting, point: [0, 0, 0.03], force: [0, 3, -1]}]\n"
    )
    layout = _written(file, tmp_path, "--load", "0,0,-10")
    assert layout.gravity is not None
    assert layout.gravity[2] == -9.81
    assert [load.name for load in layout.loads] == ["cutting", "asked for"]
    told = _run(JAW, file, *AT).stdout
    for words in (
        "the grasp's layout takes over gravity and loads",
        "friction 0.2 is left out",
        "elements, bodies and",
    ):
        assert words in told


def test_what_is_not_written_is_told(cube, tmp_path):
    (tmp_path / "g.yaml").write_text("old")
    found = _run(JAW, cube, "--pose=0,0,-5", "-o", tmp_path / "g.yaml", "--html", tmp_path / "g.html")
    assert found.exit_code == 1
    assert "g.yaml, which stays as it was: there is no grasp to write" in found.stderr
    assert "g.html: there is no grasp to write" in found.stderr
    assert (tmp_path / "g.yaml").read_text() == "old"


@pytest.mark.parametrize("scale", ["nan", "0", "-1", "0.001"])
def test_a_scale_for_urdf_is_refused(cube, scale):
    found = _run(JAW, cube, "--scale", scale)
    assert isinstance(found.exception, InputError)
    assert "`scale` is not for URDF" in str(found.exception)


def test_a_hand_whose_fingertips_are_off_is_bad_input(cube, tmp_path):
    file = tmp_path / "off.hand.yaml"
    file.write_text(
        f"schema: fixture_design/hand/1\nmodel: {JAW}\nfingertips:\n"
        "  - {name: left, link: left_pad, at: [5, 0, 40], facing: [1, 0, 0]}\n"
    )
    found = _run(file, cube)
    assert isinstance(found.exception, InputError)
    assert "off link 'left_pad'" in str(found.exception)


def test_one_finger_exits_with_3(cube):
    found = _run(public_hand("finger_edu").hand.model, cube)
    assert found.exit_code == 3
    assert "one fingertip" in found.stdout


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["--joint", "left_joint=0.03", "--pose=0,0,-0.08"], 1, "not closed: body is 10 mm inside the part"),
        (["--joint", "left_joint=0.028", "--pose=0,0,-0.115"], 1, "inside the part"),
        (["--joint", "left_joint=0.04", "--pose=0,0,-0.115"], 1, "not closed: nothing touches the part"),
        (["--pose=0,0,-5"], 1, "not closed: nothing touches the part"),
        ([*AT, "--load", "0,0,-1000"], 3, "undecided: the drives do not hold the load"),
        ([*AT, "--load", "0,0,-10"], 0, "closed: 1 grasp"),
        ([*AT, "--table", "0"], 1, "inside the table"),
        ([*AT, "--table", "-0.2"], 0, "closed: 1 grasp"),
    ],
)
def test_a_hand_where_it_is(cube, arguments, code, words):
    found = _run(JAW, cube, *arguments)
    assert found.exit_code == code, found.output
    assert words in found.stdout


def test_what_is_printed_can_be_typed_again(cube):
    """A pose that is turned about all axes: without its angles nothing would touch."""
    turned = ["--joint", "left_joint=0.03", "--pose=0.115,0,0,0.3,-1.5707963267948966,0"]
    first = _run(JAW, cube, *turned)
    (line,) = [line for line in first.stdout.splitlines() if "as options:" in line]
    typed = line.partition(":")[2].split()
    assert typed != turned
    one, other = (json.loads(_run(JAW, cube, *options, "--json").stdout) for options in (turned, typed))
    assert one["satisfied"] == other["satisfied"]
    for here, there in zip(one["grasps"], other["grasps"], strict=True):
        assert here["positions"] == pytest.approx(there["positions"])
        poses = [Pose.from_xyz_rpy(found["pose"]["xyz"], found["pose"]["rpy"]) for found in (here, there)]
        np.testing.assert_allclose(poses[0].rotation, poses[1].rotation, atol=1e-8)
        np.testing.assert_allclose(poses[0].translation, poses[1].translation, atol=1e-9)


def test_a_part_too_large_exits_with_3():
    assert _run(JAW, primitive("large")[0].file).exit_code == 3


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["--joint", "left=0.03"], "no joint is called 'left'"),
        (["--joint", "left_joint=1"], "does not go there"),
        (["--joint", "left_joint"], "--joint cannot be read"),
        (["--pose", "1,2"], "--pose cannot be used"),
        (["--load", "a,b,c"], "--load cannot be read"),
        (["--joint", "right_joint=0.045", "--joint", "left_joint=0.03"], "'right_joint' follows 'left_joint'"),
        (["--joint", "left_joint=0.02", "--joint", "left_joint=0.03"], "--joint is given twice"),
        (["-o", "no/such/folder/g.yaml"], "folder"),
        (["-o", "g.html", "--html", "./g.html"], "two outputs would go to one file"),
        (["--html", "page.pdf"], "pages are HTML"),
        (["--table", "nan"], "--table cannot be used"),
    ],
)
def test_bad_input_is_one_message(cube, arguments, problem):
    found = _run(JAW, cube, *arguments)
    assert isinstance(found.exception, InputError)
    assert problem in str(found.exception)
    assert str(cube) not in str(found.exception)  # it is not the part's fault


def test_a_part_as_the_hand_is_not_a_hand(tmp_path):
    file = tmp_path / "part.stl"
    file.write_bytes(bytes(range(256)))
    assert "this is not a hand" in str(_run(file, file).exception)
