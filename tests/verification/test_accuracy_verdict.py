"""`accurate` in the pipeline: asked where it is required, and confirmed only with evidence that proves it."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fixture_design.io import read_layout
from fixture_design.layout import Answer, Element, FeatureError, Finding, Layout, LocatingErrors, PinTip, Rocking, Stage
from fixture_design.verification import check, verify
from fixture_design.verification.accuracy_proofs import accuracy_fault
from tests.analysis.locators import ROUND, THREE_TWO_ONE, UNDER, asked, evidence, feature, pad, pin, tip
from tests.geometry.parts import circle, part, polygon_part, prism, write

UM = 1e-6
ALIKE = dict.fromkeys("ABCDEFGPQ", 10 * UM)
ABOVE = feature([0.05, 0.08, 0.04], [0.2, 0.3, 1.0], 100 * UM)
FOUR_TWO_ONE = [*THREE_TWO_ONE, tip("G", [0.05, -0.05, 0], [0, 0, -1])]
PADS = [*pad("A", (0.01, 0.01, 0), 0.01), *pad("B", (0.09, 0.02, 0), 0.01), *THREE_TWO_ONE[2:]]
PINS = [*UNDER, *pin("P", [0.02, 0.04, 0.01], 0.004, 0.0, ROUND), *pin("Q", [0.08, 0.04, 0.01], 0.004, 0.0, ROUND)]
CASES = {"3-2-1": list(THREE_TWO_ONE), "4-2-1": FOUR_TWO_ONE, "pads": PADS, "pins": PINS}


def layout(tolerance: float) -> Layout:
    """A plate of 100 x 80 mm on two tips and against one, with a clamp above."""
    spots = {"A": (0.01, 0.0), "B": (0.09, 0.0), "F": (0.0, 0.04)}
    locators = [Element(name, "locator", np.array(spot), tolerance=10 * UM) for name, spot in spots.items()]
    return Layout(
        "plate",
        "planar",
        part=polygon_part([[0, 0], [0.1, 0], [0.1, 0.08], [0, 0.08]]),
        elements=(*locators, Element("K", "clamp", np.array([0.05, 0.08]))),
        key_features=(feature([0.05, 0.08], [1, 0], tolerance),),
        stages=(Stage("seated", ("locator",), require=("accurate", "deterministic")),),
    )


@pytest.mark.parametrize(("tolerance", "answer"), [(21 * UM, Answer.YES), (19 * UM, Answer.NO)])
def test_a_stage_that_requires_it_gets_it(tolerance: float, answer: Answer) -> None:
    verdict = verify(layout(tolerance))
    assert verdict.satisfied is answer
    assert isinstance(verdict.groups["seated"].findings["accurate"].use, LocatingErrors)
    assert "accurate" not in verdict.groups["all"].findings
    assert check(verdict) == []


def test_the_pose_is_about_the_verdicts_reference() -> None:
    verdict = verify(layout(21 * UM))
    found = verdict.groups["seated"].findings["accurate"].use
    assert isinstance(found, LocatingErrors)
    assert found.reference == pytest.approx(verdict.reference)


def test_a_plate_on_two_pins(tmp_path: Path) -> None:
    """Through the geometry: four walls a round pin, two a diamond one; numbers as for a plane and two pins by hand."""
    outline = [[0, 0], [0.1, 0], [0.1, 0.06], [0, 0.06]]
    mesh = prism(outline, 0.01, [circle(0.004, 64, (0.02, 0.03)), circle(0.004, 64, (0.08, 0.03))])
    up, along = np.array([0.0, 0, 1]), np.array([0.0, 1, 0])
    under = [
        Element(n, "locator", np.array([x, y, 0.0]), tolerance=10 * UM)
        for n, x, y in (("A", 0.01, 0.01), ("B", 0.09, 0.01), ("C", 0.05, 0.05))
    ]
    pins = [
        Element("P", "locator", np.array([0.02, 0.03, 0.005]), PinTip(0.00798, 20 * UM, "round"), up, 10 * UM),
        Element("Q", "locator", np.array([0.08, 0.03, 0.005]), PinTip(0.00799, 10 * UM, "diamond", along), up, 5 * UM),
    ]
    diagonal = feature([0.05, 0.03, 0.005], [1, 1, 0], 1e-3)
    plate = Layout(
        "plate",
        part=part(write(tmp_path, mesh)),
        elements=(*under, *pins),
        key_features=(diagonal,),
        require={"locators": ("accurate",)},
    )
    verdict = verify(plate)
    found = verdict.groups["locators"].findings["accurate"].use
    assert isinstance(found, LocatingErrors)
    assert found.features[0].worst == pytest.approx((20 * np.sqrt(1.25) + 5) / np.sqrt(2) * UM, rel=1e-4)
    assert verdict.satisfied is Answer.YES
    assert check(verdict) == []
    twice = replace(plate, elements=(*under, pins[0], replace(pins[1], tip=PinTip(0.00799, 10 * UM, "round"))))
    over = verify(twice)
    assert check(over) == []
    assert over.satisfied is Answer.YES
    both = over.groups["locators"].findings["accurate"].use
    assert isinstance(both, LocatingErrors)
    assert both.features[0].worst < found.features[0].worst
    assert both.rockings


def test_the_bracket_with_a_fourth_tip_under_it() -> None:
    """Its weight, from its URDF, tells which triangles carry it."""
    bracket = read_layout(Path(__file__).parents[2] / "urdf" / "bracket" / "bracket.layout.yaml")
    fourth = Element("L7", "locator", np.array([0.008, 0.006, 0.0]), tolerance=20 * UM)
    bore = feature([0.042, 0.02, 0.005], [0, 0, 1], 100 * UM)
    verdict = verify(
        replace(
            bracket,
            elements=(*bracket.elements, fourth),
            key_features=(bore,),
            stages=(),
            require={"locators": ("accurate",)},
        )
    )
    found = verdict.groups["locators"].findings["accurate"].use
    assert isinstance(found, LocatingErrors)
    assert found.pressing is not None
    assert {"L1", "L2", "L3", "L7"} == {name for rocking in found.rockings for name in rocking.contacts}
    assert verdict.satisfied is Answer.YES
    assert check(verdict) == []


def test_the_checker_refuses_the_opposite_answer() -> None:
    verdict = verify(layout(21 * UM))
    group = verdict.groups["seated"]
    findings = {**group.findings, "accurate": replace(group.findings["accurate"], answer=Answer.NO)}
    groups = {**verdict.groups, "seated": replace(group, findings=findings)}
    assert any("accurate no" in problem for problem in check(replace(verdict, groups=groups)))


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("center", [None, [0.05, 0.03, 0.02]])
@pytest.mark.parametrize("tolerance", [1 * UM, 1000 * UM])
def test_genuine_evidence_is_confirmed(name: str, center: list[float] | None, tolerance: float) -> None:
    """`asked` has the checker look at it; here that there was something to look at."""
    finding = asked(CASES[name], ALIKE, [replace(ABOVE, tolerance=tolerance)], center=center)
    assert finding.answer is (Answer.NO if tolerance < 10 * UM else Answer.YES)


def of_feature(**changes: Any) -> Callable[[LocatingErrors], LocatingErrors]:
    return lambda found: replace(found, features=(replace(found.features[0], **changes),))


def scaled_shares(found: LocatingErrors) -> LocatingErrors:
    (old,) = found.features
    shares = {name: 0.5 * share for name, share in old.shares.items()}
    return replace(
        found, features=(replace(old, shares=shares, worst=0.5 * old.worst, rss=0.5 * old.rss, least=0.5 * old.least),)
    )


def moved_share(found: LocatingErrors) -> LocatingErrors:
    (old,) = found.features
    first, second, *_ = [name for name, share in old.shares.items() if share > UM / 10]
    shares = {**old.shares, first: old.shares[first] - UM / 10, second: old.shares[second] + UM / 10}
    return replace(found, features=(replace(old, shares=shares),))


def one_weight_off(found: LocatingErrors) -> LocatingErrors:
    (old,) = found.features
    return replace(found, features=(replace(old, weights=(old.weights[0] + 1e-3, *old.weights[1:])),))


def rows_swapped(found: LocatingErrors) -> LocatingErrors:
    (old,) = found.features
    return replace(found, features=(replace(old, rows=(old.rows[1], old.rows[0], *old.rows[2:])),))


FORGED: dict[str, tuple[Callable[[LocatingErrors], LocatingErrors], str]] = {
    "half of everything": (scaled_shares, "the share of"),
    "a share moved": (moved_share, "the share of"),
    "a worst that is better": (of_feature(worst=UM), "do not add up"),
    "a least that is better": (of_feature(least=UM), "least over all seats"),
    "a root sum square of its own": (of_feature(rss=UM), "root sum square"),
    "another point": (of_feature(point=np.array([0.05, 0.04, 0.04])), "do not make the feature's row"),
    "a longer direction": (of_feature(direction=np.array([0.4, 0.6, 2.0])), "not of length one"),
    "no weights": (of_feature(weights=()), "one weight a row"),
    "a weight off": (one_weight_off, "do not make the feature's row"),
    "rows swapped": (rows_swapped, "do not make the feature's row"),
    "rows of nobody": (of_feature(rows=(("X", 0),), weights=(1.0,)), "one choice of alternatives"),
    "a smaller tolerance": (of_feature(tolerance=UM), "more than its tolerance"),
    "a tolerance that is no number": (of_feature(tolerance=np.nan), "no length"),
    "smaller errors": (lambda found: replace(found, errors=dict.fromkeys(found.errors, UM)), "the share of"),
    "no errors": (lambda found: replace(found, errors={}), "missing"),
    "form error": (lambda found: replace(found, form=UM), "the share of"),
    "no features": (lambda found: replace(found, features=()), "no features"),
    "seats not looked at": (lambda found: replace(found, complete=False), "not all seats"),
    "a better pose": (lambda found: replace(found, pose=np.full(6, UM)), "error of the pose"),
    "a pose of three": (lambda found: replace(found, pose=np.full(3, UM)), "number of coordinates"),
    "another costliest": (lambda found: replace(found, costliest="F"), "costliest"),
    "a motion": (lambda found: replace(found, motion=np.array([1.0, 0, 0, 0, 0, 0])), "free motion"),
    "rocking of what does not": (
        lambda found: replace(found, rockings=(Rocking(("A", "B", "D"), np.ones(6), UM),)),
        "do not depend on each other",
    ),
}


@pytest.mark.parametrize("name", FORGED)
def test_forged_evidence_is_refused(name: str) -> None:
    forge, fault = FORGED[name]
    finding = asked(THREE_TWO_ONE, ALIKE, [ABOVE])
    assert finding.answer is Answer.YES
    assert fault in (accuracy_fault(replace(finding, use=forge(evidence(finding))), THREE_TWO_ONE) or "")


def test_evidence_of_another_kind_is_refused() -> None:
    assert "locating errors" in (accuracy_fault(Finding(Answer.YES), THREE_TWO_ONE) or "")


def test_a_worst_over_some_seats_only_is_refused() -> None:
    """The shares are those of the weights, and they are a seat's; but another seat is worse."""
    far = feature([0.05, 0.08, 0.0], [0, 0, 1], 1.0)
    better = evidence(asked(THREE_TWO_ONE, ALIKE, [far])).features[0]
    finding = asked(FOUR_TWO_ONE, ALIKE, [far])
    worst = evidence(finding).features[0]
    assert better.worst < 0.9 * worst.worst
    shares = {**better.shares, "G": 0.0}
    forged = replace(evidence(finding), features=(replace(better, shares=shares, least=worst.least),))
    assert "worst over all seats" in (accuracy_fault(replace(finding, use=forged), FOUR_TWO_ONE) or "")


