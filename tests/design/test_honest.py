"""No is said where it is proven: near ties, open normals and roles that are not what the search deals out first."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from fixture_design.contacts import Contact, Provenance
from fixture_design.design import CandidateRules, Limits, Task, design, repair
from fixture_design.design.hitting import free_motion
from fixture_design.design.near_tie import least_stopped
from fixture_design.layout import Answer, Element, Layout, Load, Part, PointTip, Pose, Requirement, SoftTip
from fixture_design.tolerances import DEFAULT
from fixture_design.verification import verify
from tests.design.fakes import Fake, Spots, box, polygon, shaft, task

Requirements = dict[str, tuple[Requirement, ...]]


def edge_middles(off: float) -> Spots:
    """Two points on each edge of a square, off its middle by so much: they close by about as much."""
    normals = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]], dtype=float)
    points = [n + sign * off * np.array([-n[1], n[0]]) for n in normals for sign in (-1, 1)]
    return Spots(np.array(points), np.repeat(normals, 2, axis=0), tuple(f"facet {1 + k // 2}" for k in range(8)))


@pytest.mark.parametrize("off", [1e-9, 1e-8, 1e-7, 1e-6])
def test_near_ties_are_answered_as_verify_does(off: float) -> None:
    spots = edge_middles(off)
    result = design(task(spots, require={"all": ("form_closure",)}), Fake(spots))
    everywhere = tuple(
        Contact(f"C{k}", "clamp", x, ((n,),)) for k, (x, n) in enumerate(zip(spots.points, spots.normals, strict=True))
    )
    require: Requirements = {"all": ("form_closure",)}
    sure = verify(Layout("all", "planar", contacts=everywhere, require=require)).satisfied
    assert sure is not Answer.NO
    assert result.satisfied is sure
    part = Part("fake", "polygon", None, None, 1.0, Pose.identity(2))
    assert repair(Layout("none", "planar", part, require=require), Fake(spots)).satisfied is sure


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("count", [60, 200])  # by the hull, by programs
def test_the_motion_of_a_tie_is_stopped_by_no_row(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    rows = rng.normal(size=(count, 6))
    rows[:, 0] = np.where(np.arange(count) % 2, 1, -1) * DEFAULT.tie * rng.random(count)
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    motion = free_motion(rows)
    assert motion is not None
    assert (rows @ motion).max() <= DEFAULT.near
    least, closes = least_stopped(rows, DEFAULT)
    assert not closes
    assert (rows @ least).max() <= np.sqrt(6) * (rows @ motion).max() + DEFAULT.zero


def test_a_contact_with_alternatives_may_notice_what_no_candidate_does() -> None:
    spots = shaft(30)
    choice = (np.array([0.6, 0.8, 0.0]), np.array([0.8, 0.6, 0.0]))
    start = Layout("start", contacts=(Contact("G", "locator", np.array([0.3, 0.0, 0.0]), (choice,)),))
    asked = task(spots, require={"locators": ("deterministic",)})
    assert design(asked, Fake(spots)).satisfied is Answer.NO
    assert design(replace(asked, start=start), Fake(spots)).satisfied is Answer.UNDECIDED
    sure = Contact("G#1", "locator", np.array([0.3, 0.0, 0.0]), ((np.array([1.0, 0.0, 0.0]),),))
    both = replace(start, contacts=(sure, replace(start.contacts[0], name="G#2")))
    assert design(replace(asked, start=both), Fake(spots)).satisfied is Answer.UNDECIDED


@pytest.mark.parametrize("count", [2, 8])
def test_soft_tips_resist_turning_as_verify_says(tmp_path: Path, count: int) -> None:
    """Two of them hold a plate by friction, which two hard points never do."""
    trimesh.creation.box((0.1, 0.06, 0.04)).export(tmp_path / "box.stl")
    solid, tip = Part("box", "mesh", tmp_path / "box.stl", None, 1.0, Pose.identity(3)), SoftTip(0.005)
    x = np.linspace(0.0, 0.03, count // 2)
    points = np.vstack([np.column_stack([x, 0 * x, 0 * x + z]) for z in (0.02, -0.02)])
    require: Requirements = {"all": ("force_closure",)}
    rules = CandidateRules(points=points, tip=tip)
    found = design(Task("soft", solid, require=require, friction=0.5, candidates=rules))
    assert found.satisfied is Answer.YES
    assert found.bound is not None
    assert found.bound.elements == found.bound.found == 2
    pair = tuple(Element(name, "clamp", np.array([0.0, 0, z]), tip) for name, z in (("A", 0.02), ("B", -0.02)))
    assert verify(Layout("pair", part=solid, elements=pair, friction=0.5, require=require)).satisfied is Answer.YES
    hard = design(Task("hard", solid, require=require, friction=0.5, candidates=replace(rules, tip=PointTip())))
    assert hard.satisfied is (Answer.NO if count == 2 else Answer.YES)


@dataclass(frozen=True, eq=False)
class _Fitted(Spots):
    """Spots of which some are on surfaces whose normals are known to 0.02 rad."""

    @property
    def provenance(self) -> tuple[Provenance, ...]:
        return tuple(Provenance("fitted", 0.02) if max(n) > 0.5 else Provenance() for n in self.normals)


@dataclass(frozen=True, eq=False)
class _OnFitted(Fake):
    def contacts(self, layout: Layout) -> tuple[Contact, ...]:
        of = {n.tobytes(): p for n, p in zip(self.given.normals, self.given.provenance, strict=True)}
        return tuple(replace(c, provenance=of[np.asarray(c.clauses[0][0]).tobytes()]) for c in super().contacts(layout))


def test_limits_are_too_small_for_certain_only_where_normals_are_known() -> None:
    """A side that leans by 0.03 rad, known to 0.02: one clamp may close with it, and verify says undecided of it."""
    spots = polygon(np.array([[0.0, 0], [2, 0], [1.97, 1], [0, 1]]), 5)
    answers = frozenset({"deterministic", "loadable", "form_closure"})
    asked = task(
        spots, require={"locators": ("deterministic", "loadable"), "all": ("form_closure",)},
        limits=Limits(clamps=1, loading=np.array([0.0, -1.0])),
    )  # fmt: skip
    fitted = _Fitted(spots.points, spots.normals, spots.features)
    assert design(asked, _OnFitted(fitted, answers)).satisfied is Answer.UNDECIDED


@pytest.mark.parametrize(("off", "answer"), [(1e-6, Answer.UNDECIDED), (3e-7, Answer.UNDECIDED), (1e-2, Answer.NO)])
def test_loads_at_the_limit_of_the_preload_are_a_tie(off: float, answer: Answer) -> None:
    plate = np.array([[0.0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
    points = np.array([[0.05, 0], [0.15, 0], [0, 0.05], [0.1, 0.1], [0.2, 0.05]])
    pulls = ((300.0, 0.0), (-300.0, 0.0), (0.0, 300.0), (0.0, -300.0))
    loads = tuple(Load(f"P{k}", point=np.array([0.1, 0.05]), force=np.array(pull)) for k, pull in enumerate(pulls))
    require: Requirements = {
        "locators": ("deterministic", "strongly_accessible", "loadable"),
        "all": ("form_closure", "holds_loads"),
    }
    part = Part("plate", "polygon", None, plate, 1.0, Pose.identity(2))
    result = design(
        Task(
            "plate", part, "planar", require=require, loads=loads, candidates=CandidateRules(points=points),
            limits=Limits(preload=(0.0, 300 * (1 - off))),
        )
    )  # fmt: skip
    assert result.satisfied is answer


@pytest.mark.parametrize(
    ("limits", "answer"),
    [
        ({"locators": 4, "clamps": 3}, Answer.YES),
        ({"locators": 6}, Answer.YES),
        ({"locators": 3, "clamps": 3}, Answer.NO),
    ],
)
def test_roles_are_dealt_out_within_the_limits(limits: Mapping[str, int], answer: Answer) -> None:
    spots = box(8)
    result = design(task(spots, require={"all": ("form_closure",)}, limits=Limits(**limits)), Fake(spots))
    assert result.satisfied is answer
    if result.layout is None:
        assert result.bound is not None
        assert result.bound.found is None
    else:
        roles = [element.role for element in result.layout.elements]
        assert roles.count("locator") <= limits["locators"]
