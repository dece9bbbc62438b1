"""Lines on facets, along edges and across them, against brute force over random small motions of the part."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fixture_design.analysis import Restraint, form_closure, strongly_accessible
from fixture_design.contacts import Contact, velocity
from fixture_design.errors import GeometryError, UnsupportedError
from fixture_design.geometry import PartGeometry, contacts_of_element, polygon_contacts
from fixture_design.layout import Answer, Element, LineTip, PadTip, Pose
from tests.geometry.parts import box, circle, l_shape, loaded, polygon_part, prism, unit

IDENTITY = Pose.identity(3)
GAP = 1e-5
HALF = np.array([0.025, 0.015, 0.01])


@pytest.fixture(scope="module")
def block(tmp_path_factory: pytest.TempPathFactory) -> PartGeometry:
    return loaded(tmp_path_factory.mktemp("block"), box(*(2 * HALF)))


@pytest.fixture(scope="module")
def ell(tmp_path_factory: pytest.TempPathFactory) -> PartGeometry:
    """Inner edge along z at (0.02, 0.02), 20 mm high."""
    return loaded(tmp_path_factory.mktemp("ell"), l_shape(0.04, 0.02))


def line(geometry: PartGeometry, at: object, length: float, along: object) -> tuple[Contact, ...]:
    tip = LineTip(length, np.array(along, dtype=float))
    return contacts_of_element(Element("E1", "locator", np.array(at, dtype=float), tip), geometry, IDENTITY, 0.2, GAP)


def points(contacts: tuple[Contact, ...]) -> list[list[float]]:
    return (np.round([contact.point for contact in contacts], 12) + 0.0).tolist()


def admits(contacts: tuple[Contact, ...], motion: np.ndarray, slack: float = 0.0) -> bool:
    return all(
        any(unit(normal) @ velocity(motion, contact.point) <= slack for normal in clause)
        for contact in contacts
        for clause in contact.clauses
    )


def test_on_a_facet_its_ends_touch(block: PartGeometry) -> None:
    contacts = line(block, [0.01, 0.003, 0.01], 0.01, [1, 0, 0])
    assert points(contacts) == [[0.005, 0.003, 0.01], [0.015, 0.003, 0.01]]
    assert [contact.name for contact in contacts] == ["E1#1", "E1#2"]
    for contact in contacts:
        ((normal,),) = contact.clauses
        np.testing.assert_array_equal(unit(normal), [0, 0, 1])


def test_overhang_ends_at_the_edge_and_the_projection_counts(block: PartGeometry) -> None:
    assert points(line(block, [0.02, 0.003, 0.01], 0.03, [1, 0, 1])) == [[0.005, 0.003, 0.01], [0.025, 0.003, 0.01]]


def test_gaps_are_bridged(tmp_path: Path) -> None:
    slot = [[0.02, -0.005], [0.03, -0.005], [0.03, 0.005], [0.02, 0.005]]
    plate = loaded(tmp_path, prism([[0, -0.02], [0.06, -0.02], [0.06, 0.02], [0, 0.02]], 0.01, [slot]))
    assert points(line(plate, [0.01, 0, 0.01], 0.06, [1, 0, 0])) == [[0, 0, 0.01], [0.04, 0, 0.01]]
    assert points(line(plate, [0.01, 0, 0.01], 0.03, [1, 0, 0])) == [[0, 0, 0.01], [0.02, 0, 0.01]]


def test_across_an_edge_it_touches_in_the_crossing_point_with_an_or(block: PartGeometry) -> None:
    (contact,) = line(block, [0.025, 0.002, 0.01], 0.02, [1, 0, -1])
    assert contact.name == "E1"
    assert {tuple(unit(n).tolist()) for n in contact.clauses[0]} == {(1, 0, 0), (0, 0, 1)}
    assert points((contact,)) == [[0.025, 0.002, 0.01]]
    oblique = line(block, [0.025, 0.002, 0.01], 0.02, [1, 3, -1])
    assert points(oblique) == [[0.025, 0.002, 0.01]]


def test_from_an_edge_it_may_lie_on_one_of_its_facets(block: PartGeometry) -> None:
    contacts = line(block, [0.025, 0.002, 0.01], 0.02, [1, 0, 0])
    assert points(contacts) == [[0.015, 0.002, 0.01], [0.025, 0.002, 0.01]]
    assert [unit(contact.normals[0]).tolist() for contact in contacts] == [[0, 0, 1]] * 2


def test_into_the_part_is_an_error(block: PartGeometry, ell: PartGeometry) -> None:
    with pytest.raises(GeometryError, match=r"E1.*edge.*cuts 7\.07 mm"):
        line(block, [0.025, 0.002, 0.01], 0.02, [1, 0, 1])
    with pytest.raises(GeometryError, match=r"E1.*cuts 4 mm.*\[0\.02, 0\.02, 0\.01\]"):
        line(ell, [0.026, 0.02, 0.01], 0.02, [1, 0, 0])
    with pytest.raises(GeometryError, match=r"E1.*along the normal"):
        line(block, [0.01, 0.003, 0.01], 0.01, [0, 0, 1])
    with pytest.raises(UnsupportedError, match=r"E1.*apex"):
        line(block, HALF, 0.01, [1, -1, 0])
    assert len(line(ell, [0.026, 0.02, 0.01], 0.012, [1, 0, 0])) == 2


def test_line_across_an_edge_that_meets_the_part_again_is_an_error(tmp_path: Path) -> None:
    outline = [[0, 0], [0.06, 0], [0.06, 0.03], [0.04, 0.03], [0.04, 0.01], [0.02, 0.01], [0.02, 0.02], [0, 0.02]]
    channel = loaded(tmp_path, prism(outline, 0.02))
    assert len(line(channel, [0.02, 0.02, 0.01], 0.02, [1, -0.2, 0])) == 1
    with pytest.raises(GeometryError, match=r"across edge.*cuts .* into 'part'"):
        line(channel, [0.02, 0.02, 0.01], 0.06, [1, -0.2, 0])


def test_along_a_concave_edge_both_ends_have_the_and(ell: PartGeometry) -> None:
    contacts = line(ell, [0.02, 0.02, 0.008], 0.03, [0, 0, 1])
    assert points(contacts) == [[0.02, 0.02, 0.0], [0.02, 0.02, 0.02]]
    assert all([len(clause) for clause in contact.clauses] == [1, 1] for contact in contacts)


def test_along_a_convex_edge_the_true_set_lies_within_what_the_error_allows(block: PartGeometry) -> None:
    """Both normals at both ends: a motion that all of them admit is admissible; one that is, some choice admits."""
    contacts = line(block, [0.025, 0.015, 0.001], 0.01, [0, 0, 1])
    assert points(contacts) == [[0.025, 0.015, -0.004], [0.025, 0.015, 0.006]]
    mean = unit([1, 1, 0])
    for contact in contacts:
        np.testing.assert_allclose(unit(contact.normals[0]), mean)
        assert contact.provenance.normal_error == pytest.approx(np.pi / 4)
    rng = np.random.default_rng(2)
    along = np.column_stack([np.full(41, 0.025), np.full(41, 0.015), np.linspace(-0.004, 0.006, 41)])
    seen = {True: 0, False: 0}
    for motion in rng.normal(size=(3000, 6)) * [1, 1, 1, 200, 200, 200]:
        moved = (motion[:3] + np.cross(motion[3:], along))[:, :2]
        true = bool((moved.min(axis=1) <= 0).all())
        # contacts are at the first and the last of the points, and the normals are x and y
        inner = bool((moved[[0, -1]].max(axis=1) <= 0).all())
        outer = bool((moved[[0, -1]].min(axis=1) <= 0).all())
        assert inner <= true <= outer
        seen[true] += 1
    assert min(seen.values()) > 300


def test_a_line_along_an_edge_claims_nothing_that_is_not_so(block: PartGeometry) -> None:
    """Two contacts cannot close, but the part may be stuck on the edge as far as the bracket tells."""
    restraint = Restraint.of(line(block, [0.025, 0.015, 0.0], 0.01, [0, 0, 1]))
    assert form_closure(restraint).answer is not Answer.YES
    assert strongly_accessible(restraint).answer is not Answer.NO


def test_line_on_a_facet_admits_what_the_solid_admits(ell: PartGeometry) -> None:
    """Brute force: the part moved a little; no point of the line may then be inside it."""
    contacts = line(ell, [0.03, 0.02, 0.01], 0.01, [1, 0, 0.5])
    direction = unit([1, 0, 0.5])
    ends = np.array([0.03, 0.02, 0.01]) + np.outer(np.linspace(-0.005, 0.005, 21), direction)
    rng = np.random.default_rng(4)
    seen = {True: 0, False: 0}
    for motion in rng.normal(size=(150, 6)) * [1, 1, 1, 150, 150, 150]:
        margin = max(contact.normals[0] @ velocity(motion, contact.point) for contact in contacts)
        step = 1e-6
        # the part moves by the motion, the line by its reverse in the part
        inside = [ell.surface.at(p - step * velocity(motion, p))[0] < -1e-9 for p in ends]
        assert any(inside) != admits(contacts, motion) or abs(margin) < 1e-2
        seen[any(inside)] += 1
    assert min(seen.values()) > 20


def test_along_a_shaft_both_ends_have_its_normal(tmp_path: Path) -> None:
    shaft = loaded(tmp_path, prism(circle(0.01, 48), 0.03))
    for angle in (0.03, np.pi / 48, 2.2):
        radial = np.array([np.cos(angle), np.sin(angle), 0.0])
        contacts = line(shaft, 0.01 * radial + [0, 0, 0.02], 0.05, [0, 0, -1])
        np.testing.assert_allclose([c.point for c in contacts], 0.01 * radial + [[0, 0, 0], [0, 0, 0.03]], atol=1e-8)
        for contact in contacts:
            np.testing.assert_allclose(contact.normals[0], radial, atol=1e-6)
            assert contact.provenance.kind == "fitted"
    inside = line(shaft, 0.01 * radial + [0, 0, 0.02], 0.006, [0, 0, 1])
    np.testing.assert_allclose([c.point[2] for c in inside], [0.017, 0.023], atol=1e-12)
    with pytest.raises(GeometryError, match=r"E1.*along its axis.*off"):
        line(shaft, 0.01 * radial + [0, 0, 0.02], 0.01, [0, 1, 0.3])


def test_along_a_bore_the_normals_point_to_the_axis(tmp_path: Path) -> None:
    outline = [[-0.03, -0.03], [0.03, -0.03], [0.03, 0.03], [-0.03, 0.03]]
    bore = loaded(tmp_path, prism(outline, 0.02, [circle(0.01, 48)]))
    contacts = line(bore, [0.01, 0, 0.005], 0.016, [0, 0, 1])
    np.testing.assert_allclose([c.point for c in contacts], [[0.01, 0, 0], [0.01, 0, 0.013]], atol=1e-8)
    np.testing.assert_allclose([c.normals[0] for c in contacts], [[-1, 0, 0]] * 2, atol=1e-6)


SQUARE = [[0, 0], [2, 0], [2, 2], [0, 2]]
NOTCHED = [[0, 0], [4, 0], [4, 3], [3, 3], [3, 1], [1, 1], [1, 3], [0, 3]]


def flat(outline: list, at: object, tip: LineTip | PadTip) -> tuple[Contact, ...]:
    element = Element("E1", "locator", np.array(at, dtype=float), tip)
    return polygon_contacts(element, polygon_part(outline), 0.2, GAP)


def test_planar_lines_and_pads_touch_with_their_ends() -> None:
    for tip in (LineTip(1.0, np.array([1.0, 0])), PadTip(1.0, 7.0, np.array([1.0, 0.2]))):
        contacts = flat(SQUARE, [1.2, 2], tip)
        assert points(contacts) == [[0.7, 2], [1.7, 2]]
        assert [contact.name for contact in contacts] == ["E1#1", "E1#2"]
        assert [unit(contact.normals[0]).tolist() for contact in contacts] == [[0, 1]] * 2
    assert points(flat(SQUARE, [1.2, 2], LineTip(9.0, np.array([1.0, 0])))) == [[0, 2], [2, 2]]
    assert points(flat(NOTCHED, [0.5, 3], LineTip(5.2, np.array([1.0, 0])))) == [[0, 3], [3.1, 3]]


def test_planar_line_at_an_apex() -> None:
    (contact,) = flat(SQUARE, [2, 2], LineTip(1.0, np.array([1.0, -1])))
    assert len(contact.clauses[0]) == 2
    assert points(flat(SQUARE, [2, 2], LineTip(1.0, np.array([1.0, 0])))) == [[1.5, 2], [2, 2]]
    with pytest.raises(GeometryError, match="cuts"):
        flat(SQUARE, [2, 2], LineTip(1.0, np.array([1.0, 1])))


def test_planar_line_between_walls_is_an_error() -> None:
    assert points(flat(NOTCHED, [2, 1], LineTip(2.0, np.array([1.0, 0])))) == [[1, 1], [3, 1]]
    with pytest.raises(GeometryError, match=r"E1.*cuts 500 mm .*\[1\.0, 1\.0\]|E1.*cuts 500 mm .*\[3\.0, 1\.0\]"):
        flat(NOTCHED, [2, 1], LineTip(3.0, np.array([1.0, 0])))
    with pytest.raises(GeometryError, match="cuts"):
        flat(NOTCHED, [1, 1], LineTip(1.0, np.array([1.0, 0])))
