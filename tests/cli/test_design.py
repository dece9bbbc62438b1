"""`fixture-design design`: from a part or a task file to a layout that verifies, and what happens on bad input."""

from __future__ import annotations

import csv
import json
import os
import signal
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import shapely
import trimesh

from fixture_design.io import read_layout
from fixture_design.layout import PinTip
from tests.cli.conftest import Ran

Command = Callable[..., Ran]

PLANAR = """
schema: fixture_design/task/1
space: planar
units: mm
part: {polygon: [[0, 0], [40, 0], [40, 20], [0, 20]]}
candidates: {spacing: 4}
require: {locators: [deterministic, strongly_accessible], all: [form_closure]}
limits: {loading: [-1, -1]}
"""


@pytest.fixture
def box(tmp_path: Path) -> Path:
    path = tmp_path / "box.stl"
    trimesh.creation.box((100, 60, 40)).export(path)
    return path


def saved(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "task.yaml"
    path.write_text(text)
    return path


def test_a_part_becomes_a_layout_that_verifies(command: Command, box: Path, tmp_path: Path) -> None:
    out, urdf, table = tmp_path / "out.yaml", tmp_path / "out.urdf", tmp_path / "out.csv"
    ran = command("design", box, "-o", out, "--scale", "0.001", "--urdf", urdf, "--csv", table)
    assert ran.code == 0, ran.err
    assert "9 elements, the fewest" in ran.out
    assert command("verify", out).code == 0
    layout = read_layout(out)
    assert [element.name for element in layout.elements] == ["L1", "L2", "L3", "L4", "L5", "L6", "K1", "K2", "K3"]
    rows = list(csv.DictReader(table.open()))
    assert [row["name"] for row in rows] == [element.name for element in layout.elements]
    for row, element in zip(rows, layout.elements, strict=True):
        point, normal = (np.array([float(row[f"{n}{axis}"]) for axis in "xyz"]) for n in ("", "n"))
        assert np.abs(point - element.at).max() < 1e-9
        assert np.linalg.norm(normal) == pytest.approx(1)
    robot = ElementTree.parse(urdf).getroot()
    assert {link.get("name") for link in robot.findall("link")} == {"fixture", *(e.name for e in layout.elements)}
    assert len(robot.findall("joint")) == 9


def test_urdf_elements_touch_the_part_and_stand_outside(command: Command, box: Path, tmp_path: Path) -> None:
    import yourdfpy

    out, urdf = tmp_path / "out.yaml", tmp_path / "out.urdf"
    assert command("design", box, "-o", out, "--scale", "0.001", "--urdf", urdf).code == 0
    robot = yourdfpy.URDF.load(str(urdf))
    half = np.array([0.05, 0.03, 0.02])
    for element in read_layout(out).elements:
        pose = robot.get_transform(element.name, "fixture")
        assert np.abs(pose[:3, 3] - element.at).max() < 1e-9
        outward = pose[:3, 2]
        face = int(np.argmax(np.abs(outward)))
        assert abs(outward[face]) == pytest.approx(1)
        assert outward[face] * element.at[face] == pytest.approx(half[face])


PINNED = """
schema: fixture_design/task/1
units: mm
part: {mesh: plate.stl, scale: 0.001}
candidates:
  stem: {radius: 1, length: 15, body_radius: 4, body_length: 10}
  pins: {clearance: 0.02, diameters: [4, 20]}
require: {locators: [deterministic, loadable], all: [form_closure]}
limits: {loading: [0, 0, -1]}
"""


@pytest.fixture
def plate(tmp_path: Path) -> Path:
    """A plate with two holes of 8 mm, in millimetres."""
    outline = shapely.box(0, 0, 100, 60)
    for x in (20, 80):
        outline = outline.difference(shapely.Point(x, 30).buffer(4, quad_segs=16))
    trimesh.creation.extrude_polygon(outline, 12).export(tmp_path / "plate.stl")
    return tmp_path / "plate.stl"


def test_pins_and_stems_of_a_task_are_in_its_units(command: Command, plate: Path, tmp_path: Path) -> None:
    out, urdf = tmp_path / "out.yaml", tmp_path / "out.urdf"
    ran = command("design", saved(plate.parent, PINNED), "-o", out, "--urdf", urdf)
    assert ran.code == 0, ran.err + ran.out
    assert "6 elements, the fewest" in ran.out
    assert command("verify", out).code == 0
    tips = [element.tip for element in read_layout(out).elements if isinstance(element.tip, PinTip)]
    assert [(round(tip.diameter, 6), tip.clearance) for tip in tips] == [(0.00798, pytest.approx(2e-5))] * 2
    assert sorted(tip.shape for tip in tips) == ["diamond", "round"]
    sizes = [
        (float(size.get("radius", 0)), float(size.get("length", 0)))
        for link in ElementTree.parse(urdf).getroot().findall("link")
        if (link.get("name") or "").startswith("K")
        for size in link.findall("collision/geometry/cylinder")
    ]
    assert sizes == [(pytest.approx(0.001), pytest.approx(0.015)), (pytest.approx(0.004), pytest.approx(0.01))]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("[4, 20]", "[20, 4]", "'diameters' is out of order"),
        ("[4, 20]", "[0, 4]", "out of range"),
        ("clearance: 0.02", "clearence: 0.02", "did you mean 'clearance'"),
        ("length: 15", "length: 0", "'length' is out of range"),
        ("stem: {radius: 1, ", "tips: [{pin: {diameter: 4, clearance: 0}}]\n  stem: {", "tips of this kind"),
        ("stem: {radius: 1, ", "tips: [{line: 4}]\n  stem: {", "needs a direction"),
    ],
)
def test_wrong_stems_tips_and_pins_are_told(command: Command, plate: Path, old: str, new: str, said: str) -> None:
    assert old in PINNED
    ran = command("design", saved(plate.parent, PINNED.replace(old, new)), "-o", plate.parent / "out.yaml")
    assert ran.code == 2, ran.out
    assert said in ran.err
    assert ran.err.count("\n") <= 1


