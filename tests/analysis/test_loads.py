"""Loads held: against statics by hand, an independent route, laws, and wrong or extreme inputs."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

from fixture_design.analysis.acting import LoadRow, wrench_at
from fixture_design.analysis.balancing import branches_of
from fixture_design.contacts import Contact, Provenance
from fixture_design.layout import Answer, Balance, Finding, Load, LoadsHeld, Stage, Unbalanced
from fixture_design.tolerances import DEFAULT
from fixture_design.verification.force_checks import loads_fault
from tests.analysis.forces import (
    WEIGHT,
    across,
    asked,
    block,
    held,
    opposed,
    pyramid_factors,
    random_case,
)

#: How near to the ends of a bracket by pyramids an answer may come [-]: the tolerance of the linear programs.
LINEAR = 1e-5


@pytest.fixture(autouse=True)
def no_warnings():
    """Overflow and division by zero are mistakes."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        yield


def cut(point, force, name="cut") -> Load:
    return Load(name, np.array(point, dtype=float), np.array(force, dtype=float))


@pytest.mark.parametrize(
    ("force", "answer"), [(79, "yes"), (80 - 1e-3, "yes"), (80, "undecided"), (80 + 1e-3, "no"), (81, "no"), (0, "yes")]
)
def test_two_opposed_clamps_hold_what_friction_gives(force, answer):
    """200 N with friction 0.2 on both sides: 80 N."""
    verdict = held(opposed(), {"K": 200.0}, across(force))
    assert verdict.answer == answer
    if force:
        assert verdict.reserve == pytest.approx((80 / force, 80 / force), rel=1e-7)
        assert dict(verdict.first) == {"L": "slips", "K": "slips"}
    if answer == "undecided":
        assert "tie" in verdict.reason


@pytest.mark.parametrize("size", [1e-3, 1e3, 1e6])
@pytest.mark.parametrize("length", [1e-3, 10.0])
@pytest.mark.parametrize("friction", [1e-3, 0.2, 1000.0])
def test_units_change_nothing(size, length, friction):
    contacts = [replace(c, point=c.point * length) for c in opposed(friction)]
    limit = 400 * friction * size
    for factor, answer in ((0.999, "yes"), (1.001, "no")):
        assert held(contacts, {"K": 200.0 * size}, across(limit * factor)).answer == answer


def test_a_large_load_on_small_preloads():
    verdict = held(opposed(), {"K": 200.0}, across(1e9))
    assert verdict.answer is Answer.NO
    assert verdict.reserve[1] == pytest.approx(8e-8, rel=1e-6)


def test_what_nothing_limits_has_no_limit():
    """Pressed against the locator: held however large it is, and proved by the locator alone."""
    verdict = held(opposed(), {"K": 200.0}, LoadRow("press", None, np.array([-1e9, 0, 0, 0, 0, 0])))
    assert verdict.answer is Answer.YES
    assert verdict.reserve == (np.inf, np.inf)
    assert verdict.needed == 0.0


def test_fingers_squeeze_only_if_something_makes_them():
    verdict = held(opposed(role="finger"), {}, across(1.0))
    assert verdict.answer is Answer.UNDECIDED
    assert verdict.reason == "only by squeezing between L and K, which nothing applies"
    assert held(opposed(role="finger"), {}, across(0.0)).answer is Answer.YES
    assert held(opposed(0.0, role="finger"), {}, across(1.0)).answer is Answer.NO


def test_a_clamp_without_preload_is_unknown():
    layout = block({"K1": None}, loads=(cut([0.1, 0.05, 0.05], [0, 0, 1000], "up"),))
    finding = asked(layout, "holds_loads")
    assert finding.answer is Answer.UNDECIDED
    assert finding.reason == "clamp K1 has no preload"


