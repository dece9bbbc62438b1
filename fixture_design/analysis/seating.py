"""Seating: whether gravity and the clamps, closed one after the other, press the part against every locator.

First gravity acts alone, then each clamp closes in the order of the file, with those before it. At every step there
must be a balance, or the part leaves the locators that the motion of the proof leaves. A locator is pressed at a step
if its normal force is more than zero in all balances there are. It counts as pressed from then on, as long as some
balance has it pressed; and in the end it must be pressed without friction too, or only friction would keep the part
from lifting off. Supports come up later and have no part in it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fixture_design.analysis.balancing import (
    ForceBranch,
    Settled,
    branches_of,
    edges_along_edges,
    gained,
    most_resistance,
    settle,
)
from fixture_design.analysis.contact_forces import ContactForces
from fixture_design.analysis.loads import largest_factors
from fixture_design.analysis.tipping import ON_AN_EDGE, on_an_edge
from fixture_design.arrays import Vector, Weights
from fixture_design.cones.force_cones import ForceCones
from fixture_design.contacts import Contact, motion_about_origin, scale_of, unit_normal, velocity
from fixture_design.layout import Answer, Finding, Seating, SeatingStep, Unbalanced, element_name
from fixture_design.tolerances import CARRIES, DEFAULT, LOAD_TIE, WITNESS, Tolerances


@dataclass(frozen=True, eq=False)
class Pressing:
    """Brackets of the normal force of one locator over all balances [N], with motions that prove the least."""

    least: tuple[float, float]
    largest: tuple[float, float]
    proofs: tuple[Unbalanced, ...]


def seating(
    contacts: Sequence[Contact], preloads: Mapping[str, float], weight: Vector, tolerances: Tolerances = DEFAULT
) -> Finding:
    """Whether the part sits on its locators once all clamps are closed.

    Args:
        preloads: of every clamp that closes [N], in the order in which they do.
        weight: what acts besides, a wrench about W's origin.
    """
    locators = sat_on(contacts)
    if not locators:
        return Finding(Answer.UNDECIDED, reason="there are no locators for the part to sit on")
    steps: list[SeatingStep] = []
    for clamp in (None, *preloads):
        before = steps[-1].presses if steps else {}
        steps.append(_step(contacts, preloads, clamp, weight, locators, tuple(before), tolerances))
        if steps[-1].answer is Answer.NO:
            steps[-1] = _clearly_caused(steps[-1], contacts, preloads, weight, locators, tolerances)
            break
    last = steps[-1]
    smooth = last
    if last.answer is not Answer.NO and any(contact.friction for contact in contacts):
        smooth = _step(without_friction(contacts), preloads, last.clamp, weight, locators, (), tolerances)
    answer, reason = _summed_up(steps, smooth)
    acting = [contact for contact in contacts if contact.role != "support"]
    if answer is Answer.YES and on_an_edge(acting, preloads, weight, np.zeros(len(weight)), tolerances):
        answer, reason = Answer.UNDECIDED, ON_AN_EDGE
    return Finding(answer, reason=reason, use=Seating(tuple(steps), dict(preloads), weight, smooth))


def _clearly_caused(
    step: SeatingStep,
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
    weight: Vector,
    locators: Sequence[str],
    tolerances: Tolerances,
) -> SeatingStep:
    """The step with the cause that it has without friction, if that names fewer: friction drags others along."""
    smooth = _step(without_friction(contacts), preloads, step.clamp, weight, locators, step.lifted, tolerances)
    if smooth.answer is not Answer.NO or not 0 < len(smooth.lifted) < len(step.lifted):
        return step
    return replace(step, lifted=smooth.lifted, cause=smooth.cause)


def sat_on(contacts: Sequence[Contact]) -> list[str]:
    """The elements that must be pressed: locators, but for pins with clearance, which touch nowhere for sure."""
    return list(dict.fromkeys(element_name(c.name) for c in contacts if c.role == "locator" and not c.clearance))


def without_friction(contacts: Sequence[Contact]) -> list[Contact]:
    """The same contacts, which only push along their normals."""
    return [replace(contact, friction=0.0, torsion=0.0) for contact in contacts]


def closed_at(contacts: Sequence[Contact], preloads: Mapping[str, float], clamp: str | None) -> list[Contact]:
    """The contacts that may push at a step: no supports, and only the clamps that are closed then."""
    order = [None, *preloads]
    closed = set(order[1 : order.index(clamp) + 1])
    return [c for c in contacts if c.role != "support" and (c.role != "clamp" or element_name(c.name) in closed)]


def _summed_up(steps: Sequence[SeatingStep], smooth: SeatingStep) -> tuple[Answer, str | None]:
    last = steps[-1]
    if last.answer is Answer.NO:
        return Answer.NO, None
    if unproven := next((step for step in steps if step.proof is None), None):
        return Answer.UNDECIDED, f"{_when(unproven)}: {unproven.cause}"
    pressed = {name for step in steps for name in step.presses}
    if pressed >= set(last.reactions) and smooth.answer is Answer.YES:
        return Answer.YES, None
    if last.idle:
        return Answer.UNDECIDED, f"nothing presses the part against {', '.join(last.idle)}"
    never = [name for name in last.reactions if name not in pressed]
    if never:
        return Answer.UNDECIDED, f"friction leaves open whether the part is pressed against {', '.join(never)}"
    loose = smooth.lifted or smooth.idle
    if loose:
        return Answer.UNDECIDED, f"only friction keeps the part on {', '.join(loose)}"
    return Answer.UNDECIDED, smooth.cause or "without friction it is open whether the part is pressed"


def _when(step: SeatingStep) -> str:
    return "under gravity" if step.clamp is None else f"with {step.clamp} closed"


def _step(
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
    clamp: str | None,
    weight: Vector,
    locators: Sequence[str],
    pressed_before: Sequence[str],
    tolerances: Tolerances,
) -> SeatingStep:
    acting = closed_at(contacts, preloads, clamp)
    pushing = {name: preloads[name] for name in {element_name(c.name): 0 for c in acting} if name in preloads}
    branches, complete = branches_of(acting, pushing, tolerances)
    settled = settle(branches, complete, weight, tolerances)
    if not settled.balances:
        return _unseated(settled, clamp, acting, locators, pressed_before)
    found = {name: _pressing(branches, name, weight) for name in locators}
    unit = branches[0].unit_for(weight)
    pressed = [n for n, p in found.items() if p.least[0] > LOAD_TIE * unit and len(p.proofs) == len(branches)]
    idle = tuple(n for n, p in found.items() if p.largest[1] <= LOAD_TIE * unit)
    reactions = {name: (_zeroed(p.least[0], unit), _zeroed(p.largest[1], unit)) for name, p in found.items()}
    doubtful = [name for name in locators if name not in pressed and name not in idle]
    rough = "friction" if any(contact.friction for contact in acting) else "statics"
    cause = f"{rough} leaves open whether the part is pressed against {', '.join(doubtful)}" if doubtful else None
    certain = complete and not edges_along_edges(acting)
    if not certain:
        pressed, cause = [], cause or "its alternatives leave open whether the part is pressed"
    answer = Answer.YES if len(pressed) == len(locators) else Answer.UNDECIDED
    proof, *others = settled.balances
    presses = {name: found[name].proofs for name in pressed}
    return SeatingStep(clamp, answer, reactions, idle, (), proof, cause, tuple(others), presses)


def _zeroed(force: float, unit: float) -> float:
    """A normal force, zero if that is within rounding of the forces that there are."""
    return 0.0 if force <= LOAD_TIE * unit else float(force)


def _unseated(
    settled: Settled, clamp: str | None, acting: Sequence[Contact], locators: Sequence[str], before: Sequence[str]
) -> SeatingStep:
    """Named are those locators that the part leaves and was pressed against before; without any, all that it leaves."""
    if settled.against is None:
        return SeatingStep(clamp, Answer.UNDECIDED, {}, (), (), None, settled.reason)
    leaving = _left(settled.against, acting)
    left = tuple(name for name in locators if name in leaving)
    lifted = tuple(name for name in left if name in before) or left
    who = "gravity" if clamp is None else clamp
    cause = f"{who} moves the part" + (f" off {', '.join(lifted)}" if lifted else "")
    return SeatingStep(clamp, Answer.NO, {}, (), lifted, settled.against, cause)


def _left(against: Unbalanced, contacts: Sequence[Contact]) -> set[str]:
    """Elements of which all contacts are left by a motion, or slid over in the leaving of others."""
    scale = scale_of(contacts)
    speeds = {c.name: velocity(against.motion, c.point) for c in contacts}
    fastest = max(float(np.linalg.norm(v)) for v in speeds.values()) or scale.length
    along = {c.name: max(float(unit_normal(n) @ speeds[c.name]) for n in c.normals) for c in contacts}
    names = {element_name(c.name) for c in contacts}
    return {
        name
        for name in names
        if all(along[c.name] < -CARRIES * fastest for c in contacts if element_name(c.name) == name)
    }


def _pressing(branches: Sequence[ForceBranch], name: str, weight: Vector) -> Pressing:
    """Over all branches, since nothing says which one the part takes."""
    found = [_pressing_in(branch, name, weight) for branch in branches]
    proofs = tuple(proof for _, _, proof in found if proof is not None)
    least = min(low for low, _, _ in found)
    return Pressing((least, least), (0.0, max(high for _, high, _ in found)), proofs)


def _pressing_in(branch: ForceBranch, name: str, weight: Vector) -> tuple[float, float, Unbalanced | None]:
    """Least and largest sum of N over a locator's cones, as the factor on one more row: sum N - a = 0."""
    forces = branch.outer.in_units_of(branch.unit_for(weight))
    row = np.zeros(forces.cones.maps.shape[1])
    owners = [element_name(forces.contacts[index].name) == name for index, _ in forces.owners]
    row[forces.cones.starts[np.array(owners)]] = 1.0
    cones = ForceCones(np.vstack([forces.cones.maps, row]), forces.cones.sizes, forces.cones.heads)
    fixed = np.append(forces.applied(weight) + forces.given, 0.0)
    last = np.zeros(len(fixed))
    last[-1] = 1.0
    found = largest_factors(cones, fixed, np.array([last, -last]))
    # the first load takes N away from the sum, so that its factor is -sum N
    proof = _proof(branch, forces, found.motions[0], name, weight)
    return (0.0 if proof is None else proof.surplus), float(found.upper[1]) * forces.unit, proof


def _proof(branch: ForceBranch, forces: ContactForces, motion: Weights, name: str, weight: Vector) -> Unbalanced | None:
    """The motion as a proof of the least force, scaled so that the locator resists it by at most 1 a newton."""
    motion = motion[: forces.contacts[0].dimension]
    if not np.any(motion):
        return None
    world = motion_about_origin(motion, forces.scale.reference, forces.scale.length)
    owners = [(forces.contacts[index], normal) for index, normal in forces.owners]
    resisting = [most_resistance(c, normal, world) for c, normal in owners if element_name(c.name) == name]
    most = max(resisting, default=0.0)
    if most <= WITNESS:
        return None
    net = gained(forces, motion / most, forces.applied(weight)[: len(motion)], spared=name) * forces.unit
    return Unbalanced(weight, world / most, net, branch.choice) if net > 0 else None
