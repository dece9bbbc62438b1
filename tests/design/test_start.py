"""Starts that bind, fall short or are hopeless end right, and keep what they were told to keep."""

from __future__ import annotations

import numpy as np
import pytest

from fixture_design.contacts import Role
from fixture_design.design import DesignResult, design
from fixture_design.design.adding import added, free_spans
from fixture_design.design.candidates import flat
from fixture_design.design.hitting import free_motion
from fixture_design.design.removing import cleared
from fixture_design.design.straight import cells, different
from fixture_design.layout import Answer, Element, Layout, Verdict
from fixture_design.verification import check
from tests.design.fakes import Fake, Spots, box, candidates, polygon, task

RECTANGLE = np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]])


def started(spots: Spots, elements: list[Element], **keys: object) -> DesignResult:
    space = "planar" if spots.points.shape[1] == 2 else "spatial"
    start = Layout("start", space, elements=tuple(elements))
    return design(task(spots, start=start, **keys), Fake(spots))


def random_start(spots: Spots, seed: int, count: int, fixed: int) -> list[Element]:
    rng = np.random.default_rng(seed)
    places = rng.choice(len(spots.points), count, replace=False)
    roles: list[Role] = ["locator", "locator", "clamp"]
    return [
        Element(f"E{k}", roles[rng.integers(3)], spots.points[place], fixed=k < fixed)
        for k, place in enumerate(places.tolist())
    ]


def confirm(result: DesignResult, elements: list[Element]) -> None:
    """The layout holds, has a straight way out, and its fixed elements are as they were."""
    assert result.satisfied is Answer.YES, result.reason
    assert result.layout is not None
    assert result.verdict is not None
    assert check(result.verdict) == []
    after = {element.name: element for element in result.layout.elements}
    for element in elements:
        if element.fixed:
            assert after[element.name] is element
    normals = np.array([c.normals[0] for c in result.verdict.contacts if c.role == "locator"])
    assert result.out is not None
    assert (normals @ result.out < 1e-9).all()
    if not pinched(result.verdict, elements):
        assert (normals @ result.out < 0).all()
    removed = {step.element for step in result.steps if step.action == "removed"}
    assert removed == {element.name for element in elements} - set(after)


def pinched(verdict: Verdict, elements: list[Element]) -> bool:
    """Whether the fixed locators leave no direction straight off all of them, so that the part has to slide out."""
    names = {element.name for element in elements if element.fixed}
    fixed = np.array([c.normals[0] for c in verdict.contacts if c.role == "locator" and c.name in names])
    if not len(fixed):
        return False
    normals, _ = different(fixed)
    return not any(cell.leaves.all() for cell in cells(normals)[0])


@pytest.mark.parametrize("seed", range(6))
def test_planar_starts_end_right(seed: int) -> None:
    spots = polygon(RECTANGLE, 6)
    elements = random_start(spots, seed, seed % 8, 0)
    confirm(started(spots, elements), elements)


@pytest.mark.parametrize("seed", range(4))
def test_spatial_starts_end_right_and_keep_what_is_fixed(seed: int) -> None:
    spots = box(6, 1)
    elements = random_start(spots, seed, 3 + 3 * seed, 2)
    result = started(spots, elements)
    if result.satisfied is Answer.NO:  # two fixed locators on opposite faces
        assert "must stay" in (result.reason or "")
        return
    confirm(result, elements)


def test_a_good_start_is_left_alone() -> None:
    spots = polygon(RECTANGLE, 6)
    first = design(task(spots), Fake(spots))
    assert first.layout is not None
    again = started(spots, list(first.layout.elements))
    assert again.layout is not None
    assert [e.name for e in again.layout.elements] == [e.name for e in first.layout.elements]
    assert all(a is b for a, b in zip(again.layout.elements, first.layout.elements, strict=True))
    assert again.steps == ()


def test_two_fixed_locators_that_pinch_the_part_are_a_conflict() -> None:
    spots = polygon(RECTANGLE, 5)
    elements = [
        Element("A", "locator", np.array([1.0, 0.0]), fixed=True),
        Element("B", "locator", np.array([1.0, 1.0]), fixed=True),
    ]
    result = started(spots, elements)
    assert result.satisfied is Answer.NO
    assert "A, B must stay" in (result.reason or "")


def test_two_fixed_locators_that_a_turn_leaves_and_the_part_slides_between_are_kept() -> None:
    spots = polygon(RECTANGLE, 5)
    elements = [
        Element("A", "locator", spots.points[0], fixed=True),
        Element("B", "locator", spots.points[10], fixed=True),
    ]
    assert abs(spots.points[0][0] - spots.points[10][0]) > 0.1
    result = started(spots, elements)
    assert result.satisfied is Answer.YES
    assert result.layout is not None
    assert result.verdict is not None
    assert check(result.verdict) == []
    assert [e for e in result.layout.elements if e.fixed] == elements
    assert result.out is not None
    assert np.abs(result.out).round(9).tolist() == [1, 0]


def test_of_a_circuit_that_binds_one_leaves_and_the_record_names_it() -> None:
    spots = polygon(RECTANGLE, 5)
    some = candidates(spots)
    bottom, top, side = 0, 12, 6
    left = cleared(some, [bottom, top, side], [bottom], str)
    assert set(left.locators) == {bottom, side}
    assert left.steps[0].why == "bound"
    assert left.steps[0].element == str(top)
    assert set(left.steps[0].circuit) == {str(bottom), str(top)}


@pytest.mark.parametrize("seed", range(10))
def test_what_is_left_has_a_way_out_and_no_dependence(seed: int) -> None:
    spots = box(3, seed)
    some = candidates(spots)
    chosen = np.random.default_rng(seed).choice(len(some), 9, replace=False).tolist()
    left = cleared(some, chosen, [], str)
    rows = flat(some.rows, left.locators)
    assert np.linalg.matrix_rank(rows, 1e-9) == len(rows)
    normals, _ = different(some.normals[list(left.locators), 0])
    assert any(cell.leaves.all() for cell in cells(normals)[0])
    assert len(left.steps) + len(left.locators) == len(chosen)


@pytest.mark.parametrize("seed", range(4))
def test_adding_stops_every_span_vector(seed: int) -> None:
    some = candidates(box(4, seed))
    here = np.random.default_rng(seed).choice(len(some), seed, replace=False)
    record = added(some.rows, here, np.setdiff1d(np.arange(len(some)), here))
    everything = [*here.tolist(), *(index for index, _ in record)]
    assert free_motion(flat(some.rows, everything)) is None
    assert not len(free_spans(flat(some.rows, everything)))
    for index, motion in record:
        before = everything[: everything.index(index)]
        assert (some.rows[index] @ motion).max() > 1e-8
        assert (flat(some.rows, before) @ motion).max(initial=0.0) <= 1e-8


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(500))
def test_random_starts_end_right_and_keep_what_they_were_told_to_keep(seed: int) -> None:
    spots = (
        polygon(RECTANGLE + 0.3 * np.random.default_rng(seed).uniform(-1, 1, (4, 2)), 5) if seed % 2 else box(5, seed)
    )
    elements = random_start(spots, seed, seed % 13, seed % 3)
    result = started(spots, elements)
    if result.satisfied is Answer.NO:
        assert seed % 3
        assert "must stay" in (result.reason or "") or "no straight way out" in (result.reason or "")
        return
    confirm(result, elements)