def test_the_weight_holds_by_hand():
    """Frictionless on three supports: lifted by its weight, tipped over S1-S3 by a force at the edge."""
    loads = (cut([0.1, 0.05, 0.05], [0, 0, 1], "lift"), cut([0.1, 0.05, 0.05], [0, 0, -1], "press"))
    lift, press = asked(block(loads=loads), "holds_loads").use.loads
    assert lift.reserve == pytest.approx((WEIGHT, WEIGHT))
    assert dict(lift.first)["S1"] == "lifts"
    assert press.reserve == (np.inf, np.inf)
    corner = cut([0.2, 0.1, 0.05], [0, 0, -1], "corner")
    (tipped,) = asked(block(loads=(corner,)), "holds_loads").use.loads
    # the weight is inside of the line S2-S3, 0.06 x + 0.08 y = 0.0124, by 0.0024 and the load outside by 0.0076
    assert tipped.reserve == pytest.approx((WEIGHT * 0.0024 / 0.0076,) * 2)
    assert tipped.first == (("S1", "lifts"),)


def test_a_load_may_be_needed():
    """Nothing but the load presses the part on its support against the pull of a spring."""
    contacts = [Contact.on_facet("S", "locator", [0, 0], [0, -1])]
    pull, press = np.array([0, 50.0, 0]), LoadRow("press", None, np.array([0, -100.0, 0]))
    verdict = held(contacts, {}, press, pull)
    assert verdict.answer is Answer.YES
    assert verdict.needed == pytest.approx(0.5)
    assert held(contacts, {}, LoadRow("press", None, np.array([0, -40.0, 0])), pull).answer is Answer.NO
    assert held(contacts, {}, LoadRow("press", None, np.array([0, -50.0, 0])), pull).answer is Answer.UNDECIDED


@pytest.mark.parametrize("seed", range(120))
def test_brackets_by_pyramids_agree(seed):
    contacts, preloads, weight, load = random_case(seed)
    verdict = held(contacts, preloads, load, weight)
    inner = pyramid_factors(contacts, preloads, weight, load.wrench, "inner")
    outer = pyramid_factors(contacts, preloads, weight, load.wrench, "outer")
    if verdict.answer is Answer.YES:
        assert outer is not None
        assert outer[0] <= 1 + LINEAR
        assert outer[1] >= 1 - LINEAR
    if verdict.answer is Answer.NO:
        assert inner is None or not (inner[0] + LINEAR < 1 < inner[1] - LINEAR)
    if verdict.reserve is not None and outer is not None:
        assert verdict.reserve[0] <= max(outer[1], 0) * (1 + LINEAR) + LINEAR
    if inner is not None and inner[1] >= 0:
        assert verdict.reserve is not None
        assert verdict.reserve[1] >= inner[1] * (1 - LINEAR) - LINEAR
    if branches_of(contacts, preloads, DEFAULT)[0][0].alike:
        assert verdict.answer is not Answer.UNDECIDED, verdict.reason
        if verdict.reserve is not None:
            assert verdict.reserve[1] == pytest.approx(verdict.reserve[0], rel=1e-6, abs=1e-6)


def coarse_case(seed: int):
    """Planar contacts on a grid of few points and directions: ties, repeats and opposed normals abound."""
    rng = np.random.default_rng(seed)
    contacts, preloads = [], {}
    for index in range(int(rng.integers(2, 8))):
        normal = np.array([(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1)][rng.integers(6)], dtype=float)
        role = "clamp" if rng.random() < 0.3 else "locator"
        point = rng.integers(-2, 3, size=2).astype(float)
        contacts.append(Contact.on_facet(f"C{index}", role, point, normal, float(rng.choice([0, 0, 0.5, 1.0]))))
        if role == "clamp":
            preloads[f"C{index}"] = float(rng.choice([0, 10, 100]))
    weight, wrench = np.array([0, -10.0 * rng.integers(2), 0]), rng.integers(-3, 4, size=3) * 10.0
    wrench[0] += 1.0  # never nothing
    return contacts, preloads, weight, LoadRow("cut", None, wrench)


