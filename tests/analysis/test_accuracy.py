"""Errors of key features: by hand, over several seats, under what must not change them, and what cannot be answered."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from fixture_design.contacts import Contact, Provenance
from fixture_design.layout import Answer
from tests.analysis.locators import (
    ACROSS_X,
    ROUND,
    THREE_TWO_ONE,
    UNDER,
    asked,
    evidence,
    feature,
    only,
    pad,
    pin,
    tip,
)
from tests.analysis.rigid_placement import turns

UM = 1e-6
LIKE = {"rel": 1e-9, "abs": 1e-18}
TOLERANCES = {"A": 10 * UM, "B": 20 * UM, "C": 30 * UM, "D": 4 * UM, "E": 8 * UM, "F": 5 * UM}
ALIKE = dict.fromkeys("ABCDEFG", 10 * UM)
SQUARE = [tip(n, [x, y, 0], [0, 0, -1]) for n, x, y in (("A", 0, 0), ("B", 0.1, 0), ("C", 0.1, 0.1), ("G", 0, 0.1))]
FOUR_TWO_ONE = [*SQUARE, *THREE_TWO_ONE[3:]]


@pytest.mark.parametrize(
    ("point", "direction", "shares"),
    [
        # barycentric weights of A, B, C: half way to C, as far beyond AB as C is inside, at A itself
        ([0.05, 0.04, 0.02], [0, 0, 1], {"A": 2.5, "B": 5, "C": 15}),
        ([0.05, -0.05, 0.02], [0, 0, -3], {"A": 10, "B": 20, "C": 30}),
        ([0.01, 0.01, 0.02], [0, 0, 1], {"A": 10}),
        # at the height of the side's tips no tilt moves it: the mean of D and E; at D; beyond E
        ([0.05, 0.06, 0.02], [0, 1, 0], {"D": 2, "E": 4}),
        ([0.02, 0.06, 0.02], [0, 1, 0], {"D": 4}),
        ([0.14, 0.06, 0.02], [0, 1, 0], {"D": 4, "E": 16}),
        ([0.05, 0.04, 0.02], [1, 0, 0], {"F": 5}),
        # half a side's length further in y the turn (E - D) / 60 mm moves it by 2/3 of both
        ([0.05, 0.08, 0.02], [1, 0, 0], {"F": 5, "D": 4 * 2 / 3, "E": 8 * 2 / 3}),
    ],
)
def test_three_two_one_by_hand(point: Sequence[float], direction: Sequence[float], shares: dict[str, float]) -> None:
    found = only(asked(THREE_TWO_ONE, TOLERANCES, [feature(point, direction, 1.0)]))
    expected = {name: shares.get(name, 0.0) * UM for name in TOLERANCES}
    assert found.shares == pytest.approx(expected, rel=1e-9, abs=1e-15)
    assert found.worst == found.least == pytest.approx(sum(expected.values()), **LIKE)
    assert found.rss == pytest.approx(float(np.linalg.norm(list(expected.values()))), **LIKE)


def test_pose_of_three_two_one_by_hand() -> None:
    """About W's origin: tilts by levers of 60 and 80 mm, and the shifts that they cause at a height of 20 mm."""
    pose = evidence(asked(THREE_TWO_ONE, TOLERANCES, [feature([0, 0, 0], [0, 0, 1], 1.0)])).pose
    assert pose is not None
    assert pose[3:] == pytest.approx([45 * UM / 0.06, 30 * UM / 0.08, 12 * UM / 0.06], **LIKE)
    # z at the origin: A + (A - B) / 8 + (mean of A and B - C) / 6
    assert pose[2] == pytest.approx((10 * (1 + 1 / 8 + 1 / 12) + 20 * (1 / 8 - 1 / 12) + 30 / 6) * UM, **LIKE)


