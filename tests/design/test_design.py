"""Layouts that design finds: verified, the fewest, and told apart from what cannot be."""

from __future__ import annotations

import numpy as np
import pytest

from fixture_design.design import DesignResult, Limits, design
from fixture_design.layout import Answer
from fixture_design.verification import check
from tests.design.fakes import Fake, Spots, ball, box, chamfered, polygon, shaft, task


def designed(spots: Spots, **keys: object) -> DesignResult:
    return design(task(spots, **keys), Fake(spots))


def holds(result: DesignResult, *, slides: bool = False) -> bool:
    """Confirmed without the search: the verdict is yes, its evidence checks, and the locators have a way out."""
    assert result.verdict is not None
    normals = np.array([c.normals[0] for c in result.verdict.contacts if c.role == "locator"])
    straight = result.out is None or bool((normals @ result.out < (1e-9 if slides else 0)).all())
    return result.verdict.satisfied is Answer.YES and check(result.verdict) == [] and straight


def counts(result: DesignResult) -> tuple[int, int]:
    assert result.layout is not None
    roles = [element.role for element in result.layout.elements]
    return roles.count("locator"), roles.count("clamp")


@pytest.mark.parametrize("seed", range(2))
def test_a_box_needs_three_clamps_against_six_locators(seed: int) -> None:
    result = designed(box(7, seed))
    assert holds(result)
    assert counts(result) == (6, 3)
    assert result.bound is not None
    assert result.bound.proven


def test_friction_saves_two_clamps_of_a_box() -> None:
    require = {"locators": ("deterministic", "strongly_accessible"), "all": ("force_closure",)}
    result = designed(box(10), require=require, friction=0.2)
    assert holds(result)
    assert counts(result) == (6, 1)


def test_a_box_is_closed_by_seven_where_the_locators_let_it_out_by_a_screw_only() -> None:
    result = designed(box(12), require={"locators": ("deterministic", "strongly_accessible"), "all": ("form_closure",)})
    assert holds(result)
    assert sum(counts(result)) == 7
    assert result.bound is not None
    assert result.bound.elements == 7
    assert result.out is None


def test_a_clamp_on_a_chamfer_does_the_work_of_three() -> None:
    result = designed(chamfered(8))
    assert holds(result)
    assert counts(result) == (6, 1)
    assert result.bound is not None
    assert result.bound.proven


@pytest.mark.parametrize(
    ("corners", "clamps"),
    [([[0, 0], [2, 0], [2, 1], [0, 1]], 2), ([[0, 0], [2, 0], [0.7, 1.3]], 1), ([[0, 0], [2, 0], [3, 1], [1, 1]], 2)],
)
def test_planar_parts_have_three_locators(corners: list[list[float]], clamps: int) -> None:
    result = designed(polygon(np.array(corners, dtype=float)))
    assert holds(result)
    assert counts(result) == (3, clamps)
    assert result.bound is not None
    assert result.bound.proven


@pytest.mark.parametrize(("spots", "locators"), [(shaft(24), 5), (ball(30), 3)])
def test_parts_that_spin_are_held_by_friction(spots: Spots, locators: int) -> None:
    result = designed(spots)
    assert holds(result)
    assert counts(result)[0] == locators
    assert "without friction" in (result.reason or "")
    assert result.layout is not None
    assert result.layout.friction == 0.2


def test_where_closure_without_friction_is_required_the_free_spin_is_told() -> None:
    require = {"locators": ("deterministic",), "all": ("form_closure",)}
    result = designed(shaft(40), require=require)
    assert result.satisfied is Answer.NO
    assert result.layout is None
    assert result.free is not None
    assert np.abs(result.free / result.free[5]).round(6).tolist() == [0, 0, 0, 0, 0, 1]


def test_too_few_elements_allowed_are_an_impossible_task() -> None:
    assert designed(box(6), limits=Limits(clamps=0)).satisfied is Answer.NO
    assert designed(box(6), limits=Limits(locators=5)).satisfied is Answer.NO


