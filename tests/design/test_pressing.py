"""Preloads: the search's linear program against vertices, brute force over clamps, and verdicts."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations, product

import numpy as np
import pytest

from fixture_design.arrays import Indices, Points
from fixture_design.contacts import Contact, Role
from fixture_design.design import CandidateRules, DesignResult, Limits, Task, design, pressing, repair
from fixture_design.design.duties import Duties, scaled
from fixture_design.design.pushing import Program, Pushes
from fixture_design.layout import Answer, Element, Layout, Load, Part, Pose
from fixture_design.verification import check
from tests.design.fakes import Spots, candidates, polygon

RECTANGLE = np.array([[0.0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
REQUIRE = {"locators": ("deterministic", "strongly_accessible", "loadable"), "all": ("form_closure", "holds_loads")}


def plate(corners: Points = RECTANGLE, **keys: object) -> Task:
    part = Part("polygon", "polygon", None, corners, 1.0, Pose.identity(2))
    return Task("plate", part, "planar", **{"require": REQUIRE, **keys})  # type: ignore[arg-type]


def load(force: tuple[float, float], point: tuple[float, float] = (0.1, 0.05), name: str = "push") -> Load:
    return Load(name, point=np.array(point), force=np.array(force))


def sure(result: DesignResult) -> float:
    assert result.satisfied is Answer.YES, result.reason
    assert result.verdict is not None
    assert check(result.verdict) == []
    assert result.preload is not None
    return result.preload


def program(corners: Points, count: int, wrenches: Points, most: float = 1e6) -> Program:
    some = candidates(polygon(corners, count))
    rows = some.pushes(rough=False)
    flags = np.zeros(len(wrenches), dtype=bool)
    none, all_push = np.zeros(len(some)), np.ones(len(some), dtype=bool)
    return Program(
        rows, rows, Duties(wrenches, flags, flags, none, np.full(len(some), most), none, all_push, np.zeros(3))
    )


def by_vertices(rows: Points, locators: list[int], clamps: list[int], wrench: Points) -> float:
    """min sum p over the vertices of {p >= 0 : D^-T (w - sum p d) >= 0}."""
    inverse = np.linalg.inv(rows[locators].T)
    a, b = inverse @ rows[clamps].T, inverse @ wrench
    half = np.vstack([np.column_stack([a, b]), np.column_stack([-np.eye(len(clamps)), np.zeros(len(clamps))])])
    best = np.inf
    for some in combinations(range(len(half)), len(clamps)):
        chosen = half[list(some)]
        if abs(np.linalg.det(chosen[:, :-1])) > 1e-9:
            p = np.linalg.solve(chosen[:, :-1], chosen[:, -1])
            if (half[:, :-1] @ p <= half[:, -1] + 1e-9).all():
                best = min(best, float(p.sum()))
    return best


@pytest.mark.parametrize("seed", range(20))
def test_the_program_is_that_of_its_vertices(seed: int) -> None:
    rng = np.random.default_rng(seed)
    wrench = rng.normal(size=3)
    one = program(RECTANGLE + 0.05 * rng.uniform(-1, 1, (4, 2)), 4, wrench[None])
    rows = one.smooth[:, 0]
    places = rng.permutation(len(rows)).tolist()
    locators, clamps = places[:3], places[3:5]
    if abs(np.linalg.det(rows[locators])) < 1e-6:
        locators[2] = places[5]
    expected = by_vertices(rows, locators, clamps, wrench)
    found = one.least(np.array(locators), np.array(clamps)).total
    assert found == pytest.approx(expected, rel=1e-6) if np.isfinite(expected) else np.isinf(found)


def test_worth_is_what_a_clamp_saves() -> None:
    rng = np.random.default_rng(1)
    one = program(RECTANGLE, 6, rng.normal(size=(2, 3)))
    locators, clamps = np.array([1, 4, 20]), np.array([8, 14])
    before = one.least(locators, clamps)
    others = np.setdiff1d(np.arange(len(one.smooth)), [*locators, *clamps])
    for other, worth in zip(others.tolist(), one.worth(before.duals, others).tolist(), strict=True):
        after = one.least(locators, np.append(clamps, other))
        assert not before.less_than(after, 1e-9)
        assert worth > before.price - 1e-6 or not after.less_than(before, 1e-6)


@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(2, 20))])
def test_preloads_of_the_fewest_against_brute_force(seed: int) -> None:
    """No layout with as few clamps pushes less than the bound; ours is told how far from it it may be."""
    rng = np.random.default_rng(seed)
    corners = RECTANGLE + 0.03 * rng.uniform(-1, 1, (4, 2))
    points = polygon(corners, 3).points
    force = tuple(100 * rng.normal(size=2))
    rules = CandidateRules(points=points)
    result = design(plate(corners, candidates=rules, loads=(load(force),), objective=("fewest", "preload")))
    found = sure(result)
    assert result.layout is not None
    assert result.best_preload is not None
    clamps = sum(element.role == "clamp" for element in result.layout.elements)
    best = fewest_by_brute_force(corners, clamps, force)
    assert result.best_preload <= best * (1 + 1e-6)
    assert found >= best * (1 - 1e-4)  # or brute force is wrong
    assert found <= 2 * best + 1e-3 * np.linalg.norm(force)


def fewest_by_brute_force(corners: Points, count: int, force: tuple[float, ...]) -> float:
    """The least preload of three locators with a way out and so many clamps that close."""
    spots = polygon(corners, 3)
    some = candidates(spots)
    rows = some.pushes(rough=False)[:, 0]
    wrench = scaled(np.array([*force, 0.1 * force[1] - 0.05 * force[0]]), some.scale)
    best = np.inf
    for locators in combinations(range(len(rows)), 3):
        away = spots.normals[list(locators)]
        angles = np.linspace(0, 2 * np.pi, 721)
        ways = np.column_stack([np.cos(angles), np.sin(angles)])
        if abs(np.linalg.det(rows[list(locators)])) < 1e-6 or not (away @ ways.T < -1e-9).all(axis=0).any():
            continue
        for clamps in combinations(sorted({*range(len(rows))} - {*locators}), count):
            if np.linalg.matrix_rank(rows[[*locators, *clamps]]) == 3 and _closes(rows[[*locators, *clamps]]):
                best = min(best, by_vertices(rows, list(locators), list(clamps), wrench))
    return best


def _closes(rows: Points) -> bool:
    """Positive weights that balance, by vertices: some one-dimensional null vector combination is positive."""
    from scipy.optimize import linprog  # noqa: PLC0415 - slow to import

    found = linprog(np.zeros(len(rows)), A_eq=rows.T, b_eq=np.zeros(3), bounds=(1e-3, None), method="highs")
    return found.x is not None


def test_a_load_that_presses_into_the_locators_needs_no_preload() -> None:
    result = design(plate(loads=(load((-100.0, -50.0)),), objective=("fewest", "preload")))
    assert sure(result) == pytest.approx(0.0, abs=1e-3)


def test_preloads_keep_within_the_limits_and_hold_with_more_clamps_or_not_at_all() -> None:
    keys = {
        "loads": (load((300.0, 0.0)), load((-300.0, 0.0), name="pull")),
        "objective": ("fewest", "accuracy", "preload"),
    }
    wide = design(plate(**keys))  # type: ignore[arg-type]
    assert sure(wide) >= 300.0
    tight = design(plate(limits=Limits(preload=(0.0, 200.0)), **keys))  # type: ignore[arg-type]
    sure(tight)
    assert tight.layout is not None
    pushes = [element.preload for element in tight.layout.elements if element.role == "clamp"]
    assert max(p for p in pushes if p is not None) <= 200.0
    assert len(pushes) >= 2
    weak = Limits(preload=(0.0, 1.0), clamps=2)
    # locators on both sides, between which the part slides out, might hold these loads without any push
    open_ = design(plate(limits=weak, **keys))  # type: ignore[arg-type]
    assert open_.satisfied is Answer.UNDECIDED
    assert open_.layout is None
    assert "preload" in (open_.reason or "")
    # whichever way it comes out, a load pulls it there
    pulls = [(300.0, 0.0), (-300.0, 0.0), (0.0, 300.0), (0.0, -300.0)]
    every = tuple(load(force, name=f"pull {k}") for k, force in enumerate(pulls))
    hopeless = design(plate(limits=weak, **{**keys, "loads": every}))  # type: ignore[arg-type]
    assert hopeless.satisfied is Answer.NO
    assert hopeless.layout is None
    assert "preload" in (hopeless.reason or "")


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_the_part_sits_where_that_is_asked(friction: float) -> None:
    require = {"locators": ("deterministic", "strongly_accessible", "loadable"), "all": ("seated", "holds_loads")}
    require["all"] = ("force_closure" if friction else "form_closure", *require["all"])
    keys = {"require": require, "friction": friction, "loads": (load((50.0, 20.0)),)}
    result = design(plate(**keys))  # type: ignore[arg-type]
    assert sure(result) > 0
    assert result.verdict is not None
    assert result.verdict.groups["all"].findings["seated"].answer is Answer.YES


@pytest.mark.parametrize(("x", "y"), [*product((0.02, 0.18), (0.02, 0.08))])
def test_a_moment_is_held_wherever_it_acts(x: float, y: float) -> None:
    result = design(plate(loads=(load((0.0, 80.0), (x, y)),), objective=("fewest", "accuracy", "preload")))
    assert result.best_preload_here is not None
    assert sure(result) >= result.best_preload_here * (1 - 1e-6)


#: Points of a plate that are enough to locate and clamp it; few, so that a design takes a moment.
FEW = np.array([[0.05, 0], [0.15, 0], [0.1, 0], [0.05, 0.1], [0.15, 0.1], [0.1, 0.1], [0, 0.05], [0, 0.03]])
AWAY = np.array([[0.0, -1]] * 3 + [[0, 1]] * 3 + [[-1, 0]] * 2)
RUBS = {"locators": ("deterministic", "loadable"), "all": ("force_closure", "holds_loads")}


def given(name: str, role: Role, at: tuple[float, float], **keys: object) -> Element:
    return Element(name, role, np.array(at), **keys)  # type: ignore[arg-type]


def start(*elements: Element, contacts: tuple[Contact, ...] = ()) -> Layout:
    return Layout("start", "planar", plate().part, elements=elements, contacts=contacts)


@pytest.mark.parametrize("role", ["support", "finger"])
def test_what_is_no_clamp_reacts(role: Role) -> None:
    """It takes the load by itself, so that nothing has to be pushed, by the bounds neither."""
    there = given("S", role, (0.2, 0.05), fixed=True)
    result = design(plate(start=start(there), loads=(load((1000.0, 0.0)),), objective=("fewest", "preload")))
    assert sure(result) == pytest.approx(0.0, abs=1e-3)
    assert result.best_preload == pytest.approx(0.0, abs=1e-6)
    assert result.best_preload_here == pytest.approx(0.0, abs=1e-6)
    assert result.layout is not None
    assert {e.name for e in result.layout.elements if e.preload is not None} == {
        e.name for e in result.layout.elements if e.role == "clamp"
    }


def test_a_contact_given_as_clamp_pushes_with_nothing_anybody_knows() -> None:
    outright = Contact("G", "clamp", np.array([0.2, 0.05]), ((np.array([1.0, 0.0]),),), 0.0)
    result = design(plate(start=start(contacts=(outright,)), loads=(load((1000.0, 0.0)),)))
    assert result.satisfied is Answer.UNDECIDED
    assert result.verdict is not None
    assert "clamp G has no preload" in (result.verdict.groups["all"].findings["holds_loads"].reason or "")


def test_a_reacting_element_is_a_locator_that_need_not_be_pressed() -> None:
    one = program(RECTANGLE, 4, np.random.default_rng(3).normal(size=(1, 3)))
    locators, clamps, other = np.array([0, 3, 13]), np.array([5, 9]), 11
    reacts = np.arange(len(one.smooth)) != other
    passive = replace(one, duties=replace(one.duties, pushes=reacts))
    expected = one.least(np.append(locators, other), clamps)
    found = passive.least(locators, np.append(clamps, other))
    assert found.total == pytest.approx(expected.total)
    assert found.each[2] == 0.0
    assert found.reactions.shape == (3,)


@pytest.mark.parametrize(("seed", "low"), [(1, 5.0), (2, 20.0)])
def test_no_bound_has_every_clamp_push(seed: int, low: float) -> None:
    rng = np.random.default_rng(seed)
    corners = RECTANGLE + 0.03 * rng.uniform(-1, 1, (4, 2))
    rules = CandidateRules(points=polygon(corners, 2).points)
    force = tuple(30 * rng.normal(size=2))
    result = design(
        plate(
            corners,
            candidates=rules,
            loads=(load(force),),
            limits=Limits(preload=(low, 1e4)),
            objective=("fewest", "accuracy"),
        )
    )
    found = sure(result)
    assert result.best_preload is not None
    assert result.best_preload <= found * (1 + 1e-6)
    assert result.best_preload_here is not None
    assert result.best_preload <= result.best_preload_here * (1 + 1e-6)
    assert result.best_preload_here <= found * (1 + 1e-6)


def test_a_bound_that_was_not_reached_is_none() -> None:
    task = plate(require=RUBS, friction=0.2, candidates=CandidateRules(points=FEW), loads=(load((1000.0, 0.0)),))
    assert design(task).best_preload_here is not None
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(pressing, "_MOST_ROUNDS", 0)
        assert design(task).best_preload_here is None


@pytest.mark.parametrize("friction", [1e-3, 1e-5])
def test_little_friction_takes_much_preload(friction: float) -> None:
    """A clamp on the face across the load's holds it by friction alone: F = 2 mu p, whatever that takes."""
    some = candidates(Spots(FEW, AWAY, ("face",) * len(FEW)), friction)
    no, none, ends = np.zeros(1, dtype=bool), np.zeros(len(some)), np.full(len(some), 1e12)
    duties = Duties(np.array([[1000.0, 0, 0]]), no, no, none, ends, none, np.ones(len(some), dtype=bool), np.zeros(3))
    least = Program(some.pushes(rough=True), some.pushes(rough=False), duties).least(np.array([0, 1, 6]), np.array([5]))
    assert least.total == pytest.approx(1000.0 / (2 * friction), rel=1e-6)