def test_bodies_too_wide_to_stand_together_are_told(command: Command, plate: Path) -> None:
    ran = command("design", saved(plate.parent, PINNED.replace("body_radius: 4", "body_radius: 400")))
    assert ran.code == 3, ran.err
    assert "out of each other's way" in ran.out


def test_without_a_file_the_layout_goes_to_stdout(command: Command, tmp_path: Path) -> None:
    ran = command("design", saved(tmp_path, PLANAR))
    assert ran.code == 0, ran.err
    assert ran.out.startswith("schema: fixture_design/layout/1")
    assert "the requirements hold" in ran.err
    again = tmp_path / "again.yaml"
    again.write_text(ran.out)
    assert command("verify", again).code == 0


def test_json_is_one_document_with_layout_steps_and_bound(command: Command, tmp_path: Path) -> None:
    ran = command("design", saved(tmp_path, PLANAR), "--json")
    assert ran.code == 0
    record = json.loads(ran.out)
    assert record["satisfied"] == "yes"
    assert record["bound"]["proven"]
    assert len(record["layout"]["elements"]) == record["bound"]["found"] == 5
    assert len(record["steps"]) == 5
    assert record["verdict"]["satisfied"] == "yes"


def test_what_cannot_be_is_an_exit_code_of_its_own(command: Command, tmp_path: Path) -> None:
    task = saved(tmp_path, PLANAR.replace("limits: {", "limits: {clamps: 1, "))
    ran = command("design", task, "-o", tmp_path / "out.yaml")
    assert ran.code == 1
    assert "at least 2 clamps" in ran.out
    assert not (tmp_path / "out.yaml").exists()