@pytest.mark.parametrize("seed", range(60))
def test_planar_answers_are_those_of_a_linear_program(seed):
    """In the plane pyramids are the cones: answers that are no tie and need no squeeze are the linear program's."""
    contacts, preloads, weight, load = coarse_case(seed)
    verdict = held(contacts, preloads, load, weight)
    factors = pyramid_factors(contacts, preloads, weight, load.wrench, "inner")
    inside = factors is not None and factors[0] < 1 - LINEAR and factors[1] > 1 + LINEAR
    outside = factors is None or factors[0] > 1 + LINEAR or factors[1] < 1 - LINEAR
    if not branches_of(contacts, preloads, DEFAULT)[0][0].alike:
        assert not (inside and verdict.answer is Answer.NO)
        assert not (outside and verdict.answer is Answer.YES)
        return
    expected = Answer.YES if inside else Answer.NO if outside else Answer.UNDECIDED
    assert verdict.answer is expected


def test_random_cases_have_all_answers():
    answers = [held(*(case := random_case(seed))[:2], case[3], case[2]).answer for seed in range(60)]
    assert set(answers) == {Answer.YES, Answer.NO, Answer.UNDECIDED}


@pytest.mark.parametrize("seed", range(1, 25))
def test_motion_and_units_change_no_answer(seed):
    contacts, preloads, weight, load = random_case(seed)
    if len(weight) == 3:
        return
    rng = np.random.default_rng(seed)
    R, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    R *= np.sign(np.linalg.det(R))
    shift = 10 * rng.normal(size=3)

    def moved(wrench):
        force = R @ wrench[:3]
        return np.concatenate([force, R @ wrench[3:] + np.cross(shift, force)])

    placed = [replace(c, point=R @ c.point + shift, clauses=((R @ c.normals[0],),)) for c in contacts]
    before = held(contacts, preloads, load, weight)
    after = held(placed, preloads, LoadRow("cut", None, moved(load.wrench)), moved(weight))
    assert after.answer is before.answer
    if before.answer is not Answer.UNDECIDED and before.reserve is not None:
        assert after.reserve == pytest.approx(before.reserve, rel=1e-5)


@pytest.mark.parametrize("seed", range(40, 60))
def test_more_friction_holds_no_less(seed):
    contacts, preloads, weight, load = random_case(seed)
    rough = [replace(c, friction=c.friction * 1.2 + 0.02) for c in contacts]
    before, after = held(contacts, preloads, load, weight), held(rough, preloads, load, weight)
    assert not (before.answer is Answer.YES and after.answer is Answer.NO)
    if before.reserve is not None:
        assert after.reserve is not None
        assert after.reserve[1] >= before.reserve[1] * (1 - 1e-6)


def test_more_preload_holds_more():
    limits = [held(opposed(), {"K": force}, across(50.0)).reserve[0] for force in (50.0, 100.0, 200.0, 400.0)]
    assert limits == sorted(limits)
    assert limits[-1] == pytest.approx(8 * limits[0])


def test_soft_tips_hold_moments():
    """Two soft tips with c = 10 mm, friction 0.5 under 100 N: 0.5 N m each about their common line."""
    soft = [replace(c, torsion=0.01) for c in opposed(0.5)]
    for moment, answer in ((0.99, "yes"), (1.01, "no")):
        load = LoadRow("turn", None, np.array([0, 0, 0, moment, 0, 0]))
        assert held(soft, {"K": 100.0}, load).answer == answer
        assert held(opposed(0.5), {"K": 100.0}, load).answer is Answer.NO


def test_corners_of_a_clamp_share_its_preload():
    """A pad with two corners off the load's line: as far as one contact in their middle."""
    pad = [Contact.on_facet(f"K#{i}", "clamp", [1, 0, z], [1, 0, 0], 0.2) for i, z in ((1, -0.1), (2, 0.1))]
    contacts = [opposed()[0], *pad]
    for force, answer in ((79, "yes"), (81, "no")):
        verdict = held(contacts, {"K": 200.0}, across(force))
        assert verdict.answer == answer
    assert verdict.reserve == pytest.approx((80 / 81,) * 2)


