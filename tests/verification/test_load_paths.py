"""Load paths from CSV files, and layouts with loads from the file to the verdict; wrong files say what is wrong."""

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fixture_design as fd
from fixture_design.errors import FileFormatError, InputError
from fixture_design.layout import Answer, Layout, Load
from fixture_design.verification import load_paths
from fixture_design.verification.load_paths import read_load_path

HEAD = "x,y,z,fx,fy,fz\n"


def rows_of(folder: Path, text: str | bytes, space: str = "spatial", units: str = "m"):
    path = folder / "path.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_load_path(path, Load("cutter", path=path), Layout("x", space=space, units=units))


def test_a_row_is_a_force_in_a_point(tmp_path):
    (row,) = rows_of(tmp_path, HEAD + "1,2,3,0,0,5\n")
    assert (row.load, row.row) == ("cutter", 1)
    assert row.wrench == pytest.approx([0, 0, 5, 10, -5, 0])


def test_moments_are_free_and_columns_in_any_order(tmp_path):
    first, second = rows_of(
        tmp_path, "\ufeffmx,my,mz,fz,fy,fx,z,y,x\n\n# a note\n1,2,3,5,0,0,3,2,1\n0,0,0,0,0,0,0,0,0\n"
    )
    assert first.wrench == pytest.approx([0, 0, 5, 11, -3, 3])
    assert (second.row, second.wrench.tolist()) == (2, [0.0] * 6)


@pytest.mark.parametrize(("units", "metres"), [("m", 1.0), ("mm", 1e-3), ("in", 0.0254)])
def test_points_are_in_the_layouts_unit(tmp_path, units, metres):
    (row,) = rows_of(tmp_path, "x,y,fx,fy,m\n2,0,0,10,7\n", "planar", units)
    assert row.wrench == pytest.approx([0, 10, 20 * metres + 7])