def test_a_start_layout_is_repaired(command: Command, tmp_path: Path) -> None:
    first = tmp_path / "first.yaml"
    assert command("design", saved(tmp_path, PLANAR), "-o", first).code == 0
    text = first.read_text().replace("role: clamp, ", "role: clamp, fixed: true, ", 1)
    less = "\n".join(line for line in text.splitlines() if "name: L2" not in line)
    (tmp_path / "start.yaml").write_text(less + "\n")
    out = tmp_path / "second.yaml"
    ran = command("design", saved(tmp_path, PLANAR + "start: start.yaml\n"), "-o", out)
    assert ran.code == 0, ran.err
    assert ran.out.startswith("added ")
    assert command("verify", out).code == 0
    before, after = read_layout(tmp_path / "start.yaml"), {e.name: e for e in read_layout(out).elements}
    for element in before.elements:
        if element.fixed:
            assert (after[element.name].at == element.at).all()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("spacing: 4", "spacing: 0", "'spacing' is out of range"),
        ("spacing: 4", "spacin: 4", "did you mean 'spacing'"),
        ("spacing: 4", "spacing: 4, points: [[0, 0]]", "'spacing' and 'points' together"),
        ("spacing: 4", "points: [[5, 5]]", "candidate 1"),
        ("spacing: 4", "facets: [9]", "has no facet 9"),
        ("spacing: 4", "keep_out: [{box: [[1, 1], [0, 0]]}]", "lowest"),
        ("spacing: 4", "keep_out: [{box: [[-1, -1], [50, 50]]}]", "no candidate points are left"),
        ("spacing: 4", "grid: {origin: [0, 0], pitch: 1}", "grid"),
        ("spacing: 4", "tip: {pin: {diameter: 4, clearance: 0}}", "tips of this kind"),
        ("spacing: 4", "tip: {pad: [1, 1]}", "needs a direction"),
        ("spacing: 4", "tip: {pad: [1, 1], along: [0, 0]}", "zero length"),
        ("spacing: 4", "tip: {pad: [1, 1], along: [1, 0, 0]}", "2 coordinates"),
        ("spacing: 4", "tip: {sphere: 1, along: [1, 0]}", "takes no direction"),
        ("spacing: 4", "tip: {sphere: 1}, tips: [point]", "'tip' and 'tips' together"),
        ("spacing: 4", "tips: []", "tips"),
        ("spacing: 4", "tips: [point, {soft: -1}]", "out of range"),
        ("spacing: 4", "stem: {radius: 1}", "stems are spatial"),
        ("spacing: 4", "stem: {radius: 0}", "'radius' is out of range"),
        ("spacing: 4", "pins: {clearance: 0, diameters: [1, 2]}", "pins in holes are for spatial parts"),
        ("spacing: 4", "pins: {clearance: -1, diameters: [1, 2]}", "'clearance' is out of range"),
        ("spacing: 4", "pins: {clearance: 1}", "'diameters' is missing"),
        ("spacing: 4", "pins: {clearance: 0, diameters: [1]}", "diameters"),
        ("spacing: 4", "stem: {width: 1}", "unknown key 'width'"),
        ("loading: [-1, -1]", "loading: [0, 0]", "zero length"),
        ("loading: [-1, -1]", "loading: [0, 0, 1]", "2 coordinates"),
        ("loading: [-1, -1]", "clamps: -1", "'clamps' is out of range"),
        ("deterministic,", "determined,", "requirement"),
        ("space: planar", "space: flat", "spatial"),
        ("part: {polygon: [[0, 0], [40, 0], [40, 20], [0, 20]]}", "name: x", "'part' is missing"),
        ("polygon: [[0, 0], [40, 0], [40, 20], [0, 20]]", "mesh: part.stl", "a planar part is a polygon"),
        ("schema: fixture_design/task/1", "schema: fixture_design/graph/1", "classifier"),
        ("units: mm", "units: mm\nobjective: [fewest, fewest]", "twice"),
        ("units: mm", "units: mm\nobjective: []", "objective"),
        ("units: mm", "units: mm\nstart: nowhere.yaml", "no such file"),
    ],
)
def test_wrong_tasks_are_told_in_one_line(command: Command, tmp_path: Path, old: str, new: str, said: str) -> None:
    assert old in PLANAR
    ran = command("design", saved(tmp_path, PLANAR.replace(old, new)))
    assert ran.code == 2, ran.out
    assert said in ran.err
    assert len(ran.err.strip().splitlines()) == 1