def test_an_edge_holds_what_all_its_faces_hold():
    """The part may slide off along either face, so that F is the polar of both together."""
    edge = Contact.of("E", "locator", [0, 0], [[[1, -1], [-1, -1]]])
    against = [Contact.on_facet("L", "locator", [0, 0], [1, 0]), Contact.on_facet("R", "locator", [0, 0], [-1, 0])]
    down = LoadRow("down", None, np.array([0, -10.0, 0]))
    up = LoadRow("up", None, np.array([0, 10.0, 0]))
    assert held([edge, *against], {}, down).answer is Answer.YES
    assert len(held([edge, *against], {}, down).others) == 1
    for force in ([5.0, -5.0, 0], [-5.0, -5.0, 0], [0, -10.0, 0]):
        assert held([edge], {}, LoadRow("cut", None, np.array(force))).answer is Answer.NO
    assert held([edge, *against], {}, up).answer is Answer.NO


def test_edges_along_edges_leave_a_no_open():
    """Their points may take either face, which the branches of their two ends do not tell."""
    ends = [Contact.of(name, "locator", [x, 0], [[[1, -1], [-1, -1]]]) for name, x in (("E#1", 0), ("E#2", 1))]
    linked = [replace(ends[0], linked="E#2"), replace(ends[1], linked="E#1")]
    up = LoadRow("up", None, np.array([0, 10.0, 0]))
    assert held(ends, {}, up).answer is Answer.NO
    verdict = held(linked, {}, up)
    assert verdict.answer is Answer.UNDECIDED
    assert "parallel convex edges" in verdict.reason


def test_many_branches_are_undecided_not_guessed():
    edges = [Contact.of(f"E{i}", "locator", [0, 0], [[[1, -1], [-1, -1]]]) for i in range(8)]
    walls = [Contact.on_facet("L", "locator", [0, 0], [1, 0]), Contact.on_facet("R", "locator", [0, 0], [-1, 0])]
    assert held(edges, {}, LoadRow("up", None, np.array([0, 10.0, 0]))).answer is Answer.NO
    verdict = held([*edges, *walls], {}, LoadRow("down", None, np.array([0, -10.0, 0])))
    assert verdict.answer is Answer.UNDECIDED
    assert "64" in verdict.reason


def test_normals_that_may_be_off():
    """Off by 0.01 rad, friction counts for about that much less, or more."""
    off = [replace(c, provenance=Provenance("fitted", 0.01)) for c in opposed()]
    answers = [held(off, {"K": 200.0}, across(force)).answer for force in (40, 79, 81, 120)]
    assert answers[0] in (Answer.YES, Answer.UNDECIDED)
    assert answers[1:3] == [Answer.UNDECIDED, Answer.UNDECIDED]
    assert answers[3] is Answer.NO


def test_a_peg_held_all_around_takes_errors_of_its_normals():
    """Six soft clamps and locators around a ball: a small load leaves room for errors."""
    axes = [v * s for v in np.eye(3) for s in (1.0, -1.0)]
    contacts = [
        Contact(f"C{i}", "clamp" if i % 2 else "locator", n, ((n,),), 0.3, Provenance("fitted", 1e-4), torsion=0.05)
        for i, n in enumerate(axes)
    ]
    assert held(contacts, {"C1": 100.0, "C3": 100.0, "C5": 100.0}, across(5.0)).answer is Answer.YES


def test_without_a_part_gravity_is_unknown():
    layout = block()
    for question in ("holds_loads", "seated"):
        finding = asked(replace(layout, part=None), question)
        assert finding.answer is Answer.UNDECIDED
        assert finding.reason == "gravity is given, but no part with a mass"
    free = asked(replace(layout, part=None, gravity=None), "holds_loads")
    assert free.answer is Answer.YES


def test_a_stage_says_what_acts():
    loads = (cut([0.1, 0.05, 0.05], [0, 0, 10], "small"), cut([0.1, 0.05, 0.05], [0, 0, 30], "large"))
    stages = (
        Stage("resting", ("locator",), gravity=True, loads=("small",)),
        Stage("floating", ("locator",), loads=("small",)),
        Stage("lifted", ("locator",), gravity=True, loads=("small", "large")),
    )
    layout = block(loads=loads, stages=stages)
    assert asked(layout, "holds_loads", "resting").answer is Answer.YES
    assert asked(layout, "holds_loads", "floating").answer is Answer.NO
    lifted = asked(layout, "holds_loads", "lifted")
    assert lifted.answer is Answer.NO
    assert lifted.use.worst == 1