def test_where_clamps_are_too_few_for_a_way_straight_off_all_locators_the_part_slides_out() -> None:
    result = designed(box(6), limits=Limits(clamps=2))
    assert holds(result, slides=True)
    assert counts(result) == (6, 1)
    assert result.bound is not None
    assert result.bound.proven
    assert not result.bound.letting_go


def test_the_part_comes_out_against_the_loading_direction() -> None:
    result = designed(box(10), limits=Limits(loading=np.array([0.0, 0.0, -1.0])))
    assert holds(result, slides=True)
    assert result.out is not None
    assert result.out.tolist() == [0, 0, 1]


def test_elements_keep_their_distance() -> None:
    result = designed(box(9), limits=Limits(spacing=0.012))
    assert holds(result)
    assert result.layout is not None
    points = np.array([element.at for element in result.layout.elements])
    away = np.linalg.norm(points[:, None] - points[None], axis=2)
    assert away[~np.eye(len(points), dtype=bool)].min() >= 0.012


def test_the_same_seed_gives_the_same_layout() -> None:
    first, second = designed(box(6)), designed(box(6))
    assert first.layout is not None
    assert second.layout is not None
    for one, other in zip(first.layout.elements, second.layout.elements, strict=True):
        assert one.name == other.name
        assert (one.at == other.at).all()


def test_every_new_element_has_a_motion_that_it_stops() -> None:
    result = designed(box(6))
    assert [step.element for step in result.steps] == [e.name for e in result.layout.elements]  # type: ignore[union-attr]
    assert result.verdict is not None
    contacts = {contact.name: contact for contact in result.verdict.contacts}
    here = []
    for step in result.steps:
        contact = contacts[step.element]
        assert step.motion is not None
        works = [
            float(n @ step.motion[:3] + np.cross(x, n) @ step.motion[3:])
            for x, n in [(contact.point, contact.normals[0])]
        ]
        values = [
            float(o.normals[0] @ step.motion[:3] + np.cross(o.point, o.normals[0]) @ step.motion[3:]) for o in here
        ]
        if step.why == "unnoticed":  # neither way by any of those that are there
            assert abs(works[0]) > 1e-6
            assert max(map(abs, values), default=0.0) <= 1e-7
        else:
            assert step.why == "free"
            assert works[0] > 1e-6
            assert max(values, default=0.0) <= 1e-7
        here.append(contact)


@pytest.mark.parametrize(("words", "count"), [("form_closure", 4), ("force_closure", 2)])
def test_where_nothing_is_asked_of_the_locators_the_fewest_close(words: str, count: int) -> None:
    spots = polygon(np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]]), 5)
    result = designed(spots, require={"all": (words,)}, friction=0.3)
    assert holds(result)
    assert sum(counts(result)) == count
    assert result.bound is not None
    assert result.bound.proven


def test_a_fixture_may_only_locate() -> None:
    result = designed(box(6), require={"locators": ("deterministic", "strongly_accessible", "loadable")[:2]})
    assert holds(result)
    assert counts(result) == (6, 0)


def test_cancelled_at_once_gives_what_is_there() -> None:
    result = design(task(box(8)), Fake(box(8)), cancelled=lambda: True)
    assert result.satisfied in (Answer.UNDECIDED, Answer.YES)


def test_a_search_that_was_stopped_proves_no_no() -> None:
    spots = shaft(30)  # without friction it spins, and with friction there would be a layout
    stopped = design(task(spots, friction=0.3), Fake(spots), cancelled=lambda: True)
    assert stopped.satisfied is Answer.UNDECIDED
    assert "stopped" in (stopped.reason or "")
    assert design(task(spots, friction=0.3), Fake(spots)).satisfied is Answer.YES


def test_the_function_is_found_under_its_name_also_once_the_package_is_loaded() -> None:
    import fixture_design as fd  # noqa: PLC0415 - as a user does

    assert fd.read_task is not None  # loads the package `fixture_design.design`
    spots = box(6, 1)
    assert fd.design(task(spots), Fake(spots)).layout is not None