WRONG = {
    "empty": ("", "is empty"),
    "blank lines": ("\n\n", "is empty"),
    "no rows": (HEAD, "has a header and no rows"),
    "no header": ("1,2,3,4,5,6\n", "no column 'x'"),
    "a column is missing": ("x,y,fx,fy,fz\n1,2,3,4,5\n", "no column 'z'"),
    "an unknown column": ("x,y,z,fx,fy,fz,t\n", "unknown column 't'"),
    "a column twice": ("x,y,z,fx,fy,fz,x\n", "the column 'x' is there twice"),
    "one moment": ("x,y,z,fx,fy,fz,mx\n1,2,3,4,5,6,7\n", "moments have only the column 'mx'"),
    "planar": ("x,y,fx,fy\n1,2,3,4\n", "no column 'z', 'fz'"),
    "too few cells": (HEAD + "1,2,3,4,5\n", "line 2: row 1 has 5 cells for 6 columns"),
    "too many cells": (HEAD + "1,2,3,4,5,6\n1,2,3,4,5,6,7\n", "line 3: row 2 has 7 cells for 6 columns"),
    "text": (HEAD + "1,2,3,4,5,6\n1,2,3,a,5,6\n", "line 3, row 2, column fx: a number is missing; found 'a'"),
    "an empty cell": (HEAD + "1,2,3,4,5,\n", "line 2, row 1, column fz: a number is missing"),
    "NaN": (HEAD + "1,2,3,nan,5,6\n", "column fx: not a usable number; found 'nan'"),
    "infinite": (HEAD + "1,2,3,4,inf,6\n", "column fy: not a usable number"),
    "far": (HEAD + "1e300,2,3,4,5,6\n", "column x: not a usable number; found '1e300'; expected a finite number up to"),
    "large": (HEAD + "1,2,3,1e300,5,6\n", "column fx: not a usable number"),
    "underscores": (HEAD + "1,2,3,1_0,5,6\n", "column fx: not a usable number"),
    "semicolons": ("x;y;z;fx;fy;fz\n1;2;3;4;5;6\n", "no column 'x'"),
    "no text": (b"\xff\xfe\x00", "it is no text in UTF-8"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_files(tmp_path, case):
    text, said = WRONG[case]
    with pytest.raises(FileFormatError) as caught:
        rows_of(tmp_path, text)
    assert said in str(caught.value)
    assert "path.csv" in str(caught.value)


def test_files_that_are_not_there(tmp_path):
    for path in (tmp_path / "none.csv", tmp_path):
        with pytest.raises(FileFormatError, match="cannot be read"):
            read_load_path(path, Load("cutter", path=path), Layout("x"))


def test_too_many_rows(tmp_path, monkeypatch):
    monkeypatch.setattr(load_paths, "MOST_ROWS", 3)
    assert len(rows_of(tmp_path, "x,y,fx,fy\n" + "0,0,0,1\n" * 3, "planar")) == 3
    with pytest.raises(FileFormatError, match="more than 3 rows"):
        rows_of(tmp_path, "x,y,fx,fy\n" + "0,0,0,1\n" * 4, "planar")


#: A square on two supports and a stop, with a clamp from above and one from the side; lengths in millimetres.
SQUARE = """schema: fixture_design/layout/1
space: planar
units: mm
part: {{polygon: [[0, 0], [100, 0], [100, 100], [0, 100]], mass: 2, center: [50, 50]{pose}}}
gravity: [0, -10]
friction: {friction}
elements:
  - {{name: S1, role: locator, at: [20, 0]}}
  - {{name: S2, role: locator, at: [80, 0]}}
  - {{name: S3, role: locator, at: [0, 30]}}
  - {{name: K1, role: clamp, at: [50, 100], preload: 200, limits: [0, 500]}}
  - {{name: K2, role: clamp, at: [100, 30], preload: 100, limits: [0, 500]}}
loads:
  - {{name: lift, point: [50, 50], force: [0, {lift}]}}
  - {{name: cutter, path: cutter.csv}}
require: {{all: [seated, holds_loads]}}
"""


def square(
    folder: Path, lift: float = 100, path: str = "50,50,50,0\n0,0,0,0\n", friction: float = 0, pose=""
) -> Layout:
    (folder / "cutter.csv").write_text("x,y,fx,fy\n" + path)
    file = folder / "square.yaml"
    file.write_text(SQUARE.format(lift=lift, friction=friction, pose=pose))
    return fd.read_layout(file)


def test_from_the_file_to_the_verdict(tmp_path):
    verdict = fd.verify(square(tmp_path))
    assert fd.check(verdict) == []
    assert verdict.satisfied is Answer.YES
    held = verdict.groups["all"].findings["holds_loads"].use
    assert [(v.load, v.row) for v in held.loads] == [("lift", None), ("cutter", 1), ("cutter", 2)]
    # weight 20 N and clamp 200 N against 100 N; the side clamp's 100 N against 50 N, at the height of their line
    assert held.loads[0].reserve == pytest.approx((2.2, 2.2))
    assert held.worst == 1
    assert held.loads[2].reserve == (np.inf, np.inf)
    assert held.preloads == {"K1": 200.0, "K2": 100.0}
    assert sum(held.least_preloads.values()) < 300
    seat = verdict.groups["all"].findings["seated"].use.steps[-1]
    assert seat.reactions["S3"] == pytest.approx((100, 100))


def test_what_fails_is_named(tmp_path):
    verdict = fd.verify(square(tmp_path, lift=230))
    assert fd.check(verdict) == []
    assert verdict.satisfied is Answer.NO
    held = verdict.groups["all"].findings["holds_loads"].use
    assert held.worst == 0
    assert held.loads[0].reserve == pytest.approx((22 / 23, 22 / 23))


def test_a_tie_is_undecided(tmp_path):
    verdict = fd.verify(square(tmp_path, lift=220))
    finding = verdict.groups["all"].findings["holds_loads"]
    assert finding.answer is Answer.UNDECIDED
    assert finding.reason.startswith("lift: a tie")


def test_the_centre_of_mass_is_the_parts(tmp_path):
    """Turned by a half about the square's own middle, the centre is where it was."""
    turned = fd.verify(square(tmp_path, pose=", pose: {xy: [100, 100], theta: 3.141592653589793}"))
    assert fd.check(turned) == []
    held = turned.groups["all"].findings["holds_loads"].use
    assert held.loads[0].reserve == pytest.approx((2.2, 2.2))


@pytest.mark.parametrize("friction", [0, 0.2, 1000])
@pytest.mark.parametrize("force", [1e-9, 1.0, 1e9, 1e12])
def test_extreme_numbers_give_answers(tmp_path, friction, force):
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        verdict = fd.verify(square(tmp_path, force, f"50,50,{force},{-force}\n", friction))
    assert fd.check(verdict) == []
    if friction == 0:
        lift = verdict.groups["all"].findings["holds_loads"].use.loads[0]
        assert lift.answer is (Answer.YES if force < 220 else Answer.NO)


def test_a_wrong_path_says_where_the_layout_names_it(tmp_path):
    layout = square(tmp_path, path="1,2,3\n")
    with pytest.raises(FileFormatError) as caught:
        fd.verify(layout)
    assert "cutter.csv: line 2: row 1 has 3 cells" in str(caught.value)
    assert "named at line 15, loads[1]" in str(caught.value)


@pytest.mark.parametrize(
    "changed",
    [
        ("mass: 2", "mass: 1e300"),
        ("center: [50, 50]", "center: [1e300, 50]"),
        ("gravity: [0, -10]", "gravity: [0, -1e300]"),
        ("preload: 200", "preload: 1e300"),
        ("preload: 200", "preload: -1"),
        ("limits: [0, 500]}}\n  - {{name: K2", "limits: [0, 1e300]}}\n  - {{name: K2"),
        ("force: [0, {lift}]", "force: [0, 1e300]"),
        ("point: [50, 50]", "point: [50, 1e300]"),
        ("force: [0, {lift}]", "force: [0, .nan]"),
        ("force: [0, {lift}]", "moment: 1e300"),
        ("at: [20, 0]", "at: [20, 0], stiffness: 1e300"),
        ("at: [20, 0]", "at: [20, 0], tolerance: 1e300"),
    ],
)
def test_numbers_that_nobody_can_mean(tmp_path, changed):
    assert changed[0] in SQUARE
    file = tmp_path / "wrong.yaml"
    file.write_text(SQUARE.replace(*changed, 1).format(lift=1, friction=0, pose=""))
    with pytest.raises(InputError, match=r"out of range|is not finite"):
        fd.read_layout(file)


def test_loads_are_asked_only_where_they_are_required(tmp_path):
    layout = square(tmp_path)
    (tmp_path / "cutter.csv").unlink()
    assert "holds_loads" not in fd.verify(replace(layout, require={})).groups["all"].findings