def test_reactions_of_springs():
    """Equal springs under three supports: those of statics, since three are determinate."""
    layout = block({"K1": 30.0}, loads=())
    stiff = tuple(
        replace(layout.elements[0], name=name, role="locator", preload=None, stiffness=1e7)
        for name in ["S1", "S2", "S3", "S4", "S5", "S6"]
    )
    finding = asked(replace(layout, elements=(*layout.elements, *stiff)), "holds_loads")
    assert finding.use.determinate
    balance = finding.use.loads[0].proof
    for name in ("S1", "S2", "S3", "S6"):
        assert finding.use.stiff[name].forces == pytest.approx(balance.forces[name].forces, abs=1e-6)
    assert finding.use.stiff["K1"].forces == pytest.approx(np.array([[0, 0, -30.0]]))
    assert asked(layout, "holds_loads").use.stiff is None


FAULTS = {
    "pulls": lambda v: force(v, "L", [[-200.0, 0, 0]]),
    "rubs": lambda v: force(v, "L", [[200.0, 0, -60.0]]),
    "instead of 200": lambda v: force(v, "K", [[-198.0, 0, -39.5]]),
    "leave": lambda v: force(v, "L", [[200.0, 0, -30.0]]),
    "shape": lambda v: force(v, "L", [[200.0, 0, -39.5]] * 2),
    "may not push": lambda v: replace(v, proof=replace(v.proof, forces={**v.proof.forces, "Z": v.proof.forces["L"]})),
    "turns": lambda v: replace(
        v, proof=replace(v.proof, forces={**v.proof.forces, "L": replace(v.proof.forces["L"], moments=np.ones(1))})
    ),
    "not finite": lambda v: force(v, "L", [[np.nan, 0, 0]]),
    "contradicts": lambda v: replace(v, reserve=(0.5, 0.6)),
    "balance": lambda v: replace(v, proof=None),
}


def force(verdict, name, forces):
    changed = replace(verdict.proof.forces[name], forces=np.array(forces))
    return replace(verdict, proof=replace(verdict.proof, forces={**verdict.proof.forces, name: changed}))


@pytest.mark.parametrize("word", FAULTS)
def test_the_checker_finds_wrong_balances(word):
    verdict = held(opposed(), {"K": 200.0}, across(79.0))
    wrong = FAULTS[word](verdict)
    fault = loads_fault(Finding(Answer.YES, use=LoadsHeld((wrong,), 0, {"K": 200.0}, np.zeros(6))), opposed())
    assert fault is not None
    assert word in fault


def test_the_checker_finds_wrong_motions():
    verdict = held(opposed(), {"K": 200.0}, across(81.0))
    for motion, word in (
        ([0, 0, 1.0, 0, 0, 0], "resists"),
        ([1.0, 0, 0, 0, 0, 0], "proves nothing"),
        ([0.0] * 6, "none"),
        ([np.nan] * 6, "none"),
    ):
        wrong = replace(verdict, proof=replace(verdict.proof, motion=np.array(motion)))
        fault = loads_fault(Finding(Answer.NO, use=LoadsHeld((wrong,), 0, {"K": 200.0}, np.zeros(6))), opposed())
        assert fault is not None
        assert word in fault
    weaker = loads_fault(Finding(Answer.NO, use=LoadsHeld((verdict,), 0, {"K": 210.0}, np.zeros(6))), opposed())
    assert "proves nothing" in weaker
    assert (
        loads_fault(Finding(Answer.YES, use=LoadsHeld((verdict,), 0, {"K": 200.0}, np.zeros(6))), opposed()) is not None
    )
    assert isinstance(verdict.proof, Unbalanced)


def test_a_force_turns_about_the_origin():
    assert wrench_at(np.array([1.0, 2, 3]), np.array([0, 0, 5.0])) == pytest.approx([0, 0, 5, 10, -5, 0])
    assert wrench_at(np.array([1.0, 2]), np.array([0, 5.0]), np.array([1.0])) == pytest.approx([0, 5, 6])
    assert isinstance(held(opposed(), {"K": 200.0}, across(1.0)).proof, Balance)