def refused() -> tuple[Finding, FeatureError]:
    finding = asked(FOUR_TWO_ONE, ALIKE, [replace(ABOVE, tolerance=UM)], center=[0.05, 0.03, 0.02])
    assert finding.answer is Answer.NO
    return finding, evidence(finding).features[0]


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        (lambda f: {"displacement": None}, "no feature has a displacement"),
        (lambda f: {"moves": None}, "no displacement that shows"),
        (lambda f: {"displacement": 0.01 * f.displacement}, "within the tolerance"),
        (lambda f: {"displacement": f.displacement + np.array([0, 0, -30 * UM, 0, 0, 0])}, "would enter"),
        (lambda f: {"displacement": f.displacement + np.array([0, 0, 30 * UM, 0, 0, 0])}, "rests on no seat"),
        (lambda f: {"moves": {name: 2 * move for name, move in f.moves.items()}}, "beyond its error"),
        (lambda f: {"moves": {}}, "is missing"),
    ],
)
def test_a_displacement_that_does_not_occur_is_refused(changes: Callable[[Any], dict[str, Any]], fault: str) -> None:
    finding, old = refused()
    forged = replace(evidence(finding), features=(replace(old, **changes(old)),))
    assert fault in (accuracy_fault(replace(finding, use=forged), FOUR_TWO_ONE) or "")


