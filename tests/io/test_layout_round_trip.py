"""Layouts that are read, written and read again: nothing is lost; units scale lengths and nothing else."""

import dataclasses
import math
import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fixture_design.contacts import ROLES, Contact, Provenance
from fixture_design.errors import FileFormatError, UnsupportedError
from fixture_design.io import layout_from_data, read_layout, text_file, write_layout
from fixture_design.layout import Layout, PinTip, PointTip, Pose, SphereTip
from fixture_design.tolerances import SURFACE_GAP

BRACKET = """
schema: fixture_design/layout/1
name: bracket
space: spatial                     # or planar
part: {urdf: bracket.urdf, pose: {xyz: [0, 0, 0], rpy: [0, 0, 0]}, mass: 1.2, center: [0.03, 0.02, 0.01]}
gravity: [0, 0, -9.81]             # default none
friction: 0.2                      # default 0; also per element, body, contact
surface_gap: 1.0e-5                # an element further than this from the surface is an error
elements:                          # tips that touch the part at the surface point nearest to `at`
  - {name: L1, role: locator, at: [0.02, 0.01, 0], tip: {sphere: 0.004}, tolerance: 2.0e-5}
  - {name: P1, role: locator, at: [0, 0, 0.01], tip: {pin: {diameter: 0.008, clearance: 2.0e-5, shape: round}},
     axis: [0, 0, 1]}
  - {name: K1, role: clamp, at: [0.05, 0.02, 0.03], preload: 200, limits: [0, 500]}
bodies: [{name: vblock, role: locator, urdf: vblock.urdf, pose: {xyz: [0, 0, 0], rpy: [0, 0, 0]}}]
contacts:                          # given outright; a layout may have nothing else
  - {name: Q1, role: locator, point: [1, 1, 0], normal: [0, 1, 0], friction: 0.1}
  - {name: Q2, role: locator, point: [-2, 0, 0], any_of: [[-1, 1, 0], [-1, -1, 0]]}
key_features: [{name: bore, point: [0.04, 0.02, 0.03], direction: [0, 0, 1], tolerance: 5.0e-5}]
loads: [{name: cutting, point: [0, 0, 0.03], force: [0, 300, -100], moment: [0, 0, 0]}]
stages:                            # optional; each is a group
  - {name: seated, active: [locator], gravity: true, require: [deterministic, strongly_accessible, loadable, seated]}
  - {name: clamped, active: [locator, clamp], loads: [cutting], require: [force_closure, holds_loads]}
require: {locators: [deterministic, strongly_accessible], all: [form_closure]}
"""


def assert_same(one: object, other: object, where: str = "layout") -> None:
    """Equal to the last bit; rotations within rounding; source, its places and units may differ."""
    if isinstance(one, np.ndarray):
        assert isinstance(other, np.ndarray), where
        rounding = 1e-15 if where.endswith("rotation") else 0
        assert one.shape == other.shape, where
        assert np.abs(one - other).max(initial=0) <= rounding, where
    elif dataclasses.is_dataclass(one):
        assert type(one) is type(other), where
        for field in dataclasses.fields(one):
            if field.name not in ("source", "units", "places"):
                assert_same(getattr(one, field.name), getattr(other, field.name), f"{where}.{field.name}")
    elif isinstance(one, tuple):
        assert isinstance(other, tuple), where
        assert len(one) == len(other), where
        for index, pair in enumerate(zip(one, other, strict=True)):
            assert_same(*pair, f"{where}[{index}]")
    elif isinstance(one, Mapping):
        assert isinstance(other, Mapping), where
        assert list(one) == list(other), where
        for key in one:
            assert_same(one[key], other[key], f"{where}[{key}]")
    else:
        assert one == other, where
        assert type(one) is type(other), where


def test_the_layout_of_the_format_description_reads(tmp_path: Path) -> None:
    path = tmp_path / "bracket.yaml"
    path.write_text(BRACKET)
    layout = read_layout(path)
    assert layout.part is not None
    assert (layout.part.name, layout.part.file) == ("bracket", tmp_path / "bracket.urdf")
    locator, pin, clamp = layout.elements
    assert locator.tip == SphereTip(0.004)
    assert isinstance(pin.tip, PinTip)
    assert (clamp.tip, clamp.preload, clamp.limits, clamp.friction) == (PointTip(), 200.0, (0.0, 500.0), None)
    assert [contact.friction for contact in layout.contacts] == [0.1, 0.2]
    assert [len(clause) for clause in layout.contacts[1].clauses] == [2]
    assert layout.require["all"] == ("form_closure",)
    assert layout.stages[1].loads == ("cutting",)
    assert layout.source == path
    assert layout.places["part",] == "line 5, part.urdf"
    assert layout.places["elements", "L1"].startswith("line ")
    assert layout.places["elements", "L1"].endswith(", elements[0]")


