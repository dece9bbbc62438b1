"""Layouts with one thing wrong each: the message names file, place, what was found and what was expected."""

from pathlib import Path

import pytest

from fixture_design.errors import FileFormatError
from fixture_design.io import ContentError, read_layout

HEAD = "schema: fixture_design/layout/1\n"
ELEMENT_KEYS = "name, role, at, tip, axis, tolerance, friction, preload, limits, fixed, stiffness"
TIPS = (
    "point, {sphere: radius}, {pad: [width, height], along: v}, {line: length, along: v}, {soft: radius} or {pin: ...}"
)
REQUIREMENTS = (
    "deterministic, accessible, strongly_accessible, loadable, form_closure, force_closure, seated, holds_loads or "
    "accurate"
)


def element(keys: str, role: str = "locator") -> str:
    """A layout of one element with these further keys; the element is on line 3."""
    return f"{HEAD}elements:\n  - {{name: L1, role: {role}, {keys}}}\n"


def contact(keys: str) -> str:
    """A layout of one contact; it is on line 3."""
    return f"{HEAD}contacts:\n  - {{name: Q1, role: locator, point: [0, 0, 0], {keys}}}\n"


def stage(keys: str) -> str:
    return f"{HEAD}loads: [{{name: cut, moment: [0, 0, 1]}}]\nstages:\n  - {{name: s, {keys}}}\n"