@pytest.mark.parametrize(
    ("motion", "fault"),
    [
        ([1.0, 0, 0, 0, 0, 0], None),
        ([0, 1.0, 0, 0, 0, 0], "notices the motion"),
        ([0.0, 0, 0, 0, 0, 0], "no motion"),
        ([1.0, 0, 0], "no motion"),
        ([np.nan, 0, 0, 0, 0, 0], "no motion"),
    ],
)
def test_a_free_motion_must_be_free(motion: list[float], fault: str | None) -> None:
    finding = asked(THREE_TWO_ONE[:5], ALIKE, [feature([0.05, 0.06, 0.02], [1, 0, 0], 1.0)])
    found = accuracy_fault(replace(finding, use=replace(evidence(finding), motion=np.array(motion))), THREE_TWO_ONE[:5])
    assert found is fault is None or (fault or "nothing") in (found or "")


def test_a_free_motion_must_move_a_feature() -> None:
    finding = asked(THREE_TWO_ONE[:5], ALIKE, [feature([0.05, 0.06, 0.02], [1, 0, 0], 1.0)])
    across = replace(evidence(finding).features[0], direction=np.array([0.0, 1.0, 0.0]))
    forged = replace(finding, use=replace(evidence(finding), features=(across,)))
    assert "moves no feature" in (accuracy_fault(forged, THREE_TWO_ONE[:5]) or "")
