"""Whatever is wrong with the input: one line that says where, what and what else; exit code 2; JSON stays JSON."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.layouts import CLOSED_OBJ, FAILS, HEAD, HOLDS, OPEN_OBJ, contact, on_part

#: Random bytes that are neither UTF-8 nor UTF-16.
NOISE = bytes.fromhex("9e7741c3f80d1bd2005aa4e1b8ff3390")

#: By what is wrong: the content of x.yaml (None: no file), and what the message has to say.
CASES: dict[str, tuple[str | bytes | None, list[str]]] = {
    "no file": (None, ["there is no such file"]),
    "empty": ("", ["the file is empty", "expected a mapping that starts with `schema:`"]),
    "only a comment": ("# nothing\n", ["the file is empty"]),
    "noise": (NOISE, ["line 1", "not UTF-8 text", "found byte 0x9e", "expected a YAML or JSON file"]),
    "noise after a good start": (HEAD.encode() + NOISE, ["line 2", "not UTF-8 text", "found byte 0x9e"]),
    "control characters": (HEAD + "name: \x07\n", ["line 2", "not text", "found the character U+0007"]),
    "not YAML": (HEAD + "elements: [1, 2\nname: x\n", ["line 3", "not valid YAML", "a list opened with '['"]),
    "a list": ("- 1\n", ["line 1", "holds no mapping", "found a list", "expected `key: value` lines"]),
    "unknown key": (
        HEAD + "colour: red\n",
        ["line 2, colour", "unknown key 'colour'", "expected one of: schema, name"],
    ),
    "duplicate key": (
        HEAD + "name: a\nname: b\n",
        ["line 3", "'name' is given twice, in lines 2 and 3", "expected each key once"],
    ),
    "misspelt role": (
        HEAD + "contacts:\n  - {name: Q1, role: locater, point: [0, 0, 0], normal: [0, 0, 1]}\n",
        ["line 3, contacts[0].role", "unknown role 'locater' (did you mean 'locator'?)", "expected locator, support"],
    ),
    "role nobody has in a stage": (
        HOLDS + "stages: [{name: s, active: [clam]}]\n",
        ["stages[0].active[0]", "'clam' (did you mean 'clamp'?)", "expected one of: locator"],
    ),
    "missing mesh": (on_part("{mesh: nope.stl}"), ["nope.stl", "there is no mesh file", "expected an existing file"]),
    "mesh of an unknown kind": (
        on_part("{mesh: x.yaml}"),
        ["cannot read meshes of kind '.yaml'", "expected one of .stl"],
    ),
    "URDF that is not XML": (
        on_part("{urdf: text.urdf}"),
        ["text.urdf: line 1, column 1: not XML", "found syntax error", "expected a URDF file"],
    ),
    "missing URDF": (on_part("{urdf: nope.urdf}"), ["nope.urdf", "there is no such file", "expected a URDF file"]),
    "mesh not closed": (
        on_part("{mesh: open.obj}"),
        [
            "open.obj: the mesh has 3 open edges",
            "found one at [0.0, 0.0, 0.5] m",
            "expected a closed surface",
            "named at line 2, part.mesh",
        ],
    ),
    "missing mesh that nothing touches": (
        contact("point: [0, 0, 0], normal: [0, 0, 1]").replace("space: spatial", "part: {mesh: nope.stl}"),
        ["line 2, part.mesh: there is no mesh file: ", "nope.stl", "expected an existing file"],
    ),
    "a contact that the element does not have": (
        on_part("{mesh: closed.obj}") + "stages:\n- {name: s, active: ['L1#2']}\n",
        ["line 6, stages[0]: no role, element or contact is called 'L1#2'; did you mean 'L1'? there are: L1, clamp"],
    ),
    "off the surface": (
        on_part("{mesh: closed.obj}", at="[0.2, 0.2, -0.0042]"),
        [
            "line 4, elements[0]: element 'L1' is 4.2 mm off the surface of 'closed'",
            "nearest: facet ",
            "raise `surface_gap` (10 um)",
        ],
    ),
    "a gap as large as the part": (
        on_part("{mesh: closed.obj}").replace("elements:", "surface_gap: 1.0e+10\nelements:", 1),
        ["`surface_gap` is 1e+10 m, and the part 'closed' is only "],
    ),
    "inside": (
        on_part("{mesh: closed.obj}", at="[0.2, 0.2, 0.001]"),
        ["line 4, elements[0]: element 'L1' is 1 mm inside 'closed'", "nearest: facet "],
    ),
    "normal of length 0": (
        contact("point: [0, 0, 0], normal: [0, 0, 0]"),
        ["line 4, contacts[0].normal", "zero length", "expected a direction"],
    ),
    "NaN": (
        contact("point: [0, .nan, 0], normal: [0, 0, 1]"),
        ["line 4, contacts[0].point[1]", "not finite", "found nan", "expected a finite number"],
    ),
    "infinity": (
        contact("point: [0, 0, 0], normal: [0, 0, -.inf]"),
        ["line 4, contacts[0].normal[2]", "not finite", "found -inf", "expected a finite number"],
    ),
    "a name twice": (
        contact("point: [0, 0, 0], normal: [0, 0, 1]")
        + "  - {name: Q1, role: clamp, point: [1, 0, 0], normal: [0, 0, 1]}\n",
        ["line 5, contacts[1].name", "'Q1'", "line 4"],
    ),
    "normal and any_of": (
        contact("point: [0, 0, 0], normal: [0, 0, 1], any_of: [[0, 1, 1], [1, 0, 1]]"),
        ["line 4, contacts[0].any_of", "'Q1' has 'normal' and 'any_of' together", "expected one of them"],
    ),
    "negative friction": (
        contact("point: [0, 0, 0], normal: [0, 0, 1], friction: -0.1"),
        ["line 4, contacts[0].friction", "out of range", "found -0.1", "expected a number >= 0"],
    ),
    "no contacts": (HEAD, ["the layout has no contacts", "give `elements`, `bodies` or `contacts`"]),
    "elements without a part": (
        HEAD + "elements:\n  - {name: L1, role: locator, at: [0, 0, 0]}\n",
        ["line 3, elements[0]: there are elements but no part", "expected part: ..."],
    ),
    "planar with three coordinates": (
        contact("point: [0, 0, 0], normal: [0, 1]", space="planar"),
        ["line 4, contacts[0].point", "'space: planar' wants 2 coordinates, found 3"],
    ),
    "spatial with two coordinates": (
        contact("point: [0, 0, 0], normal: [0, 1]"),
        ["line 4, contacts[0].normal", "'space: spatial' wants 3 coordinates, found 2"],
    ),
    "another schema": (
        "schema: fixture_design/graph/1\nnodes: []\n",
        ["line 1, schema", "found 'fixture_design/graph/1'", "expected fixture_design/layout/1"],
    ),
    "a later version": (
        "schema: fixture_design/layout/2\n",
        ["line 1, schema", "needs a newer fixture-design", "expected fixture_design/layout/1"],
    ),
    "no schema": ("name: x\n", ["'schema' is missing", "expected schema: fixture_design/layout/1"]),
    "no such STEP file": (on_part("{step: x.step}"), ["x.step", "there is no mesh file", "expected an existing file"]),
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "closed.obj").write_text(CLOSED_OBJ)
    (tmp_path / "open.obj").write_text(OPEN_OBJ)
    (tmp_path / "text.urdf").write_text("no robot at all\n")
    return tmp_path


def bad_file(folder: Path, case: str) -> Path:
    content, path = CASES[case][0], folder / "x.yaml"
    if content is not None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def check_message(err: str, path: Path, words: list[str]) -> None:
    assert err.startswith(f"fixture-design: {path}: ")
    assert err.endswith("\n")
    assert len(err.splitlines()) == 1
    assert "Traceback" not in err
    for word in words:
        assert word in err


@pytest.mark.parametrize("case", CASES)
def test_one_line_and_exit_code_2(command: Callable, folder: Path, case: str) -> None:
    path = bad_file(folder, case)
    ran = command("verify", path)
    check_message(ran.err, path, CASES[case][1])
    assert (ran.code, ran.out) == (2, "")


@pytest.mark.parametrize("case", CASES)
def test_json_is_one_error_record(command: Callable, folder: Path, case: str) -> None:
    path = bad_file(folder, case)
    ran = command("verify", "--json", path)
    check_message(ran.err, path, CASES[case][1])
    record = json.loads(ran.out)
    assert {key: record[key] for key in ("schema", "name", "source")} == {
        "schema": "fixture_design/verdict/1",
        "name": "x",
        "source": str(path),
    }
    assert set(record) == {"schema", "name", "source", "error"}
    assert set(record["error"]) == {"kind", "message"}
    assert record["error"]["kind"].endswith("Error")
    for word in CASES[case][1]:
        assert word in record["error"]["message"]
    assert ran.code == 2


def test_a_folder(command: Callable, tmp_path: Path) -> None:
    ran = command("verify", tmp_path)
    check_message(ran.err, tmp_path, ["this is a folder; expected a file"])
    assert (ran.code, ran.out) == (2, "")


def test_a_json_layout(command: Callable, tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    path.write_text('{"schema": "fixture_design/layout/1",\n "friction": -1}')
    ran = command("verify", path)
    check_message(ran.err, path, ["line 2, friction", "found -1; expected a number >= 0"])
    assert (ran.code, ran.out) == (2, "")


def test_the_mesh_at_fault_is_named_with_the_layout_that_uses_it(command: Callable, folder: Path) -> None:
    path = bad_file(folder, "mesh not closed")
    mesh = folder / "open.obj"
    assert command("verify", path).err.startswith(f"fixture-design: {path}: {mesh}: the mesh has 3 open edges")


def test_the_others_are_still_verified(command: Callable, folder: Path) -> None:
    good, bad = folder / "good.yaml", bad_file(folder, "unknown key")
    good.write_text(FAILS)
    ran = command("verify", bad, good, bad)
    assert ran.code == 2
    assert len(ran.err.splitlines()) == 2
    assert "requirements fail" in ran.out
    ran = command("verify", "--json", bad, good, bad)
    assert ["error" in record for record in json.loads(ran.out)] == [True, False, True]