def plane_and_pins(
    first: Sequence[Sequence[float]], second: Sequence[Sequence[float]], clearance: float = 20 * UM
) -> list[Contact]:
    return [
        *UNDER,
        *pin("P", [0.02, 0.04, 0.01], 0.004, clearance, first),
        *pin("Q", [0.08, 0.04, 0.01], 0.004, clearance / 2, second),
    ]


@pytest.mark.parametrize(
    ("direction", "worst"),
    [
        ([0, 1, 0], (20 + 10) / 2),
        ([1, 0, 0], 20),
        # the round pin's disc has no corners: 20 |(1, 1/2)| and not 20 (1 + 1/2)
        ([1, 1, 0], (20 * np.sqrt(1.25) + 5) / np.sqrt(2)),
    ],
)
def test_plane_and_two_pins_by_hand(direction: Sequence[float], worst: float) -> None:
    """Round pin: 10 um and half of 20; diamond pin: 5 um and half of 10; a feature half way, at their height."""
    contacts = plane_and_pins(ROUND, ACROSS_X)
    given = ALIKE | {"P": 10 * UM, "Q": 5 * UM}
    assert only(asked(contacts, given, [feature([0.05, 0.04, 0.01], direction, 1.0)])).worst == pytest.approx(
        worst * UM, **LIKE
    )


@pytest.mark.parametrize(
    "second", [ROUND, [(np.cos(a), np.sin(a), 0) for a in (0.3, 0.3 + np.pi / 2, 0.3 + np.pi, 0.3 + 1.5 * np.pi)]]
)
@pytest.mark.parametrize("radii", [(20, 10), (10, 10), (3, 40), (0, 10)])
@pytest.mark.parametrize("point", [[0.05, 0.04], [0.02, 0.08], [0.1, 0.02]])
def test_two_round_pins_are_both_within_their_discs(
    second: Sequence[Sequence[float]], radii: tuple[float, float], point: list[float]
) -> None:
    """Against a scan of where both holes may be: along the pins' line they move together, across it each on its own."""
    contacts = plane_and_pins(ROUND, second, clearance=0.0)
    given = ALIKE | {"P": radii[0] * UM, "Q": radii[1] * UM}
    direction = np.array([0.6, 0.8])
    finding = asked(contacts, given, [feature([*point, 0.01], [*direction, 0], 1e-9)])
    along = np.linspace(-1, 1, 20001) * min(radii)
    largest = 0.0
    for first_sign, second_sign in ((1, 1), (1, -1)):
        across = [sign * np.sqrt(r**2 - along**2) for sign, r in zip((first_sign, second_sign), radii, strict=True)]
        turn = (across[1] - across[0]) / 60e3
        x, y = along - turn * (point[1] - 0.04) * 1e6, across[0] + turn * (point[0] - 0.02) * 1e6
        largest = max(largest, float(np.abs(direction[0] * x + direction[1] * y).max()))
    assert only(finding).worst == pytest.approx(largest * UM, rel=1e-6)
    assert finding.answer is Answer.NO
    assert any(
        {"P", "Q"} == {name.split("#")[0] for name in rocking.contacts} for rocking in evidence(finding).rockings
    )


def test_four_two_one_rocks_and_has_two_errors() -> None:
    """Off the centre two triangles carry the part; on A, B, C it is off G by up to 30 um, and on B, C, G by 10."""
    finding = asked(FOUR_TWO_ONE, ALIKE, [feature([0, 0.1, 0.03], [0, 0, 1], 20 * UM)], center=[0.08, 0.03, 0.02])
    found, (rocking,) = only(finding), evidence(finding).rockings
    assert found.worst == pytest.approx(30 * UM, **LIKE)
    assert found.least == pytest.approx(10 * UM, **LIKE)
    assert set(found.seat) == set("ABCDEF")
    assert set(rocking.contacts) == set("ABCG")
    assert rocking.size == pytest.approx(40 * UM, **LIKE)
    assert finding.answer is Answer.NO