CASES = {
    "schema missing": ("name: x\n", "line 1: the key 'schema' is missing; expected schema: fixture_design/layout/1"),
    "a task": (
        "schema: fixture_design/task/1\n",
        "line 1, schema: this is not a layout that can be read: it is a task (use `fixture-design design`); found "
        "'fixture_design/task/1'; expected fixture_design/layout/1",
    ),
    "newer": (
        "schema: fixture_design/layout/2\n",
        "line 1, schema: this is not a layout that can be read: version 2 needs a newer fixture-design; found "
        "'fixture_design/layout/2'; expected fixture_design/layout/1",
    ),
    "other schema": (
        "name: x\nschema: 3\n",
        "line 2, schema: this is not a layout that can be read: unknown schema; found 3; expected "
        "fixture_design/layout/1",
    ),
    "role misspelt": (
        f"{HEAD}elements:\n  - name: L1\n    role: locater\n    at: [0, 0, 0]\n",
        "line 4, elements[0].role: unknown role 'locater' (did you mean 'locator'?); expected locator, support, clamp "
        "or finger",
    ),
    "key misspelt": (
        f"{HEAD}elements:\n  - name: L1\n    role: locator\n    at: [0, 0, 0]\n    frction: 0.1\n",
        f"line 6, elements[0].frction: unknown key 'frction' (did you mean 'friction'?); expected one of: "
        f"{ELEMENT_KEYS}",
    ),
    "a required key misspelt is one problem": (
        f"{HEAD}elements:\n  - name: L1\n    rol: locator\n    at: [0, 0, 0]\n",
        f"line 4, elements[0].rol: unknown key 'rol' (did you mean 'role'?); expected one of: {ELEMENT_KEYS}",
    ),
    "key missing": (
        f"{HEAD}elements:\n  - {{name: L1, role: locator}}\n",
        "line 3, elements[0]: the key 'at' is missing; expected a mapping such as {name: L1, role: locator, at: "
        "[0, 0, 0]}",
    ),
    "requirement misspelt": (
        f"{HEAD}require: {{all: [accessible, form_closur]}}\n",
        "line 2, require.all[1]: unknown requirement 'form_closur' (did you mean 'form_closure'?); expected "
        f"{REQUIREMENTS}",
    ),
    "requirement of a stage misspelt": (
        stage("active: [locator], require: [seatd]"),
        f"line 4, stages[0].require[0]: unknown requirement 'seatd' (did you mean 'seated'?); expected {REQUIREMENTS}",
    ),
    "requirement of no group": (
        f"{HEAD}require: {{locator: [seated]}}\n",
        "line 2, require.locator: unknown key 'locator' (did you mean 'locators'?); expected one of: locators, all",
    ),
    "required twice": (
        f"{HEAD}require: {{all: [seated, seated]}}\n",
        "line 2, require.all[1]: 'seated' is required twice; expected it once",
    ),
    "spatial with 2": (
        element("at: [0, 0]"),
        "line 3, elements[0].at: 'space: spatial' wants 3 coordinates, found 2 at elements[0].at",
    ),
    "planar with 3": (
        f"{HEAD}space: planar\nelements:\n  - {{name: L1, role: clamp, at: [0, 0, 0]}}\n",
        "line 4, elements[0].at: 'space: planar' wants 2 coordinates, found 3 at elements[0].at",
    ),
    "planar gravity": (
        f"{HEAD}space: planar\ngravity: [0, 0, -9.81]\n",
        "line 3, gravity: 'space: planar' wants 2 coordinates, found 3 at gravity",
    ),
    "planar moment": (
        f"{HEAD}space: planar\nloads: [{{name: cut, moment: [0, 0, 1]}}]\n",
        "line 3, loads[0].moment: 'space: planar' wants one number as a moment, found 3 at loads[0].moment",
    ),
    "spatial moment": (
        f"{HEAD}loads: [{{name: cut, moment: 1}}]\n",
        "line 2, loads[0].moment: 'space: spatial' wants 3 numbers as a moment, found 1 at loads[0].moment",
    ),
    "planar pose": (
        f"{HEAD}part: {{mesh: a.stl, pose: {{theta: 1}}}}\n",
        "line 2, part.pose.theta: 'theta' does not fit 'space: spatial'; expected {xyz: [...], rpy: [...]}",
    ),
    "too many coordinates": (
        element("at: [0, 0, 0, 0]"),
        "line 3, elements[0].at: 'at' has too many values; found a list of 4 values; expected 3 or fewer",
    ),
    "coordinates missing": (
        element("at: 3"),
        "line 3, elements[0].at: 'at' is of the wrong kind; found 3; expected a list of numbers: [x, y, z]",
    ),
    "text for a coordinate": (
        element("at: [0, left, 0]"),
        "line 3, elements[0].at[1]: an item of 'at' is of the wrong kind; found 'left'; expected a number such as 0.2 "
        "or 1.0e-5",
    ),
    "true for a number": (
        f"{HEAD}friction: true\n",
        "line 2, friction: 'friction' is of the wrong kind; found true; expected a number",
    ),
    "a number in quotes": (
        f"{HEAD}friction: '0.2'\n",
        "line 2, friction: 'friction' is of the wrong kind; found '0.2'; expected a number, without quotes",
    ),
    "NaN": (
        f"{HEAD}friction: .nan\n",
        "line 2, friction: 'friction' is not finite; found nan; expected a finite number",
    ),
    "infinity": (
        f"{HEAD}gravity: [0, 0, 1e999]\n",
        "line 2, gravity[2]: an item of 'gravity' is not finite; found inf; expected a finite number",
    ),
    "a huge integer": (
        f"{HEAD}friction: 1{'0' * 350}\n",
        f"line 2, friction: 'friction' is of the wrong kind; found 1{'0' * 56}...; expected a number that a float can "
        "hold",
    ),
    "yes is no boolean": (
        element("at: [0, 0, 0], fixed: yes"),
        "line 3, elements[0].fixed: 'fixed' is of the wrong kind; found 'yes'; expected true or false",
    ),
    "negative friction": (
        f"{HEAD}friction: -0.1\n",
        "line 2, friction: 'friction' is out of range; found -0.1; expected a number >= 0",
    ),
    "negative radius": (
        element("at: [0, 0, 0], tip: {sphere: -1}"),
        "line 3, elements[0].tip.sphere: 'sphere' is out of range; found -1; expected a number > 0",
    ),
    "limits out of order": (
        element("at: [0, 0, 0], limits: [500, 0]", role="clamp"),
        "line 3, elements[0].limits: 'limits' is out of order; found [500, 0]; expected the smaller one first",
    ),
    "preload on a locator": (
        element("at: [0, 0, 0], preload: 3"),
        "line 3, elements[0].preload: locator 'L1' pushes with a preload; only clamps do; expected `role: clamp`, or "
        "no `preload`",
    ),
    "unknown tip": (
        element("at: [0, 0, 0], tip: spere"),
        f"line 3, elements[0].tip: 'tip' is of the wrong kind; found 'spere'; expected {TIPS}",
    ),
    "two tips": (
        element("at: [0, 0, 0], tip: {sphere: 1, soft: 1}"),
        "line 3, elements[0].tip.soft: the tip of locator 'L1' has 'sphere' and 'soft' together; expected one of them",
    ),
    "no tip in the braces": (
        element("at: [0, 0, 0], tip: {along: [0, 0, 1]}"),
        "line 3, elements[0].tip: the tip of locator 'L1' has no shape; expected one of the keys sphere, pad, line, "
        "soft or pin",
    ),
    "pad without direction": (
        element("at: [0, 0, 0], tip: {pad: [1, 2]}"),
        "line 3, elements[0].tip: the pad of locator 'L1' needs a direction; expected `along: [...]`",
    ),
    "pad with one side": (
        element("at: [0, 0, 0], tip: {pad: [1], along: [1, 0, 0]}"),
        "line 3, elements[0].tip.pad: 'pad' has too few values; found a list of 1 value; expected 2 or more",
    ),
    "sphere with direction": (
        element("at: [0, 0, 0], tip: {sphere: 1, along: [0, 0, 1]}"),
        "line 3, elements[0].tip.along: the sphere of locator 'L1' takes no direction; expected no `along` here",
    ),
    "diamond without direction": (
        element("at: [0, 0, 0], axis: [0, 0, 1], tip: {pin: {diameter: 1, clearance: 0, shape: diamond}}"),
        "line 3, elements[0].tip: the diamond pin of locator 'L1' needs a direction; expected `along: [...]`",
    ),
    "pin without axis": (
        element("at: [0, 0, 0], tip: {pin: {diameter: 1, clearance: 0}}"),
        "line 3, elements[0]: locator 'L1' is a pin without an axis; expected axis: [x, y, z]",
    ),
    "axis without pin": (
        element("at: [0, 0, 0], axis: [0, 0, 1]"),
        "line 3, elements[0].axis: locator 'L1' has an axis; only pins have an axis; expected no `axis` here",
    ),
    "axis of zero": (
        element("at: [0, 0, 0], axis: [0, 0, 0], tip: {pin: {diameter: 1, clearance: 0}}"),
        "line 3, elements[0].axis: 'axis' has zero length; expected a direction",
    ),
    "pin of unknown shape": (
        element("at: [0, 0, 0], axis: [0, 0, 1], tip: {pin: {diameter: 1, clearance: 0, shape: rond}}"),
        "line 3, elements[0].tip.pin.shape: unknown shape 'rond' (did you mean 'round'?); expected round or diamond",
    ),
    "normal and any_of": (
        contact("normal: [0, 0, 1], any_of: [[0, 0, 1]]"),
        "line 3, contacts[0].any_of: contact 'Q1' has 'normal' and 'any_of' together; expected one of them",
    ),
    "no normal": (
        contact("friction: 0.1"),
        "line 3, contacts[0]: contact 'Q1' has no normal; expected one of the keys normal, any_of, all_of or normals",
    ),
    "normal of zero": (
        contact("normal: [0, 0, 0]"),
        "line 3, contacts[0].normal: 'normal' has zero length; expected a direction",
    ),
    "one normal of several is zero": (
        contact("normals: [[[1, 0, 0]], [[0, 1, 0], [0, 0, 0]]]"),
        "line 3, contacts[0].normals[1][1]: 'normals' has zero length; expected a direction",
    ),
    "brackets missing": (
        contact("any_of: [0, 0, 1]"),
        "line 3, contacts[0].any_of[0]: an item of 'any_of' is of the wrong kind; found 0; expected a list of numbers: "
        "[x, y, z] (and 2 more problems)",
    ),
    "no alternatives": (
        contact("any_of: []"),
        "line 3, contacts[0].any_of: 'any_of' has too few values; found a list of 0 values; expected 1 or more",
    ),
    "duplicate name": (
        element("at: [0, 0, 0]") + "contacts:\n  - {name: L1, role: clamp, point: [0, 0, 0], normal: [0, 0, 1]}\n",
        "line 5, contacts[0].name: the name 'L1' is given twice, first at line 3, elements[0].name; expected another "
        "name",
    ),
    "name with #": (
        element("at: [0, 0, 0]").replace("L1", "'L#1'"),
        "line 3, elements[0].name: 'name' is not usable as a name; found 'L#1'; expected a name in one line, without "
        "'#' (it numbers contacts) and without blanks around it",
    ),
    "name that is a role": (
        element("at: [0, 0, 0]").replace("L1", "clamp"),
        "line 3, elements[0].name: the name 'clamp' is that of a role, so that `active` could not tell it from one; "
        "expected another name",
    ),
    "name that is a number": (
        element("at: [0, 0, 0]").replace("L1", "1"),
        "line 3, elements[0].name: 'name' is of the wrong kind; found 1; expected text in quotes: '1'",
    ),
    "unknown load": (
        stage("active: [locator], loads: [cutt]"),
        "line 4, stages[0].loads[0]: no load is called 'cutt' (did you mean 'cut'?); expected one of: cut",
    ),
    "unknown active": (
        stage("active: [K1]"),
        "line 4, stages[0].active[0]: no role, element, body or contact is called 'K1'; expected one of: locator, "
        "support, clamp, finger",
    ),
    "stage called all": (
        stage("active: [clamp]").replace("name: s", "name: all"),
        "line 4, stages[0].name: the name 'all' is that of a group that every layout has; expected another name",
    ),
    "two stages of one name": (
        stage("active: [clamp]") + "  - {name: s, active: [clamp]}\n",
        "line 5, stages[1].name: the name 's' is given twice, first at line 4, stages[0].name; expected another name",
    ),
    "two loads of one name": (
        f"{HEAD}loads:\n  - {{name: a, moment: [0, 0, 1]}}\n  - {{name: a, path: a.csv}}\n",
        "line 4, loads[1].name: the name 'a' is given twice, first at line 3, loads[0].name; expected another name",
    ),
    "load without force": (
        f"{HEAD}loads: [{{name: cut, point: [0, 0, 0]}}]\n",
        "line 2, loads[0]: load 'cut' has no force; expected `force`, `moment` or `path`",
    ),
    "load that acts nowhere": (
        f"{HEAD}loads: [{{name: cut, force: [0, 0, 1]}}]\n",
        "line 2, loads[0]: load 'cut' has a force that acts nowhere; expected `point: [...]`",
    ),
    "load with path and force": (
        f"{HEAD}loads: [{{name: cut, path: a.csv, moment: [0, 0, 1]}}]\n",
        "line 2, loads[0].moment: load 'cut' has `path` and 'moment' together; expected one of them",
    ),
    "two parts": (
        f"{HEAD}part: {{mesh: a.stl, step: a.step}}\n",
        "line 2, part.step: the part has 'mesh' and 'step' together; expected one of them",
    ),
    "part without geometry": (
        f"{HEAD}part: {{mass: 1}}\n",
        "line 2, part: the part has no geometry; expected one of the keys urdf, mesh, step or polygon",
    ),
    "part as a file name": (
        f"{HEAD}part: a.stl\n",
        "line 2, part: 'part' is of the wrong kind; found 'a.stl'; expected a mapping such as {mesh: part.stl, scale: "
        "0.001}",
    ),
    "scale of a URDF": (
        f"{HEAD}part: {{urdf: a.urdf, scale: 0.001}}\n",
        "line 2, part.scale: `scale` is for meshes and STEP files; expected no `scale` here",
    ),
    "clockwise polygon": (
        f"{HEAD}space: planar\npart: {{polygon: [[0, 0], [0, 1], [1, 0]]}}\n",
        "line 3, part.polygon: the polygon's vertices run clockwise; expected them counter-clockwise",
    ),
    "flat polygon": (
        f"{HEAD}space: planar\npart: {{polygon: [[0, 0], [1, 1], [2, 2]]}}\n",
        "line 3, part.polygon: the polygon encloses no area: its sides cross, or lie on each other",
    ),
    "friction without end": (
        f"{HEAD}friction: 1.0e+300\n",
        "line 2, friction: 'friction' is out of range; found 1e+300; expected a number <= 1000",
    ),
    "mesh in the plane": (
        f"{HEAD}space: planar\npart: {{mesh: a.stl}}\n",
        "line 3, part.mesh: a planar part is a polygon; found mesh; expected polygon: [[x, y], ...]",
    ),
    "bodies in the plane": (
        f"{HEAD}space: planar\nbodies: [{{name: v, role: locator, urdf: v.urdf}}]\n",
        "line 3, bodies: bodies are spatial; expected `contacts` or `elements` where `space: planar`",
    ),
    "unknown unit": (
        f"{HEAD}units: cm\n",
        "line 2, units: unknown unit 'cm' (did you mean 'm'?); expected m, mm or in",
    ),
    "a key without value": (
        f"{HEAD}part:\n",
        "line 2, part: part has no value; expected a value; leave the key out where there is none",
    ),
    "elements as a mapping": (
        f"{HEAD}elements: {{L1: 1}}\n",
        "line 2, elements: 'elements' is of the wrong kind; found a mapping with the keys L1; expected a list; each "
        "item a mapping such as {name: L1, role: locator, at: [0, 0, 0]}",
    ),
    "samples as a float": (
        f"{HEAD}sweep: {{samples: 1.5}}\n",
        "line 2, sweep.samples: 'samples' is of the wrong kind; found 1.5; expected a whole number",
    ),
    "sweep out of order": (
        f"{HEAD}sweep: {{friction: [0.3, 0.1]}}\n",
        "line 2, sweep.friction: 'friction' is out of order; found [0.3, 0.1]; expected the smaller one first",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_one_problem(tmp_path: Path, case: str) -> None:
    text, wanted = CASES[case]
    path = tmp_path / "x.yaml"
    path.write_text(text)
    with pytest.raises(FileFormatError) as caught:
        read_layout(path)
    assert str(caught.value) == f"{path}: {wanted}"
    assert caught.value.source == str(path)


def test_the_first_problem_in_the_file_is_told_and_the_others_are_counted(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(f"{HEAD}require: {{all: [closed]}}\nfriction: -1\nunit: mm\n")
    with pytest.raises(ContentError) as caught:
        read_layout(path)
    assert str(caught.value).startswith(f"{path}: line 2, require.all[0]: unknown requirement 'closed'")
    assert str(caught.value).endswith(" (and 2 more problems)")
    assert [problem.path for problem in caught.value.problems] == [("require", "all", 0), ("friction",), ("unit",)]
    assert caught.value.place == "line 2, require.all[0]"
    assert caught.value.expected == REQUIREMENTS