def test_what_is_no_part_is_told(command: Command, tmp_path: Path) -> None:
    cut = tmp_path / "cut.stl"
    cut.write_text("solid\n")
    for given, said in ((tmp_path, "this is a folder"), (cut, "no facet")):
        ran = command("design", given)
        assert ran.code == 2
        assert said in ran.err
        assert len(ran.err.strip().splitlines()) == 1


def test_inputs_are_not_overwritten(command: Command, box: Path, tmp_path: Path) -> None:
    before = box.read_bytes()
    for option in ("-o", "--urdf", "--csv"):
        ran = command("design", box, option, box)
        assert ran.code == 2
        assert "is an input" in ran.err
    assert box.read_bytes() == before
    task = saved(tmp_path, PLANAR)
    cutter = tmp_path / "cutter.csv"
    cutter.write_text("x,y,fx,fy\n1,1,1,0\n")
    loaded = tmp_path / "loaded.task.yaml"
    loaded.write_text(PLANAR + "\nloads: [{name: cut, path: cutter.csv}]\n")
    assert command("design", loaded, "--csv", cutter).code == 2
    assert cutter.read_text().startswith("x,y,fx,fy")
    assert command("design", task, "-o", task).code == 2
    assert command("design", task, "-o", tmp_path / "no" / "folder.yaml").code == 2
    assert command("design", tmp_path / "nothing.stl").code == 2
    assert command("design", task, "--scale", "2").code == 2
    assert command("design", task, "--urdf", tmp_path / "out.urdf", "-o", tmp_path / "out.yaml").code == 2
    assert not (tmp_path / "out.yaml").exists()


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_a_stop_saves_the_best_so_far(
    command: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: signal.Signals, code: int
) -> None:
    told = []

    def interrupt(words: str, part: float) -> None:
        told.append(words)
        if len(told) == 3:  # the first way out was searched
            os.kill(os.getpid(), number)

    monkeypatch.setattr("fixture_design.cli.design.shown", interrupt)
    before = signal.getsignal(number)
    try:
        ran = command("design", saved(tmp_path, PLANAR.replace("[-1, -1]", "[0, -1]")), "-o", tmp_path / "out.yaml")
    finally:
        signal.signal(number, before)
    assert ran.code == code
    assert told == ["candidates", "way out 1 of 2", "way out 2 of 2", ""]
    assert len(read_layout(tmp_path / "out.yaml").elements) == 5


def test_new_locators_have_the_tolerance_that_candidates_give(command: Command, tmp_path: Path) -> None:
    given = PLANAR.replace("spacing: 4", "spacing: 4, tolerance: 0.02")
    assert given != PLANAR
    ran = command("design", saved(tmp_path, given), "--json")
    elements = json.loads(ran.out)["layout"]["elements"]
    assert {e["tolerance"] for e in elements if e["role"] == "locator"} == {2e-5}
    assert all("tolerance" not in e for e in elements if e["role"] == "clamp")


def test_friction_that_makes_no_difference_is_told(command: Command, tmp_path: Path) -> None:
    bare = PLANAR[: PLANAR.index("require")] if "require" in PLANAR else PLANAR
    assert "friction: 0" not in bare
    without = command("design", saved(tmp_path, bare), "-o", tmp_path / "out.yaml")
    assert "makes no difference" not in without.out
    told = command("design", saved(tmp_path, bare + "\nfriction: 0.2\n"), "-o", tmp_path / "out.yaml")
    assert "friction 0.2 makes no difference" in told.out


def test_two_outputs_in_one_file_are_refused(command: Command, tmp_path: Path) -> None:
    out = tmp_path / "out.yaml"
    ran = command("design", saved(tmp_path, PLANAR), "-o", out, "--csv", tmp_path / "." / "out.yaml")
    assert ran.code == 2
    assert "two outputs would go to one file" in ran.err
    assert not out.exists()