def test_four_two_one_where_nothing_tells_what_presses() -> None:
    point = [0, 0.1, 0.03]
    assert only(asked(FOUR_TWO_ONE, ALIKE, [feature(point, [0, 0, 1], 1.0)])).worst == pytest.approx(30 * UM, **LIKE)
    assert asked(FOUR_TWO_ONE, ALIKE, [feature(point, [0, 0, 1], 31 * UM)]).answer is Answer.YES
    disagree = asked(FOUR_TWO_ONE, ALIKE, [feature(point, [0, 0, 1], 20 * UM)])
    assert disagree.answer is Answer.UNDECIDED
    assert "A, B, C, D, E" in (disagree.reason or "")
    assert asked(FOUR_TWO_ONE, ALIKE, [feature([0.05, 0.3, 0], [0, 0, 1], 5 * UM)]).answer is Answer.NO


def test_a_clamp_decides_where_it_rests() -> None:
    """A clamp over B, far from G, holds the part on the triangles that have B and carry it."""
    clamp = Contact.on_facet("K", "clamp", [0.095, 0.02, 0.04], [0, 0, 1])
    point, contacts = feature([0.1, 0, 0.03], [0, 0, 1], 1.0), [*FOUR_TWO_ONE, clamp]
    assert only(asked(contacts, ALIKE, [point], preloads={"K": 100.0})).worst == pytest.approx(10 * UM, **LIKE)
    assert only(asked(FOUR_TWO_ONE, ALIKE, [point])).worst == pytest.approx(30 * UM, **LIKE)


@pytest.mark.parametrize("size", [0.004, 0.02])
@pytest.mark.parametrize("center", [None, [0.05, 0.03, 0.02]])
def test_one_pad_does_not_turn_the_part(size: float, center: list[float] | None) -> None:
    """Its corners are off together: the error is that of a tip in its middle but for the pad's size over the levers."""
    contacts = [*pad("A", (0.01, 0.01, 0), size), *THREE_TWO_ONE[1:]]
    for direction in np.eye(3):
        point = feature([0.1, 0.08, 0.04], direction, 1.0)
        tips = only(asked(THREE_TWO_ONE, ALIKE, [point])).worst
        pads = only(asked(contacts, ALIKE, [point], center=center)).worst
        assert tips * (1 - 1e-9) <= pads <= tips * (1 + size / 0.06)


@pytest.mark.parametrize("weight", [[0.05, 0.03], [0.03, 0.02], [0.055, 0.016]])
@pytest.mark.parametrize("point", [[0.05, 0.03], [0.1, 0.08], [0.0, 0.1], [0.05, -0.05]])
@pytest.mark.parametrize("size", [0.004, 0.015])
def test_three_pads_against_the_part_resting_on_their_corners(
    weight: list[float], point: list[float], size: float
) -> None:
    """Each pad higher or lower by its tolerance, and a plane above all corners that is lowest under the weight.

    Which corner of a pad is touched depends on the tilt: the bound over all seats is what occurs, to rounding.
    """
    contacts = [
        corner
        for name, place in zip("ABC", ((0.01, 0.01, 0), (0.09, 0.01, 0), (0.05, 0.06, 0)), strict=True)
        for corner in pad(name, place, size)
    ]
    finding = asked(
        [*contacts, *THREE_TWO_ONE[3:]], ALIKE, [feature([*point, 0.03], [0, 0, 1], 1 * UM)], center=[*weight, 0.02]
    )
    largest = max(abs(height(contacts, np.array(up), weight, point)) for up in np.ndindex(3, 3, 3))
    assert only(finding).worst == pytest.approx(10 * UM * largest, rel=1e-7)
    assert finding.answer is Answer.NO


def height(contacts: Sequence[Contact], steps: np.ndarray, weight: list[float], point: list[float]) -> float:
    """Of a plane over a point that rests on corners at heights -1, 0, 1 and is lowest at the weight."""
    from scipy.optimize import linprog

    corners = np.array([[1.0, *contact.point[:2]] for contact in contacts])
    heights = np.repeat(steps - 1.0, 4)
    lowest = linprog([1.0, *weight], A_ub=-corners, b_ub=-heights, bounds=[(None, None)] * 3)
    return float(np.array([1.0, *point]) @ lowest.x)


