"""Friction: exact in the plane, bracketed in space; published cases; the circular cone as the judge of motions."""

import numpy as np
import pytest

from fixture_design.analysis import Restraint, force_closure
from fixture_design.contacts import Contact
from fixture_design.layout import Answer, Layout, Motion, Pose
from fixture_design.verification import check, verify
from tests.problems import CLOSURE_CASES, ClosureCase


@pytest.mark.parametrize("case", CLOSURE_CASES, ids=lambda case: case.name)
def test_published_cases(case: ClosureCase) -> None:
    contacts = tuple(case.contacts)
    verdict = verify(Layout("published", "planar" if contacts[0].dimension == 3 else "spatial", contacts=contacts))
    question = "form_closure" if case.friction is None else "force_closure"
    assert verdict.groups["all"].findings[question].answer is Answer.of(case.closed)
    assert check(verdict) == []


def antipodal(friction: float, *more: Contact) -> Restraint:
    pair = [Contact.on_facet(f"F{i}", "finger", [s, 0, 0], [s, 0, 0], friction) for i, s in enumerate((1, -1))]
    return Restraint.of([*pair, *more])


@pytest.mark.parametrize("friction", [0.01, 0.5, 3.0])
def test_two_antipodal_points_spin_about_their_line(friction: float) -> None:
    finding = force_closure(antipodal(friction))
    assert finding.answer is Answer.NO
    assert isinstance(finding.evidence, Motion)
    assert np.abs(finding.evidence.motion[[0, 1, 2, 4, 5]]).max() < 1e-9


def test_a_third_point_stops_the_spin() -> None:
    assert (
        force_closure(antipodal(0.5, Contact.on_facet("F2", "finger", [0, 1, 0], [0, 1, 0], 0.5))).answer is Answer.YES
    )


def two_pairs(offset: float, friction: float) -> Restraint:
    """Two parallel pairs of opposed fingers whose lines make the angle atan(offset) with their normals.

    The couple of a pair's normal forces needs friction of at least offset: closed if and only if mu > offset.
    """
    fingers = [([0, y, 1], [0, 0, 1]) for y in (0, 1)] + [([2 * offset, y, -1], [0, 0, -1]) for y in (0, 1)]
    return Restraint.of([Contact.on_facet(f"F{i}", "finger", p, n, friction) for i, (p, n) in enumerate(fingers)])


@pytest.mark.parametrize(
    ("offset", "answer"), [(0.49, Answer.YES), (0.51, Answer.NO), (0.4999, Answer.YES), (0.5001, Answer.NO)]
)
def test_threshold_in_space(offset: float, answer: Answer) -> None:
    assert force_closure(two_pairs(offset, 0.5)).answer is answer


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.39])
@pytest.mark.parametrize("offset", [0.4999, 0.49, 0.51, 0.5001])
def test_the_margin_goes_with_the_answer_however_the_layout_is_turned(offset: float, angle: float) -> None:
    turn = Pose.from_xyz_rpy([0, 0, 0], [0, 0, angle])
    contacts = [
        Contact.on_facet(
            c.name, "finger", turn.points(c.point[None])[0], turn.vectors(c.normals[0][None])[0], c.friction
        )
        for c in two_pairs(offset, 0.5).contacts
    ]
    finding = force_closure(Restraint.of(contacts))
    assert finding.answer is (Answer.YES if offset < 0.5 else Answer.NO)
    assert finding.edges is not None
    if finding.margin is not None:
        assert (finding.margin > 0) is (finding.answer is Answer.YES)


def test_exact_tie_in_space_is_never_yes() -> None:
    assert force_closure(two_pairs(0.5, 0.5)).answer is not Answer.YES


def test_number_of_edges_is_stated() -> None:
    third = Contact.on_facet("F2", "finger", [0, 1, 0], [0, 1, 0], 0.5)
    finding = force_closure(antipodal(0.5, third))
    assert finding.edges is not None
    assert isinstance(finding.evidence, tuple)
    assert {len(values) for values in finding.evidence[0].weights.values()} == {finding.edges}