def test_the_least_layout(tmp_path: Path) -> None:
    path = tmp_path / "least.yaml"
    path.write_text("schema: fixture_design/layout/1\n")
    assert_same(read_layout(path), Layout("least"))


@pytest.mark.parametrize(("units", "per_metre"), [("m", 1.0), ("mm", 1000.0), ("in", 1 / 0.0254)])
def test_units_scale_lengths_and_nothing_else(units: str, per_metre: float) -> None:
    def length(metres: float) -> float:
        return metres * per_metre

    def data(scale: bool) -> dict[str, object]:
        a = length if scale else float
        return {
            "schema": "fixture_design/layout/1", "name": "x", "units": units if scale else "m",
            "gravity": [0, 0, -9.81],
            "part": {"mesh": "a.stl", "scale": 0.001, "pose": {"xyz": [a(1), a(2), a(3)], "rpy": [0.1, 0.2, 0.3]},
                     "center": [a(0.5)] * 3, "form_error": a(0.25), "mass": 2},
            "surface_gap": a(0.5),
            "elements": [
                {"name": "a", "role": "locator", "at": [a(1), 0, 0], "tip": {"pad": [a(2), a(3)], "along": [1, 1, 0]},
                 "tolerance": a(0.5), "stiffness": 7},
                {"name": "b", "role": "clamp", "at": [a(1)] * 3, "tip": {"sphere": a(2)}, "preload": 9,
                 "limits": [1, 9]},
                {"name": "c", "role": "locator", "at": [a(1)] * 3, "tip": {"soft": a(2)}},
                {"name": "d", "role": "locator", "at": [a(1)] * 3, "tip": {"line": a(2), "along": [1, 1, 0]}},
                {"name": "e", "role": "locator", "at": [a(1)] * 3, "axis": [0, 0, 2],
                 "tip": {"pin": {"diameter": a(2), "clearance": a(1)}}},
            ],
            "bodies": [{"name": "v", "role": "locator", "urdf": "v.urdf", "pose": {"xyz": [a(1)] * 3}}],
            "contacts": [{"name": "q", "role": "locator", "point": [a(1), 0, 0], "normal": [0, 0, 3]}],
            "key_features": [{"name": "k", "point": [a(1)] * 3, "direction": [0, 0, 2], "tolerance": a(0.5)}],
            "loads": [{"name": "l", "point": [a(1)] * 3, "force": [1, 2, 3], "moment": [4, 5, 6]}],
            "sweep": {"at": a(0.5), "part_pose": {"xyz": [a(1)] * 3, "rpy": [1, 2, 3]}, "friction": [0.1, 0.2]},
        }  # fmt: skip

    scaled, plain = layout_from_data(data(True), "x.yaml"), layout_from_data(data(False), "x.yaml")
    assert scaled.units == units
    assert_close(scaled, plain)


def assert_close(one: object, other: object) -> None:
    """Equal but for the rounding of a change of units."""
    text = [str(_leaves(value)) for value in (one, other)]
    assert text[0] == text[1]


def _leaves(value: object) -> list[str]:
    if dataclasses.is_dataclass(value):
        pairs = [(field.name, getattr(value, field.name)) for field in dataclasses.fields(value)]
        return [f"{name}: {_leaves(item)}" for name, item in pairs if name not in ("units", "source", "places")]
    if isinstance(value, Mapping):
        return [f"{key}: {_leaves(item)}" for key, item in value.items()]
    if isinstance(value, tuple | list | np.ndarray):
        return [str(_leaves(item)) for item in value]
    return [f"{value:.12g}" if isinstance(value, float) else str(value)]


def test_millimetres_are_the_nearest_metres() -> None:
    for number in range(1, 3000):
        data = {"schema": "fixture_design/layout/1", "units": "mm", "surface_gap": number}
        assert layout_from_data(data, "x").surface_gap == float(f"{number}e-3")


def test_the_default_gap_is_in_metres_whatever_the_units() -> None:
    assert layout_from_data({"schema": "fixture_design/layout/1", "units": "in"}, "x").surface_gap == SURFACE_GAP