@pytest.mark.parametrize("limits", [None, (0.0, 1e12)])
def test_nothing_but_limits_caps_the_preload(limits: tuple[float, float] | None) -> None:
    task = plate(
        require=RUBS, friction=1e-5, candidates=CandidateRules(points=FEW), loads=(load((1000.0, 0.0)),),
        limits=Limits(preload=limits),
    )  # fmt: skip
    assert sure(design(task)) >= 1000.0 / 2e-5


def test_what_no_push_holds_is_not_said_to_be_a_matter_of_limits() -> None:
    sides = FEW[[0, 1, 2, 6, 7]]  # below and on the left: nothing there pushes down or to the left
    task = plate(
        require={"locators": ("deterministic", "loadable"), "all": ("holds_loads",)},
        candidates=CandidateRules(points=sides), loads=(load((100.0, 0.0)),),
    )  # fmt: skip
    result = design(task)
    assert result.satisfied is Answer.NO
    assert result.reason == "no layout among these candidates holds the loads, whatever the clamps push with"


def test_nothing_is_proved_about_friction_that_solvers_lose() -> None:
    require = {"locators": ("deterministic", "loadable"), "all": ("holds_loads",)}
    rules = CandidateRules(points=FEW)
    result = design(plate(require=require, friction=1e-9, candidates=rules, loads=(load((1000.0, 0.0)),)))
    assert result.satisfied is Answer.UNDECIDED