def test_form_error_is_each_contacts_own() -> None:
    """A 20 mm pad alone under the part: flat, it only shifts; with form errors it tilts about its diagonal.

    50 mm beside its middle the corners of the half that carries the weight have the weights 1/2, 3 and -5/2.
    """
    contacts = [*pad("A", (0.05, 0.04, 0), 0.02), *THREE_TWO_ONE[3:]]
    far, center = [feature([0.1, 0.04, 0], [0, 0, 1], 1.0)], [0.05, 0.041, 0.02]
    assert only(asked(contacts, ALIKE, far, center=center)).worst == pytest.approx(10 * UM, **LIKE)
    assert only(asked(contacts, ALIKE, far, form=UM, center=center)).worst == pytest.approx(16 * UM, **LIKE)


def test_form_error_adds_to_tips_and_to_the_radius_of_pins() -> None:
    tips = [feature([0.05, 0.04, 0.02], [0, 0, 1], 1.0)]
    assert only(asked(THREE_TWO_ONE, TOLERANCES, tips, form=UM)).worst == pytest.approx((22.5 + 1) * UM, **LIKE)
    pins = [feature([0.05, 0.04, 0.01], [1, 1, 0], 1.0)]
    found = only(asked(plane_and_pins(ROUND, ACROSS_X, 0.0), ALIKE | {"P": 20 * UM, "Q": 10 * UM}, pins, form=UM))
    assert found.worst == pytest.approx((21 * np.sqrt(1.25) + 5.5) / np.sqrt(2) * UM, **LIKE)


LAYOUTS = {
    "3-2-1": (list(THREE_TWO_ONE), {}),
    "4-2-1": (FOUR_TWO_ONE, {}),
    "pins": (plane_and_pins(ROUND, ACROSS_X), {}),
    "round pins": (plane_and_pins(ROUND, ROUND), {}),
    "pads": ([*pad("A", (0.01, 0.01, 0), 0.01), *pad("B", (0.09, 0.02, 0), 0.01), *THREE_TWO_ONE[2:]], {"form": UM}),
}


@pytest.mark.parametrize("name", LAYOUTS)
def test_larger_tolerances_never_make_it_better(name: str) -> None:
    contacts, given = LAYOUTS[name]
    random = np.random.default_rng(3)
    point = feature([0.02, 0.09, 0.05], [0.5, -0.3, 0.8], 1.0)
    tolerances = {element: random.uniform(1, 10) * UM for element in "ABCDEFGPQ"}
    before = only(asked(contacts, tolerances, [point], **given)).worst
    for element, tolerance in tolerances.items():
        grown = tolerances | {element: 2 * tolerance}
        assert only(asked(contacts, grown, [point], **given)).worst >= before * (1 - 1e-9)


def moved(contacts: Sequence[Contact], R: np.ndarray, t: np.ndarray, scale: float) -> list[Contact]:
    return [
        replace(
            c,
            point=scale * (R @ c.point + t),
            clauses=tuple(tuple(3 * (R @ n) for n in o) for o in c.clauses),
            clearance=scale * c.clearance,
        )
        for c in contacts
    ]


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.parametrize("scale", [1.0, 1e3, 39.37])
def test_nothing_depends_on_the_frame_or_the_unit(name: str, scale: float) -> None:
    contacts, given = LAYOUTS[name]
    R, t = turns(np.array([[0.3, -1.1, 0.7]]))[0], np.array([0.4, -0.2, 0.9])
    point, direction = np.array([0.02, 0.09, 0.05]), np.array([0.5, -0.3, 0.8])
    tolerances = {element: (k + 2) * UM for k, element in enumerate("ABCDEFGPQ")}
    here = only(asked(contacts, tolerances, [feature(point.tolist(), direction.tolist(), 1.0)], **given))
    there = only(
        asked(
            moved(contacts, R, t, scale),
            {element: scale * tolerance for element, tolerance in tolerances.items()},
            [feature((scale * (R @ point + t)).tolist(), (R @ direction).tolist(), scale)],
            **{key: scale * value for key, value in given.items()},
        )
    )
    assert there.worst == pytest.approx(scale * here.worst, rel=1e-7)
    assert there.least == pytest.approx(scale * here.least, rel=1e-7)
    assert there.shares == pytest.approx(
        {n: scale * s for n, s in here.shares.items()}, rel=1e-4, abs=1e-7 * scale * here.worst
    )


