"""Which forces and motions a finding about forces must have, and that they are the proofs they should be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fixture_design.analysis.seating import sat_on, without_friction
from fixture_design.arrays import Vector
from fixture_design.contacts import Contact
from fixture_design.layout import (
    Answer,
    Balance,
    Finding,
    LoadsHeld,
    LoadVerdict,
    Seating,
    SeatingStep,
    Unbalanced,
    element_name,
)
from fixture_design.tolerances import LOAD_TIE, WITNESS
from fixture_design.verification.force_proofs import balance_fault, motion_surplus, unbalanced_fault
from fixture_design.verification.proofs import Case, coverage_fault


def loads_fault(finding: Finding, contacts: Sequence[Contact]) -> str | None:
    """What is wrong with an answer to `holds_loads`."""
    use = finding.use
    if not isinstance(use, LoadsHeld) or not use.loads:
        return "it needs loads as evidence"
    if not 0 <= use.worst < len(use.loads):
        return f"there is no load {use.worst}"
    if fault := _names_fault(use.preloads, contacts):
        return fault
    for load in use.loads:
        if fault := _load_fault(load, contacts, use.preloads, use.weight):
            return f"{load.load}{'' if load.row is None else f' row {load.row}'}: {fault}"
    answers = {load.answer for load in use.loads}
    if finding.answer is Answer.YES and answers != {Answer.YES}:
        return "a load is not held"
    if finding.answer is Answer.NO and Answer.NO not in answers:
        return "no load is shown that is not held"
    return None


def _names_fault(preloads: Mapping[str, float], contacts: Sequence[Contact]) -> str | None:
    known = {element_name(contact.name) for contact in contacts if contact.role == "clamp"}
    if strange := sorted(set(preloads) - known):
        return f"{', '.join(strange)} has a preload, and is no clamp"
    wrong = [name for name, force in preloads.items() if not (np.isfinite(force) and force >= 0)]
    return f"{', '.join(wrong)} pushes with no number" if wrong else None


def _load_fault(
    load: LoadVerdict, contacts: Sequence[Contact], preloads: Mapping[str, float], weight: Vector
) -> str | None:
    """A proof of the answer, and a reserve that does not contradict it."""
    if load.answer is Answer.UNDECIDED:
        return None
    if load.proof is None or not all(
        np.allclose(proof.wrench, weight + load.wrench, rtol=WITNESS, atol=0) for proof in (load.proof, *load.others)
    ):
        return "what it balances is not the weight and the load"
    if fault := _proof_fault(load.answer, load.proof, load.others, contacts, preloads):
        return fault
    if load.answer is Answer.YES:
        clear = load.reserve is not None and load.reserve[1] > 1 + LOAD_TIE and load.needed < 1 - LOAD_TIE
    else:
        clear = load.reserve is None or load.reserve[0] < 1 or load.needed > 1
    return None if clear else f"the reserve {load.reserve} contradicts {load.answer}"


def _proof_fault(
    answer: Answer,
    proof: Balance | Unbalanced | None,
    others: Sequence[Balance],
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
) -> str | None:
    if answer is Answer.YES:
        return (
            _balances_fault((proof, *others), contacts, preloads)
            if isinstance(proof, Balance)
            else "it needs a balance"
        )
    if not isinstance(proof, Unbalanced):
        return "it needs a motion"
    return unbalanced_fault(proof, contacts, preloads)


def _balances_fault(
    balances: Sequence[Balance], contacts: Sequence[Contact], preloads: Mapping[str, float]
) -> str | None:
    """Every branch has forces of its own that balance."""
    faults = (balance_fault(balance, contacts, preloads) for balance in balances)
    fault = next(filter(None, faults), None)
    return fault or coverage_fault([balance.choice for balance in balances], Case(contacts, contacts[0].dimension))


def seated_fault(finding: Finding, contacts: Sequence[Contact]) -> str | None:
    """What is wrong with an answer to `seated`."""
    use = finding.use
    if not isinstance(use, Seating) or not use.steps:
        return "it needs steps as evidence"
    if fault := _names_fault(use.preloads, contacts):
        return fault
    order = [None, *use.preloads]
    if [step.clamp for step in use.steps] != order[: len(use.steps)]:
        return "its steps are not those of the clamps in their order"
    for number, step in enumerate(use.steps):
        closed = dict(list(use.preloads.items())[:number])
        if fault := _step_fault(step, finding.answer, contacts, closed, use.weight):
            return f"{'gravity' if step.clamp is None else step.clamp}: {fault}"
    if finding.answer is Answer.NO:
        return None if use.steps[-1].answer is Answer.NO else "the part is unseated at no step"
    return _seat_fault(use, contacts) if finding.answer is Answer.YES else None


def _seat_fault(use: Seating, contacts: Sequence[Contact]) -> str | None:
    """Whether all clamps close, and every locator was pressed for certain, and is at the end without friction."""
    if len(use.steps) != len(use.preloads) + 1 or {*use.preloads} != _clamps(contacts):
        return "there are steps missing"
    pressed = {name for step in use.steps for name in step.presses}
    never = [name for name in sat_on(contacts) if name not in pressed or name not in use.smooth.presses]
    if never or not pressed or use.smooth.answer is not Answer.YES:
        return f"nothing shows that {', '.join(never) or 'a locator'} is pressed"
    fault = _step_fault(use.smooth, Answer.YES, without_friction(contacts), use.preloads, use.weight)
    return None if fault is None else f"without friction: {fault}"


def _clamps(contacts: Sequence[Contact]) -> set[str]:
    return {element_name(contact.name) for contact in contacts if contact.role == "clamp"}


def _step_fault(
    step: SeatingStep, answer: Answer | None, contacts: Sequence[Contact], preloads: Mapping[str, float], weight: Vector
) -> str | None:
    acting = [c for c in contacts if c.role != "support" and (c.role != "clamp" or element_name(c.name) in preloads)]
    if not acting:
        return "nothing touches the part"
    motions = [motion for shown in step.presses.values() for motion in shown]
    proofs = [proof for proof in (step.proof, *step.others, *motions) if proof is not None]
    if not all(np.array_equal(proof.wrench, weight) for proof in proofs):
        return "what it balances is not the weight"
    if step.answer is Answer.NO:
        return _proof_fault(Answer.NO, step.proof, (), acting, preloads)
    if answer is Answer.YES and (fault := _proof_fault(Answer.YES, step.proof, step.others, acting, preloads)):
        return fault
    if step.answer is Answer.YES:
        missing = [name for name in sat_on(acting) if name not in step.presses]
        if missing or not step.presses:
            return f"nothing shows that {', '.join(missing) or 'a locator'} is pressed"
    faults = (_pressed_fault(name, motions, step, acting, preloads) for name, motions in step.presses.items())
    return next(filter(None, faults), None)


def _pressed_fault(
    name: str,
    motions: Sequence[Unbalanced],
    step: SeatingStep,
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
) -> str | None:
    """Motions for all branches that only this locator resists, with the least force that they prove."""
    for motion in motions:
        least = motion_surplus(motion, contacts, preloads, spared=name)
        if isinstance(least, str):
            return least
        if name not in step.reactions:
            return f"{name} has no reaction"
        stated = step.reactions[name][0]
        if not (least > 0 and stated <= least * (1 + LOAD_TIE)):
            return f"{name} is pressed with {least:.6g} N at least, not {stated:.6g} N"
    return coverage_fault([motion.choice for motion in motions], Case(contacts, contacts[0].dimension))