def test_a_clamp_comes_with_its_preload_as_one_change() -> None:
    elements = [given(f"L{k + 1}", "locator", at) for k, at in enumerate([(0.05, 0.0), (0.15, 0.0), (0.0, 0.05)])]
    clamp = given("K1", "clamp", (0.2, 0.05), preload=1e5)
    task = plate(loads=(load((10.0, 0.0)),))
    asked = Layout("open", "planar", task.part, elements=(*elements, clamp), require=REQUIRE, loads=task.loads)
    result = repair(asked)
    assert sure_preloads(result)
    assert [(step.action, step.element) for step in result.steps] == [("added", "K2")]
    assert result.changes is not None
    assert (result.changes.found, result.changes.bound) == (1, 1)
    weak = replace(asked, elements=(*elements, replace(clamp, preload=None, limits=(0.0, 1e4))))
    again = repair(weak)
    assert sure_preloads(again)
    assert [(step.action, step.element) for step in again.steps] == [("added", "K2"), ("preloaded", "K1")]


def sure_preloads(result: DesignResult) -> list[float]:
    assert result.satisfied is Answer.YES, result.reason
    assert result.layout is not None
    return [e.preload for e in result.layout.elements if e.preload is not None]


def test_zero_has_no_sign(monkeypatch: pytest.MonkeyPatch) -> None:
    """Solvers write -0.0 at times."""
    least = Program.least

    def signed(self: Program, locators: Indices, clamps: Indices) -> Pushes:
        found = least(self, locators, clamps)
        return replace(found, each=np.where(found.each == 0, -0.0, found.each))

    monkeypatch.setattr(Program, "least", signed)
    require = {"locators": ("deterministic", "loadable"), "all": ("form_closure",)}
    rules = CandidateRules(points=polygon(RECTANGLE, 3).points)
    task = plate(require=require, candidates=rules, loads=(load((-100.0, -50.0)),), objective=("fewest", "preload"))
    preloads = sure_preloads(design(task))
    assert preloads
    assert not np.signbit(preloads).any()