def test_planar_by_hand() -> None:
    """Two under a plate, 80 mm apart, and one at its side: a feature above the middle of the first two."""
    contacts = [tip("A", [0.01, 0], [0, -1]), tip("B", [0.09, 0], [0, -1]), tip("F", [0, 0.04], [-1, 0])]
    up = only(asked(contacts, TOLERANCES, [feature([0.05, 0.04], [0, 1], 1.0)]))
    assert up.worst == pytest.approx(15 * UM, **LIKE)
    # half the distance of A and B above F, the turn (B - A) / 80 mm moves it by half of both
    aside = only(asked(contacts, TOLERANCES, [feature([0.05, 0.08], [1, 0], 1.0)]))
    assert aside.shares == pytest.approx({"A": 5 * UM, "B": 10 * UM, "F": 5 * UM}, **LIKE)


@pytest.mark.parametrize(("factor", "answer"), [(1.001, Answer.YES), (0.999, Answer.NO), (1.0, Answer.UNDECIDED)])
def test_the_answer_compares_with_the_tolerance_and_a_tie_is_a_tie(factor: float, answer: Answer) -> None:
    finding = asked(THREE_TWO_ONE, TOLERANCES, [feature([0.05, 0.04, 0.02], [0, 0, 1], factor * 22.5 * UM)])
    assert finding.answer is answer
    assert answer is not Answer.UNDECIDED or "just its tolerance" in (finding.reason or "")


def test_the_costliest_element_is_that_of_the_tightest_feature() -> None:
    features = [
        feature([0.05, 0.04, 0.02], [0, 0, 1], 1.0, "loose"),
        feature([0.14, 0.06, 0.02], [0, 1, 0], 21 * UM, "tight"),
    ]
    assert evidence(asked(THREE_TWO_ONE, TOLERANCES, features)).costliest == "E"


def test_what_is_not_located_decides_only_where_the_feature_moves() -> None:
    """Without F the part slides along x: no for a feature along x, and D and E still place one along y."""
    contacts = THREE_TWO_ONE[:5]
    loose = asked(contacts, TOLERANCES, [feature([0.05, 0.06, 0.02], [1, 0, 0], 1.0)])
    motion = evidence(loose).motion
    assert loose.answer is Answer.NO
    assert motion is not None
    assert motion / motion[0] == pytest.approx([1, 0, 0, 0, 0, 0], abs=1e-9)
    placed = asked(contacts, TOLERANCES, [feature([0.05, 0.06, 0.02], [0, 1, 0], 10 * UM)])
    assert placed.answer is Answer.YES
    assert only(placed).worst == pytest.approx(6 * UM, **LIKE)
    assert evidence(placed).pose is None
    assert evidence(placed).motion is None


def test_without_locators_everything_moves() -> None:
    clamp = Contact.on_facet("K", "clamp", [0.05, 0.04, 0.04], [0, 0, 1])
    assert asked([clamp], {}, [feature([0, 0, 0], [0, 1, 0], 1.0)]).answer is Answer.NO


def test_without_features_there_is_nothing_to_compare() -> None:
    finding = asked(THREE_TWO_ONE, TOLERANCES, [])
    assert finding.answer is Answer.UNDECIDED
    assert "key_features" in (finding.reason or "")


