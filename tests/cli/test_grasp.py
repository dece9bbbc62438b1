"""`fixture-design grasp`: exit codes, words, JSON, files."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from fixture_design.cli.program import app
from fixture_design.errors import InputError
from fixture_design.io import read_layout
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


def test_a_layout_brings_its_part(cube, tmp_path):
    _run(JAW, cube, *AT, "-o", tmp_path / "g.yaml")
    assert _run(JAW, tmp_path / "g.yaml", *AT).exit_code == 0


def test_one_finger_exits_with_1(cube):
    found = _run(public_hand("finger_edu").hand.model, cube)
    assert found.exit_code == 1
    assert "one finger pushes" in found.stdout


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
        (["--pose", "0,0,-5"], "no contacts"),
        (["-o", "no/such/folder/g.yaml"], "folder"),
    ],
)
def test_bad_input_is_one_message(cube, arguments, problem):
    found = _run(JAW, cube, *arguments)
    assert isinstance(found.exception, InputError)
    assert problem in str(found.exception)