NUMBERS = st.floats(-1e6, 1e6, allow_subnormal=False) | st.sampled_from([0.0, 1e-300, 0.1, 1.7e8, 123456.789])
POSITIVE = st.floats(1e-9, 1e6)
FRICTION = st.floats(1e-9, 1e3)
NAMES = st.text(
    st.characters(codec="utf-8", exclude_characters="#", exclude_categories=("C", "Z")), min_size=1, max_size=6
).filter(lambda name: name not in (*ROLES, "locators", "all")) | st.sampled_from(
    ["yes", "1e3", "012", "a: b", "a b", "~"]
)
ANGLES = st.floats(-math.pi, math.pi) | st.sampled_from([0.0, math.pi / 2, 1.5708, math.pi, -math.pi / 2])


def optional(draw: st.DrawFn, key: str, values: st.SearchStrategy[object]) -> dict[str, object]:
    return {key: draw(values)} if draw(st.booleans()) else {}


@st.composite
def layouts(draw: st.DrawFn) -> dict[str, object]:
    """The keys and values of a layout file."""
    planar = draw(st.booleans())
    count = 2 if planar else 3
    vectors = st.lists(NUMBERS, min_size=count, max_size=count)
    directions = vectors.filter(any)
    names = iter(draw(st.lists(NAMES, unique=True, min_size=12, max_size=12)))
    poses = (
        st.fixed_dictionaries({}, optional={"xy": vectors, "theta": ANGLES})
        if planar
        else st.fixed_dictionaries({}, optional={"xyz": vectors, "rpy": st.lists(ANGLES, min_size=3, max_size=3)})
    )
    tips = st.one_of(
        st.just("point"),
        st.fixed_dictionaries({"sphere": POSITIVE}),
        st.fixed_dictionaries({"soft": POSITIVE}),
        st.fixed_dictionaries({"pad": st.lists(POSITIVE, min_size=2, max_size=2), "along": directions}),
        st.fixed_dictionaries({"line": POSITIVE, "along": directions}),
        st.fixed_dictionaries(
            {"pin": st.fixed_dictionaries({"diameter": POSITIVE, "clearance": POSITIVE, "shape": st.just("diamond")}),
             "along": directions}
        ),
    )  # fmt: skip

    def element() -> dict[str, object]:
        role, tip = draw(st.sampled_from(ROLES)), draw(tips)
        data = {"name": next(names), "role": role, "at": draw(vectors), "tip": tip}
        if role == "clamp":
            data |= optional(draw, "preload", POSITIVE)
            data |= optional(draw, "limits", st.lists(POSITIVE, min_size=2, max_size=2).map(sorted))
        if not planar and "pin" in tip:
            data["axis"] = draw(directions)
        data |= optional(draw, "friction", FRICTION)
        for key in ("tolerance", "stiffness"):
            data |= optional(draw, key, POSITIVE)
        return data | optional(draw, "fixed", st.booleans())

    def contact() -> dict[str, object]:
        clauses = st.lists(directions, min_size=1, max_size=3)
        normals = draw(
            st.one_of(
                st.fixed_dictionaries({"normal": directions}),
                st.fixed_dictionaries({"any_of": clauses}),
                st.fixed_dictionaries({"all_of": clauses}),
                st.fixed_dictionaries({"normals": st.lists(clauses, min_size=1, max_size=2)}),
            )
        )
        data = {"name": next(names), "role": draw(st.sampled_from(ROLES)), "point": draw(vectors)}
        return data | normals | optional(draw, "friction", FRICTION | st.just(0.0))

    data: dict[str, object] = {"schema": "fixture_design/layout/1", "space": "planar" if planar else "spatial"}
    data |= optional(draw, "name", NAMES) | optional(draw, "units", st.sampled_from(["m", "mm", "in"]))
    data |= optional(draw, "gravity", vectors) | optional(draw, "friction", FRICTION)
    data |= optional(draw, "surface_gap", POSITIVE)
    geometry = {"polygon": [[0, 0], [draw(POSITIVE), 0], [0, draw(POSITIVE)]]} if planar else {"mesh": "a b/Teil ü.stl"}
    part = (
        geometry | optional(draw, "pose", poses) | optional(draw, "center", vectors) | optional(draw, "mass", POSITIVE)
    )
    data |= {"part": part} if draw(st.booleans()) else {}
    data["elements"] = [element() for _ in range(draw(st.integers(0, 3)))]
    data["contacts"] = [contact() for _ in range(draw(st.integers(0, 3)))]
    if not planar and draw(st.booleans()):
        data["bodies"] = [{"name": next(names), "role": "locator", "urdf": "../v.urdf", "pose": draw(poses)}]
    load = next(names)
    moment = NUMBERS if planar else vectors
    data["loads"] = [{"name": load, "point": draw(vectors), "force": draw(vectors)} | optional(draw, "moment", moment)]
    stage = {"name": next(names), "active": ["locator"], "loads": [load], "require": ["seated", "accurate"]}
    data |= optional(draw, "stages", st.just([stage | optional(draw, "gravity", st.booleans())]))
    data |= optional(draw, "require", st.just({"all": ["form_closure"], "locators": []}))
    return data | optional(draw, "sweep", st.sampled_from([{}, {"samples": 3, "at": 0.1, "friction": [0.1, 1]}]))


