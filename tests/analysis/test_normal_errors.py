"""Normals that may be off: a definite answer must hold for every normal within the error."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from fixture_design.analysis import (
    Restraint,
    accessible,
    deterministic,
    force_closure,
    form_closure,
    strongly_accessible,
)
from fixture_design.contacts import Contact, Provenance, unit_normal
from fixture_design.layout import Answer, Finding

QUESTIONS: tuple[Callable[[Restraint], Finding], ...] = (
    deterministic,
    accessible,
    strongly_accessible,
    form_closure,
    force_closure,
)


def perturbed(contact: Contact, rng: np.random.Generator) -> Contact:
    """The contact with its normals turned by up to their error, which is then none."""

    def turned(normal: np.ndarray) -> np.ndarray:
        unit = unit_normal(normal)
        side = rng.normal(size=len(unit))
        side = unit_normal(side - (side @ unit) * unit)
        angle = contact.provenance.normal_error * rng.choice([-1.0, 1.0, rng.uniform(-1, 1)])
        return np.cos(angle) * unit + np.sin(angle) * side

    clauses = tuple(tuple(turned(normal) for normal in clause) for clause in contact.clauses)
    return replace(contact, clauses=clauses, provenance=Provenance())


def rough_contacts(plane: int, seed: int) -> list[Contact]:
    """Up to ten contacts around a ball, two of three with a normal error, every fourth with two alternatives."""
    rng = np.random.default_rng([plane, seed])
    count = int(rng.integers(plane + 1, 11))
    error = float(10.0 ** rng.uniform(-3, -0.7))
    contacts = []
    for i in range(count):
        out = unit_normal(rng.normal(size=plane))
        alternatives = [out + 0.3 * rng.normal(size=plane) for _ in range(1 + (i % 4 == 3))]
        rough = Provenance("approximate", error if i % 3 else 0.0)
        contacts.append(Contact(f"C{i}", "locator", out, (tuple(alternatives),), 0.2 * (seed % 2), rough))
    return contacts


@pytest.mark.parametrize("plane", [2, 3])
def test_definite_answers_survive_the_error(plane: int) -> None:
    judged = 0
    for seed in range(12):
        contacts = rough_contacts(plane, seed)
        rng = np.random.default_rng([plane, seed, 1])
        claimed = [question(Restraint.of(contacts)).answer for question in QUESTIONS]
        for _ in range(15):
            shaken = Restraint.of([perturbed(contact, rng) for contact in contacts])
            for question, answer in zip(QUESTIONS, claimed, strict=True):
                true_answer = question(shaken).answer
                if Answer.UNDECIDED not in (answer, true_answer):
                    assert true_answer is answer, (seed, question.__name__)
                    judged += 1
    assert judged >= 12 * 15 * len(QUESTIONS) / 2


def test_errors_do_not_make_the_rank_search_long() -> None:
    """Twenty-four alternatives and one rough normal: 2^24 branches, a fraction of a second."""
    contacts = []
    for i in range(24):
        a = 2 * np.pi * i / 24
        sides = [[np.cos(a + t), np.sin(a + t), 0.0] for t in (-0.1, 0.1)]
        contacts.append(Contact.of(f"A{i}", "locator", [np.cos(a), np.sin(a), 0.0], [sides]))
    rough = Contact.on_facet("E", "locator", [0, 0, 0], [1, 0, 0])
    contacts.append(replace(rough, provenance=Provenance("approximate", 1e-3)))
    assert deterministic(Restraint.of(contacts)).answer is not Answer.YES
    assert deterministic(Restraint.of(contacts[:-1])).answer is Answer.NO
