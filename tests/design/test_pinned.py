"""The plane and two pins: a round and a diamond pin in the part's holes, three points, and one clamp."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import shapely
import trimesh
import yourdfpy

from fixture_design.arrays import Point
from fixture_design.contacts import Contact
from fixture_design.design import CandidateRules, DesignResult, Limits, PinRules, Task, design
from fixture_design.io import write_urdf
from fixture_design.layout import Answer, Element, KeyFeature, Layout, Part, PinTip, Pose
from fixture_design.verification import check
from tests.design.fakes import Fake, box, task
from tests.geometry.parts import part, shared

PINS = PinRules(2.0e-5, (0.004, 0.02))
REQUIRE = {"locators": ("deterministic", "loadable"), "all": ("form_closure",)}


def plate(folder: Path, *holes: tuple[float, float, float], slot: bool = False) -> Part:
    """A plate with through holes (x, y, radius)."""
    outline = shapely.box(0, 0, 0.1, 0.06)
    for x, y, radius in holes:
        outline = outline.difference(shapely.Point(x, y).buffer(radius, quad_segs=16))
    if slot:
        outline = outline.difference(shapely.LineString([(0.075, 0.03), (0.087, 0.03)]).buffer(0.003, quad_segs=16))
    trimesh.creation.extrude_polygon(outline, 0.012).export(folder / "plate.stl")
    return part(folder / "plate.stl")


def designed(solid: Part, rules: PinRules | None = PINS, **keys: object) -> DesignResult:
    keys.setdefault("require", REQUIRE)
    return design(Task("pins", solid, candidates=CandidateRules(pins=rules), **keys))  # type: ignore[arg-type]


def pins(result: DesignResult) -> list[Element]:
    """The pins of a layout that holds, seen to be five locators and as many clamps as are asked for."""
    assert result.satisfied is Answer.YES, result.reason
    assert result.verdict is not None
    assert result.layout is not None
    assert check(result.verdict) == []
    return sorted((e for e in result.layout.elements if isinstance(e.tip, PinTip)), key=lambda e: e.name)


def counts(result: DesignResult) -> tuple[int, int]:
    assert result.layout is not None
    roles = [element.role for element in result.layout.elements]
    return roles.count("locator"), roles.count("clamp")


def test_two_holes_take_a_round_and_a_diamond_pin(tmp_path: Path) -> None:
    result = designed(plate(tmp_path, (0.015, 0.015, 0.004), (0.085, 0.045, 0.005)))
    first, second = pins(result)
    assert counts(result) == (5, 1)
    assert [pin.tip.shape for pin in (first, second)] == ["round", "diamond"]  # type: ignore[union-attr]
    line = second.at - first.at
    assert abs(second.tip.along @ line) < 1e-9  # type: ignore[union-attr]
    for pin in (first, second):
        assert np.abs(pin.axis).round(9).tolist() == [0, 0, 1]  # type: ignore[arg-type]
        assert pin.axis @ result.out == pytest.approx(1)  # type: ignore[operator]
    assert {round(pin.tip.diameter + pin.tip.clearance, 6) for pin in (first, second)} == {0.008, 0.01}  # type: ignore[union-attr]
    assert result.bound is not None
    assert (result.bound.locators, result.bound.clamps, result.bound.gap) == (5, 1, 0)
    assert [step.element for step in result.steps if step.element.startswith("P")] == ["P1", "P2"]


def test_the_rows_locate_without_saying_anything_twice(tmp_path: Path) -> None:
    result = designed(plate(tmp_path, (0.015, 0.015, 0.004), (0.085, 0.045, 0.005)))
    assert pins(result)
    rows = []
    for contact in result.verdict.contacts:  # type: ignore[union-attr]
        if contact.role == "locator":
            n = contact.normals[0] / np.linalg.norm(contact.normals[0])
            rows.append(np.concatenate([n, np.cross(contact.point, n) / 0.05]))
    different = []
    for row in rows:  # both walls of a pin locate the same thing
        if all(min(np.abs(row - other).max(), np.abs(row + other).max()) > 1e-6 for other in different):
            different.append(row)
    assert len(different) == 6
    assert np.linalg.matrix_rank(np.array(different), 1e-6) == 6


def test_the_two_holes_that_are_furthest_apart_are_taken(tmp_path: Path) -> None:
    holes = [(0.012, 0.012, 0.004), (0.03, 0.03, 0.004), (0.05, 0.02, 0.004), (0.088, 0.048, 0.004)]
    feature = KeyFeature("corner", np.array([0.1, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), 1e-4)
    result = designed(plate(tmp_path, *holes), key_features=(feature,))
    first, second = pins(result)
    assert np.linalg.norm(first.at - second.at) == pytest.approx(np.hypot(0.076, 0.036), abs=1e-6)


def test_a_slot_takes_a_round_pin_in_place_of_the_diamond(tmp_path: Path) -> None:
    result = designed(plate(tmp_path, (0.015, 0.03, 0.004), slot=True))
    first, second = pins(result)
    assert [pin.tip.shape for pin in (first, second)] == ["round", "round"]  # type: ignore[union-attr]
    assert counts(result) == (5, 1)


def test_the_part_comes_off_against_the_direction_in_which_it_is_loaded(tmp_path: Path) -> None:
    solid = plate(tmp_path, (0.015, 0.015, 0.004), (0.085, 0.045, 0.005))
    for way in ([0.0, 0, -1], [0.0, 0, 1]):
        result = designed(solid, limits=Limits(loading=np.array(way)))
        assert pins(result)
        assert result.out == pytest.approx(-np.array(way))


@pytest.mark.parametrize(
    "holes",
    [
        [],
        [(0.05, 0.03, 0.004)],
        [(0.015, 0.015, 0.001), (0.085, 0.045, 0.001)],  # too thin
        [(0.02, 0.03, 0.015), (0.08, 0.03, 0.015)],  # too wide
    ],
)
def test_without_two_holes_it_goes_on_without_pins_and_says_so(
    tmp_path: Path, holes: list[tuple[float, float, float]]
) -> None:
    result = designed(plate(tmp_path, *holes))
    assert pins(result) == []
    assert counts(result) == (6, 1)  # the part slides out along the sides, where a screw motion leaves all of them
    assert any("without pins" in note for note in result.notes)


def test_pins_are_not_used_unless_asked_for(tmp_path: Path) -> None:
    result = designed(plate(tmp_path, (0.015, 0.015, 0.004), (0.085, 0.045, 0.005)), None)
    assert pins(result) == []
    assert not any("pins" in note for note in result.notes)


def test_a_disc_that_would_spin_is_held_by_its_holes(tmp_path: Path) -> None:
    outline = shapely.Point(0, 0).buffer(0.05, quad_segs=32)
    for x in (-0.03, 0.03):
        outline = outline.difference(shapely.Point(x, 0).buffer(0.004, quad_segs=16))
    trimesh.creation.extrude_polygon(outline, 0.012).export(tmp_path / "disc.stl")
    result = designed(part(tmp_path / "disc.stl"))
    assert len(pins(result)) == 2
    assert counts(result) == (5, 1)


def test_a_moved_plate_is_pinned_along_its_own_holes(tmp_path: Path) -> None:
    solid = plate(tmp_path, (0.015, 0.015, 0.004), (0.085, 0.045, 0.005))
    pose = Pose.from_xyz_rpy(np.array([0.3, -0.2, 0.1]), np.array([0.4, -0.3, 1.1]))
    result = designed(Part(solid.name, "mesh", solid.file, None, 1.0, pose))
    assert len(pins(result)) == 2
    assert abs(result.out @ pose.rotation[:, 2]) == pytest.approx(1)  # type: ignore[operator]


def test_pins_of_the_urdf_are_in_their_holes_and_their_bodies_outside(tmp_path: Path) -> None:
    solid = plate(tmp_path, (0.015, 0.015, 0.004), (0.085, 0.045, 0.005))
    result = designed(solid)
    assert pins(result)
    write_urdf(result.layout, result.verdict, tmp_path / "out.urdf")  # type: ignore[arg-type]
    robot = yourdfpy.URDF.load(str(tmp_path / "out.urdf"), load_meshes=False)
    mesh = trimesh.load(solid.file, force="mesh")
    mesh.apply_scale(1000)
    for pin in pins(result):
        pose = robot.get_transform(pin.name, "fixture")
        assert pose[:3, 2] == pytest.approx(-np.asarray(pin.axis), abs=1e-9)
        for collision in robot.link_map[pin.name].collisions:
            size = collision.geometry.cylinder
            column = trimesh.creation.cylinder(999 * size.radius, 1000 * size.length, sections=16)
            place = pose @ collision.origin
            place[:3, 3] *= 1000
            column.apply_transform(place)
            common = trimesh.boolean.intersection([column, mesh], engine="manifold")
            assert abs(common.volume) < 2e-3 * column.volume  # facets of the bore


def test_a_real_part_is_pinned() -> None:
    result = designed(part(shared("trimesh/models/featuretype.STL"), 0.0254))
    assert len(pins(result)) == 2
    assert counts(result) == (5, 1)


@dataclass(frozen=True, eq=False)
class _Bore:
    feature: str
    low: Point
    high: Point
    diameter: float
    across: Point | None = None


@dataclass(frozen=True, eq=False)
class Bored(Fake):
    """A box with two bores along z, without any geometry."""

    def holes(self) -> tuple[_Bore, ...]:
        return tuple(
            _Bore(f"cylinder {k}", np.array([x, 0.0, -0.02]), np.array([x, 0.0, 0.02]), 0.008)
            for k, x in enumerate((-0.03, 0.03), start=1)
        )

    def contacts(self, layout: Layout) -> tuple[Contact, ...]:
        found = []
        for element in layout.elements:
            if not isinstance(element.tip, PinTip):
                found += super().contacts(Layout("alone", elements=(element,), friction=layout.friction))
                continue
            first = np.array([1.0, 0, 0]) if element.tip.along is None else element.tip.along
            ways = [first, -first]
            if element.tip.shape == "round":
                ways += [np.cross(element.axis, first), -np.cross(element.axis, first)]
            for number, way in enumerate(ways, start=1):
                unit = way / np.linalg.norm(way)
                found.append(
                    Contact(
                        f"{element.name}#{number}", element.role, element.at + 0.004 * unit, ((-unit,),), 0.0,
                        distance=0.0, feature="cylinder", clearance=element.tip.clearance,
                    )
                )  # fmt: skip
        return (*found, *layout.contacts)


def test_pins_need_no_geometry_of_their_own() -> None:
    spots = box(8)
    asked = task(spots, candidates=CandidateRules(pins=PINS), require=REQUIRE)
    result = design(asked, Bored(spots, frozenset({"deterministic", "loadable", "form_closure"})))
    assert len(pins(result)) == 2
    assert counts(result) == (5, 1)
