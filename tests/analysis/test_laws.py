"""Laws that every verdict obeys, on generated layouts: motion, unit, order, one contact more."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest

from fixture_design.analysis import Restraint, deterministic, force_closure, form_closure, strongly_accessible
from fixture_design.contacts import Contact, Scale
from fixture_design.layout import Answer, Finding, Pose
from tests.generated import GeneratedLayout, generate

QUESTIONS: tuple[Callable[[Restraint], Finding], ...] = (
    deterministic,
    strongly_accessible,
    form_closure,
    force_closure,
)
LAYOUTS = [layout for layout in generate(90, 7) if layout.noise < 1e-12]


def answers(contacts: Sequence[Contact]) -> list[Answer | None]:
    restraint = Restraint.of(contacts)
    return [question(restraint).answer for question in QUESTIONS]


def moved(contact: Contact, pose: Pose) -> Contact:
    clauses = tuple(tuple(pose.vectors(n[None, :])[0] for n in clause) for clause in contact.clauses)
    return replace(contact, point=pose.points(contact.point[None, :])[0], clauses=clauses)


def clear_of_ties(layout: GeneratedLayout) -> bool:
    return not any(layout.is_near_tie(question) for question in layout.gaps)


@pytest.mark.parametrize("layout", LAYOUTS, ids=str)
def test_motion_unit_and_order_change_nothing(layout: GeneratedLayout) -> None:
    if not clear_of_ties(layout):
        pytest.skip("a near tie may become undecided when it is rounded once more")
    before = answers(layout.contacts)
    rng = np.random.default_rng(layout.number)
    if layout.space == "planar":
        pose = Pose.from_xy_theta(rng.normal(size=2), rng.normal())
    else:
        pose = Pose.from_xyz_rpy(rng.normal(size=3), rng.normal(size=3))
    assert answers([moved(contact, pose) for contact in layout.contacts]) == before
    assert answers([replace(c, point=c.point * 1000) for c in layout.contacts]) == before
    assert answers([layout.contacts[i] for i in rng.permutation(len(layout.contacts))]) == before


@pytest.mark.parametrize("layout", LAYOUTS[::2], ids=str)
def test_a_contact_more_never_lowers_closure(layout: GeneratedLayout) -> None:
    plane = 2 if layout.space == "planar" else 3
    rng = np.random.default_rng(layout.number)
    scale = Scale(np.zeros(plane), 1.0)
    more = Contact.on_facet("more", "locator", rng.normal(size=plane), rng.normal(size=plane))
    before = form_closure(Restraint.of(layout.contacts, scale))
    after = form_closure(Restraint.of((*layout.contacts, more), scale))
    if before.margin is not None and after.margin is not None:
        assert after.margin >= before.margin - 1e-9
    if before.answer is Answer.YES:
        assert after.answer is Answer.YES


def test_the_laws_have_layouts_to_judge() -> None:
    """Of those closed, and of those with a margin, there are enough that the laws above say something."""
    closed = [form_closure(Restraint.of(layout.contacts)).answer is Answer.YES for layout in LAYOUTS]
    assert sum(closed[::2]) >= 4
    assert sum(closed[1::2]) >= 4
    margins = [form_closure(Restraint.of(layout.contacts)).margin for layout in LAYOUTS[::2]]
    assert sum(margin is not None for margin in margins) >= 20
    assert sum(clear_of_ties(layout) for layout in LAYOUTS) >= 40


@pytest.mark.parametrize("layout", LAYOUTS[1::2], ids=str)
def test_friction_only_helps(layout: GeneratedLayout) -> None:
    rubbing = [replace(contact, friction=0.3) for contact in layout.contacts]
    if form_closure(Restraint.of(layout.contacts)).answer is Answer.YES:
        assert force_closure(Restraint.of(rubbing)).answer is Answer.YES