def test_without_any_tolerance_an_error_of_zero_is_no_yes() -> None:
    finding = asked(THREE_TWO_ONE, {}, [feature([0.05, 0.04, 0.02], [0, 0, 1], UM)])
    assert finding.answer is Answer.UNDECIDED
    assert "no tolerance, clearance or form error is given for what locates bore" in (finding.reason or "")
    assert asked(THREE_TWO_ONE, {}, [feature([0.05, 0.04, 0.02], [0, 0, 1], 2 * UM)], form=UM).answer is Answer.YES


def test_a_missing_tolerance_counts_as_zero_and_is_named() -> None:
    given = {name: tolerance for name, tolerance in TOLERANCES.items() if name != "B"}
    finding = asked(THREE_TWO_ONE, given, [feature([0.05, 0.04, 0.02], [0, 0, 1], 18 * UM)])
    assert finding.answer is Answer.YES
    assert only(finding).worst == pytest.approx(17.5 * UM, **LIKE)
    assert "no tolerance is given for B: taken as 0" in (finding.reason or "")


def test_normals_that_are_off_leave_doubt() -> None:
    """0.01 rad change a bound a little; contacts that are nearly dependent they may make so."""
    point = feature([0.05, 0.04, 0.02], [0, 0, 1], 1.0)
    off = [replace(contact, provenance=Provenance("fitted", 0.01)) for contact in THREE_TWO_ONE]
    assert asked(off, TOLERANCES, [replace(point, tolerance=40 * UM)]).answer is Answer.YES
    doubtful = asked(off, TOLERANCES, [replace(point, tolerance=23 * UM)])
    assert doubtful.answer is Answer.UNDECIDED
    assert "normals" in (doubtful.reason or "")
    close = replace(off[4], point=np.array([0.0205, 0, 0.02]))
    blurred = asked([*off[:4], close, off[5]], TOLERANCES, [point])
    assert blurred.answer is Answer.UNDECIDED
    assert "D" in (blurred.reason or "")


def test_alternatives_are_all_looked_at() -> None:
    """A convex apex rests on one flank or the other: the worse of two layouts, the checker agrees."""
    flanks = ([0, -1, 0], [0.6, -0.8, 0])
    point = feature([0.08, 0.09, 0.03], [1, 0.5, 0], 1.0)
    one_each = [
        only(asked([*THREE_TWO_ONE[:4], tip("E", [0.08, 0, 0.02], flank), THREE_TWO_ONE[5]], TOLERANCES, [point])).worst
        for flank in flanks
    ]
    either = Contact.of("E", "locator", [0.08, 0, 0.02], [flanks])
    found = only(asked([*THREE_TWO_ONE[:4], either, THREE_TWO_ONE[5]], TOLERANCES, [point]))
    assert one_each[0] != pytest.approx(one_each[1], rel=1e-3)
    assert found.worst == pytest.approx(max(one_each), **LIKE)
    assert found.least == pytest.approx(min(one_each), **LIKE)


def test_too_many_alternatives_are_given_up() -> None:
    either = [Contact.of(f"L{k}", "locator", [0.01 * k, 0, 0], [[[0, 0, -1], [0, -1, 0]]]) for k in range(7)]
    finding = asked(either, {}, [feature([0, 0, 0], [0, 0, 1], 1.0)])
    assert finding.answer is Answer.UNDECIDED
    assert "alternatives" in (finding.reason or "")


def test_too_many_seats_prove_nothing() -> None:
    """40 tips under the part: 9880 triangles."""
    spots = np.random.default_rng(0).uniform(0, 0.1, (40, 2))
    contacts = [*(tip(f"L{k}", [*spot, 0], [0, 0, -1]) for k, spot in enumerate(spots)), *THREE_TWO_ONE[3:]]
    finding = asked(contacts, {f"L{k}": UM for k in range(40)}, [feature([0.05, 0.05, 0], [0, 0, 1], 1.0)])
    assert finding.answer is Answer.UNDECIDED
    assert not evidence(finding).complete