@given(data=layouts(), suffix=st.sampled_from(["yaml", "json"]))
def test_what_is_written_reads_the_same(
    tmp_path_factory: pytest.TempPathFactory, data: dict[str, object], suffix: str
) -> None:
    folder = tmp_path_factory.mktemp("layouts")
    layout = layout_from_data(data, folder / "other" / "x.yaml")
    path = folder / f"y.{suffix}"
    write_layout(layout, path)
    again = read_layout(path)
    assert_same(again, layout)
    first = path.read_bytes()
    write_layout(again, path)
    assert_same(read_layout(path), layout)
    assert b"units" not in first


@given(st.lists(st.integers(-314, 314).map(lambda hundredths: hundredths / 100), min_size=3, max_size=3))
def test_short_angles_come_back_to_the_last_bit(angles: list[float]) -> None:
    angles[1] = angles[1] / 2  # beyond a right angle of pitch another triple is as good
    data = {"schema": "fixture_design/layout/1", "part": {"mesh": "a.stl", "pose": {"rpy": angles}}}
    layout = layout_from_data(data, "x.yaml")
    assert layout.part is not None
    assert np.array_equal(written_and_read(layout).rotation, layout.part.pose.rotation)


@pytest.mark.parametrize("sign", [1, -1])
def test_an_exact_right_angle_of_pitch(sign: int) -> None:
    R = np.array([[0, -0.6, sign * 0.8], [0, 0.8, sign * 0.6], [-sign, 0, 0.0]])
    assert np.allclose(R @ R.T, np.eye(3))
    data = {"schema": "fixture_design/layout/1", "part": {"mesh": "a.stl"}}
    layout = layout_from_data(data, "x.yaml")
    assert layout.part is not None
    turned = dataclasses.replace(layout, part=dataclasses.replace(layout.part, pose=Pose(R, np.zeros(3))))
    assert np.abs(written_and_read(turned).rotation - R).max() < 1e-15


def written_and_read(layout: Layout) -> Pose:
    """The part's pose after a round trip, without a file."""
    from fixture_design.io.layout_writing import layout_data  # noqa: PLC0415 - only this test looks behind the writer

    part = layout_from_data(layout_data(layout, Path()), "x.yaml").part
    assert part is not None
    return part.pose


def test_files_are_relative_to_the_new_file(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    data = {"schema": "fixture_design/layout/1", "part": {"step": "parts/x.step"}}
    write_layout(layout_from_data(data, tmp_path / "l.yaml"), tmp_path / "a" / "l.yaml")
    assert "step: ../parts/x.step" in (tmp_path / "a" / "l.yaml").read_text()


def test_what_was_there_stays_if_writing_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "l.yaml"
    path.write_text("precious")

    def fail(source: object, target: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(text_file.os, "replace", fail)
    with pytest.raises(FileFormatError, match=r"l\.yaml: the file cannot be written: No space left on device"):
        write_layout(Layout("x"), path)
    assert path.read_text() == "precious"
    assert os.listdir(tmp_path) == ["l.yaml"]


def test_a_layout_that_would_not_read_is_not_written(tmp_path: Path) -> None:
    path = tmp_path / "l.yaml"
    one = Contact.on_facet("a#1", "locator", [0, 0, 0], [0, 0, 1])
    with pytest.raises(FileFormatError, match=r"contacts\[0\]\.name: 'name' is not usable as a name; found 'a#1'"):
        write_layout(Layout("x", contacts=(one,)), path)
    measured = dataclasses.replace(one, name="a", provenance=Provenance("approximate", 0.1))
    with pytest.raises(UnsupportedError, match="contact 'a' has approximate normals"):
        write_layout(Layout("x", contacts=(measured,)), path)
    with pytest.raises(FileFormatError, match="'friction' is not finite"):
        write_layout(Layout("x", friction=math.inf), path)
    assert not path.exists()


def test_nowhere_to_write(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match="cannot be written: No such file or directory"):
        write_layout(Layout("x"), tmp_path / "none" / "l.yaml")
    with pytest.raises(FileFormatError, match="is a folder"):
        write_layout(Layout("x"), tmp_path)
