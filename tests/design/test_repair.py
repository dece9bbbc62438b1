"""Repair: the fewest changes, against brute force; what is fixed stays; the result holds."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest

from fixture_design.cones.kernel import closure_test, closure_tests
from fixture_design.contacts import Contact, Provenance, Role
from fixture_design.design import DesignResult, repair
from fixture_design.layout import Answer, Element, KeyFeature, Layout, Part, Pose, Stage
from fixture_design.verification import check, verify
from tests.design.fakes import Fake, Spots, box, candidates, polygon

CORNERS = np.array([[0.0, 0], [2, 0], [2.3, 1.1], [0, 1]])
LOADABLE = {"locators": ("deterministic", "loadable"), "all": ("form_closure",)}
OPEN = {"locators": ("deterministic", "strongly_accessible"), "all": ("form_closure",)}


def layout(spots: Spots, elements: list[Element], require: object) -> Layout:
    p = spots.points.shape[1]
    part = Part("fake", "polygon", None, None, 1.0, Pose.identity(p))
    space = "planar" if p == 2 else "spatial"
    return Layout("given", space, part, elements=tuple(elements), require=require)  # type: ignore[arg-type]


def drawn(spots: Spots, seed: int, count: int, fixed: int = 0) -> list[Element]:
    rng = np.random.default_rng(seed)
    places = rng.choice(len(spots.points), count, replace=False)
    roles: list[Role] = ["locator", "locator", "locator", "clamp"]
    return [
        Element(f"E{k}", roles[rng.integers(4)], spots.points[place], fixed=k < fixed)
        for k, place in enumerate(places.tolist())
    ]


def holds(spots: Spots, locators: tuple[int, ...], clamps: tuple[int, ...], *, straight: bool) -> bool:
    rows = candidates(spots).rows[:, 0]
    if len(locators) < rows.shape[1] or np.linalg.matrix_rank(rows[list(locators)], 1e-7) < rows.shape[1]:
        return False
    if straight:  # it may slide along them
        normals = spots.normals[list(locators)]
        across = np.column_stack([-normals[:, 1], normals[:, 0]])
        ways = np.vstack([across, -across, -normals])
        leaves = bool((normals @ ways.T <= 1e-9).all(axis=0).any())
    else:
        tests = closure_tests(
            np.ascontiguousarray(rows[list(locators)]), np.array([0, len(locators)]), np.arange(len(locators))
        )
        leaves = tests.leaves[0] == 1
    return leaves and closure_test(rows[[*locators, *clamps]]).closes == 1


def fewest(spots: Spots, elements: list[Element], most: int, *, straight: bool) -> int:
    """The fewest changes by trying all sets of locators and clamps that so many changes lead to."""
    at = {e.name: int(np.argmin(np.linalg.norm(spots.points - e.at, axis=1))) for e in elements}
    old = {role: {at[e.name] for e in elements if e.role == role} for role in ("locator", "clamp")}
    fixed = {role: {at[e.name] for e in elements if e.role == role and e.fixed} for role in ("locator", "clamp")}

    def reached(role: str, changes: int) -> set[tuple[int, ...]]:
        sets = set()
        for out in range(changes + 1):
            for into in range(changes + 1):
                if max(out, into) != changes:
                    continue
                for leaving in combinations(sorted(old[role] - fixed[role]), out):
                    others = sorted(set(range(len(spots.points))) - old[role])
                    for coming in combinations(others, into):
                        sets.add(tuple(sorted((old[role] - set(leaving)) | set(coming))))
        return sets

    for changes in range(most + 1):
        for some in range(changes + 1):
            for locators in reached("locator", some):
                for clamps in reached("clamp", changes - some):
                    if not set(locators) & set(clamps) and holds(spots, locators, clamps, straight=straight):
                        return changes
    return most + 1


def confirm(result: DesignResult, elements: list[Element]) -> None:
    assert result.satisfied is Answer.YES, result.reason
    assert result.layout is not None
    assert result.verdict is not None
    assert check(result.verdict) == []
    assert result.changes is not None
    after = {e.name: e for e in result.layout.elements}
    before = {e.name: e for e in elements}
    assert all(after[e.name] is e for e in elements if e.fixed)
    changed = {name for name in {*after, *before} if after.get(name) is not before.get(name)}
    assert changed == {step.element for step in result.steps}
    assert len(result.steps) == result.changes.found
    for step in result.steps:
        assert step.action == (
            "added" if step.element not in before else "removed" if step.element not in after else "moved"
        )


@pytest.mark.parametrize("require", [LOADABLE, OPEN], ids=["straight", "any motion"])
@pytest.mark.parametrize("seed", [*range(8), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(8, 60))])
def test_no_fewer_changes_make_it_right(seed: int, require: dict[str, tuple[str, ...]]) -> None:
    spots = polygon(CORNERS + 0.2 * np.random.default_rng(seed).uniform(-1, 1, (4, 2)), 3)
    elements = drawn(spots, seed, 3 + seed % 4, seed % 2)
    answers = frozenset({"deterministic", "strongly_accessible", "form_closure", "loadable"})
    result = repair(layout(spots, elements, require), Fake(spots, answers))
    straight = "loadable" in require["locators"]
    most = 2
    least = fewest(spots, elements, most, straight=straight)
    if result.satisfied is Answer.NO:
        assert least > most
        return
    assert result.changes is not None
    assert result.changes.proven
    assert result.changes.found == least or (least > most and result.changes.found > most)
    confirm(result, elements)


@pytest.mark.parametrize("seed", range(6))
def test_spatial_layouts_are_repaired_and_fixed_elements_stay(seed: int) -> None:
    spots = box(6, seed)
    elements = drawn(spots, seed, 4 + seed, seed % 3)
    result = repair(layout(spots, elements, OPEN), Fake(spots))
    confirm(result, elements)


def test_a_layout_that_holds_is_left_alone() -> None:
    spots = polygon(CORNERS, 5)
    first = repair(layout(spots, [], OPEN), Fake(spots))
    assert first.layout is not None
    again = repair(first.layout, Fake(spots))
    assert again.changes is not None
    assert again.changes.found == 0
    assert again.changes.proven
    assert again.layout is first.layout


def test_a_clamp_too_few_is_one_change() -> None:
    spots = box(6, 1)
    first = repair(layout(spots, [], OPEN), Fake(spots))
    assert first.layout is not None
    clamp = next(e for e in first.layout.elements if e.role == "clamp")
    without = [e for e in first.layout.elements if e is not clamp]
    result = repair(layout(spots, without, OPEN), Fake(spots))
    confirm(result, without)
    assert [step.action for step in result.steps] == ["added"]
    assert result.verdict is not None
    assert result.margin == result.verdict.groups["all"].findings["form_closure"].margin
    assert result.margin


def test_a_locator_on_the_wrong_side_is_moved() -> None:
    spots = polygon(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]]), 5)
    places = {"L1": (0.5, 0.0), "L2": (1.5, 0.0), "L3": (1.0, 1.0)}  # between two sides: nothing stops it along x
    nearest = {name: np.argmin(np.linalg.norm(spots.points - at, axis=1)) for name, at in places.items()}
    elements = [Element(name, "locator", spots.points[place]) for name, place in nearest.items()]
    result = repair(layout(spots, elements, {"locators": ("deterministic", "strongly_accessible")}), Fake(spots))
    confirm(result, elements)
    assert [step.action for step in result.steps] == ["moved"]


@pytest.mark.parametrize(
    ("extra", "why"),
    [
        ((0.5, 1.0), ["bound"]),  # across from L1: no motion leaves both
        ((1.0, 0.0), []),  # harmless, it stays
    ],
)
def test_a_locator_is_removed_for_the_reason_that_is_told(extra: tuple[float, float], why: list[str]) -> None:
    spots = polygon(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]]), 3)
    places = {"L1": (0.5, 0.0), "L2": (1.5, 0.0), "L3": (0.0, 0.5), "L4": extra}
    nearest = {name: np.argmin(np.linalg.norm(spots.points - at, axis=1)) for name, at in places.items()}
    elements = [Element(name, "locator", spots.points[place], fixed=name != "L4") for name, place in nearest.items()]
    elements += [Element(f"K{i}", "clamp", at) for i, at in enumerate(spots.points) if at[0] == 2 or at[1] == 1]
    elements = [e for e in elements if e.role == "locator" or not np.array_equal(e.at, elements[3].at)]
    result = repair(layout(spots, elements, OPEN), Fake(spots))
    confirm(result, elements)
    removed = [step for step in result.steps if step.action == "removed"]
    assert [step.why for step in removed] == why
    for step in removed:
        assert {"L1", "L4"} <= set(step.circuit) <= {"L1", "L2", "L3", "L4"}


def test_a_layout_that_is_not_exact_enough_gets_one_locator_moved() -> None:
    corners = np.array([[0.0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
    part = Part("plate", "polygon", None, corners, 1.0, Pose.identity(2))
    places = {"L1": (0.09, 0), "L2": (0.11, 0), "L3": (0, 0.05), "K1": (0.1, 0.1), "K2": (0.2, 0.05)}
    elements = tuple(
        Element(name, "locator" if name[0] == "L" else "clamp", np.array(at), tolerance=1e-5)
        for name, at in places.items()
    )
    feature = KeyFeature("corner", np.array([0.2, 0.1]), np.array([0.0, 1]), 5e-5)  # off by 10 locator errors: 1e-4
    require = {"locators": ("deterministic", "accurate"), "all": ("form_closure",)}
    given = Layout("given", "planar", part, elements=elements, key_features=(feature,), require=require)
    assert verify(given).satisfied is Answer.NO
    result = repair(given)
    confirm(result, list(elements))
    assert [(step.action, step.element) for step in result.steps] in ([("moved", "L1")], [("moved", "L2")])


@dataclass(frozen=True, eq=False)
class Uncertain(Spots):
    """Spots whose normals on the side y = 1 are known to 0.05 rad."""

    @property
    def provenance(self) -> tuple[Provenance, ...]:
        return tuple(Provenance("fitted", 0.05) if normal[1] > 0.5 else Provenance() for normal in self.normals)


class OnUncertain(Fake):
    def contacts(self, layout: Layout) -> tuple[Contact, ...]:
        nearest = [np.argmin(np.linalg.norm(self.given.points - c.point, axis=1)) for c in super().contacts(layout)]
        known = self.given.provenance
        return tuple(
            replace(contact, provenance=known[int(index)])
            for contact, index in zip(super().contacts(layout), nearest, strict=True)
        )


def test_candidates_that_were_not_looked_at_leave_it_undecided() -> None:
    square = polygon(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]]), 5)
    spots = Uncertain(square.points, square.normals, square.features)
    ways = OnUncertain(spots)
    given = layout(spots, [], {"locators": ("deterministic",), "all": ("form_closure",)})
    holding = {0: "locator", 4: "locator", 17: "locator", 8: "clamp", 10: "clamp", 14: "clamp"}
    elements = tuple(Element(f"E{i}", role, spots.points[i]) for i, role in holding.items())  # type: ignore[arg-type]
    assert ways.verify(replace(given, elements=elements)).satisfied is Answer.YES
    result = repair(given, ways)
    assert result.satisfied is Answer.UNDECIDED
    assert result.reason is not None
    assert "5 more, whose normals are known less well, were not looked at" in result.reason


@pytest.mark.parametrize(("status", "answer"), [(1, Answer.UNDECIDED), (2, Answer.NO), (4, Answer.UNDECIDED)])
def test_a_solver_that_gives_up_proves_nothing(monkeypatch: pytest.MonkeyPatch, status: int, answer: Answer) -> None:
    spots = polygon(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]]), 3)
    places = {"L1": (0.5, 0.0), "L2": (0.5, 1.0)}  # fixed on opposite sides: no motion leaves both
    nearest = {name: np.argmin(np.linalg.norm(spots.points - at, axis=1)) for name, at in places.items()}
    elements = [Element(name, "locator", spots.points[place], fixed=True) for name, place in nearest.items()]
    gave_up = SimpleNamespace(x=None, status=status, mip_dual_bound=None)
    monkeypatch.setattr("scipy.optimize.milp", lambda *_, **__: gave_up)
    assert repair(layout(spots, elements, OPEN), Fake(spots)).satisfied is answer


RECTANGLE = np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]])
HELD = Stage("held", ("locator", "clamp"), require=("form_closure",))


def staged(places: dict[str, tuple[float, float]], active: tuple[str, ...], fixed: str = "") -> Layout:
    """A rectangle on locators, clamped, with a stage that names some of them."""
    part = Part("plate", "polygon", None, RECTANGLE, 1.0, Pose.identity(2))
    elements = tuple(
        Element(name, "locator" if name[0] == "L" else "clamp", np.array(at), fixed=name in fixed.split())
        for name, at in places.items()
    )
    seated = Stage("seated", active, require=("deterministic", "strongly_accessible"))
    return Layout("staged", "planar", part, elements=elements, stages=(seated, HELD))


THREE = {"L1": (0.3, 0.0), "L2": (1.7, 0.0), "L3": (0.0, 0.5)}


def test_what_a_stage_asks_of_some_locators_is_not_asked_of_all() -> None:
    given = staged({**THREE, "L4": (1.2, 1.0)}, ("L1", "L2", "L3"))  # L4 is across, and closes only
    assert verify(given).satisfied is Answer.NO
    result = repair(given)
    confirm(result, list(given.elements))
    assert result.layout is not None
    assert verify(result.layout).satisfied is Answer.YES
    assert [step.action for step in result.steps] == ["added"]
    assert result.changes is not None
    assert not result.changes.complete
    assert any("stage seated" in note for note in result.notes)


def test_an_element_that_a_stage_names_moves_and_does_not_leave() -> None:
    clamps = {"K1": (1.2, 1.0), "K2": (2.0, 0.5)}
    given = staged({**THREE, "L4": (1.0, 1.0), **clamps}, ("L1", "L2", "L3", "L4"))  # L4 may not be there
    assert verify(given).satisfied is Answer.NO
    result = repair(given)
    assert result.layout is not None
    confirm(result, list(given.elements))
    assert {step.action for step in result.steps} == {"moved"}
    assert {"L1", "L2", "L3", "L4"} <= {element.name for element in result.layout.elements}


def test_no_proof_where_a_stage_asks_something_of_named_locators() -> None:
    given = staged({**THREE, "L4": (0.3, 1.0)}, ("L1", "L2", "L3", "L4"), fixed="L1 L2 L3 L4")
    result = repair(given)
    assert result.satisfied is Answer.UNDECIDED
    assert result.reason is not None
    assert "stage seated is one of some contacts only (L1, L2, L3, L4)" in result.reason


def test_stages_of_whole_roles_are_proven_like_groups() -> None:
    result = repair(staged({**THREE, "L4": (1.2, 1.0)}, ("locator",)))
    assert result.satisfied is Answer.YES
    assert result.changes is not None
    assert result.changes.proven
    assert result.notes == ()


def test_what_is_fixed_costs_changes_and_no_fewer_do() -> None:
    spots = polygon(RECTANGLE, 3)
    places = {"F1": (0.5, 1.0), "F2": (1.5, 1.0), "L1": (0.5, 0.0), "L2": (1.0, 0.0), "L3": (0.0, 0.5)}
    # without F1 some motion leaves all locators; with both of them L1 and L2 have to go
    elements = [Element(name, "locator", np.array(at), fixed=name[0] == "F") for name, at in places.items()]
    elements += [Element("K1", "clamp", np.array([1.5, 0.0])), Element("K2", "clamp", np.array([2.0, 0.75]))]
    counts = []
    for some in (elements, [replace(element, fixed=False) for element in elements]):
        result = repair(layout(spots, some, OPEN), Fake(spots))
        confirm(result, some)
        assert result.changes is not None
        assert result.changes.proven
        counts.append(result.changes.found)
        assert result.changes.found == fewest(spots, some, 2, straight=False)
    assert counts == [2, 1]
