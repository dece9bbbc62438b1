"""Confirms that forces balance a wrench, or that a motion proves that none do; from points and normals, by sums alone.

Forces are proofs for the normals as they are given; motions for all that these may be within their errors.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fixture_design.arrays import Point, Vector
from fixture_design.contacts import Contact, Scale, cross, motion_scaled, scale_of, unit_normal, velocity
from fixture_design.layout import Balance, ContactForce, Unbalanced, element_name
from fixture_design.tolerances import DEFAULT, WITNESS


def limit_of(scale: Scale) -> float:
    """What rounding may leave of a sum, relative to its largest term [-]."""
    return WITNESS * (1 + scale.offset)


def balance_fault(balance: Balance, contacts: Sequence[Contact], preloads: Mapping[str, float]) -> str | None:
    """What is wrong with forces that should balance a wrench; None if nothing is.

    Args:
        contacts: all that may push.  preloads: of the elements that push with a given force [N].
    """
    known = {contact.name: contact for contact in contacts}
    if set(balance.forces) - set(known):
        return f"it has forces at {', '.join(sorted(set(balance.forces) - set(known)))}, which may not push"
    scale = scale_of(contacts)
    arrays = [array for force in balance.forces.values() for array in (force.forces, force.moments)]
    if not all(np.isfinite(array).all() for array in (balance.wrench, *arrays)):
        return "its forces are not finite"
    unit = _largest(balance, scale, preloads)
    taken = {(name, clause): alternative for name, clause, alternative in balance.choice}
    faults = (_force_fault(known[name], force, unit * limit_of(scale), taken) for name, force in balance.forces.items())
    if fault := next(filter(None, faults), None):
        return fault
    if fault := _preload_fault(balance, contacts, preloads, unit * limit_of(scale)):
        return fault
    left = _about(balance.wrench, scale)
    for name, force in balance.forces.items():
        left += _wrench_of(known[name], force, scale)
    if np.linalg.norm(left) > unit * limit_of(scale):
        return f"the forces leave {np.linalg.norm(left) / unit:.1e} of the largest one"
    return None


def _about(wrench: Vector, scale: Scale) -> Vector:
    """A wrench about W's origin as one about the scale's reference, moments over its length [N]."""
    plane = len(scale.reference)
    moment = wrench[plane:] - cross(scale.reference[None], wrench[None, :plane])[0]
    return np.concatenate([wrench[:plane], moment / scale.length])


def _wrench_of(contact: Contact, force: ContactForce, scale: Scale) -> Vector:
    total = force.forces.sum(axis=0)
    moment = cross((contact.point - scale.reference)[None], total[None])[0]
    for normal, spin in zip(contact.normals, force.moments, strict=True):
        if spin:
            moment = moment + spin * unit_normal(normal)
    return np.concatenate([total, moment / scale.length])


def _largest(balance: Balance, scale: Scale, preloads: Mapping[str, float]) -> float:
    sizes = [np.linalg.norm(_about(balance.wrench, scale)), *preloads.values()]
    return float(max(sizes)) or 1.0


def _force_fault(
    contact: Contact, force: ContactForce, allowed: float, taken: Mapping[tuple[str, int], int]
) -> str | None:
    """Each force is in the cone of its normal, and of alternatives only the one taken pushes."""
    if force.forces.shape != (len(contact.normals), len(contact.point)) or len(force.moments) != len(contact.normals):
        return f"{contact.name} has {len(contact.normals)} normals, not forces of shape {force.forces.shape}"
    for normal, pushed, moment in zip(contact.normals, force.forces, force.moments, strict=True):
        unit = unit_normal(normal)
        pressing = -float(pushed @ unit)
        if pressing < -allowed:
            return f"{contact.name} pulls with {-pressing:.3g} N"
        if moment and not contact.torsion:
            return f"{contact.name} turns the part, and is not soft"
        spin = moment / contact.torsion if contact.torsion else 0.0
        across = float(np.hypot(np.linalg.norm(pushed + pressing * unit), spin))
        if across > contact.friction * pressing + allowed * max(1.0, contact.friction):
            return f"{contact.name} rubs with {across:.6g} N, and {pressing:.6g} N press it"
    start = 0
    for number, clause in enumerate(contact.clauses):
        pushing = np.flatnonzero(np.linalg.norm(force.forces[start : start + len(clause)], axis=1) > allowed)
        if len(clause) > 1 and {*pushing.tolist()} - {taken.get((contact.name, number))}:
            return f"{contact.name} pushes with an alternative that is not taken"
        start += len(clause)
    return None


def _preload_fault(
    balance: Balance, contacts: Sequence[Contact], preloads: Mapping[str, float], allowed: float
) -> str | None:
    for element, preload in preloads.items():
        pressing = 0.0
        for contact in contacts:
            if element_name(contact.name) == element and contact.name in balance.forces:
                units = np.array([unit_normal(normal) for normal in contact.normals])
                pressing -= float(np.sum(units * balance.forces[contact.name].forces))
        if abs(pressing - preload) > allowed:
            return f"{element} pushes with {pressing:.6g} N instead of {preload:.6g} N"
    return None


def motion_surplus(
    unbalanced: Unbalanced,
    contacts: Sequence[Contact],
    preloads: Mapping[str, float],
    spared: str | None = None,
) -> float | str:
    """wrench . q - R(q) of a motion that no contact without preload resists, for a motion of scaled length one [N].

    Args:
        spared: an element that may resist the motion, by at most 1 a newton; the motion is not scaled then.

    Returns:
        what is wrong if some other contact resists it.
    """
    scale = scale_of(contacts)
    size = float(np.linalg.norm(motion_scaled(unbalanced.motion, scale.reference, scale.length)))
    if not (np.isfinite(size) and size > 0 and np.isfinite(unbalanced.wrench).all()):
        return "the motion is none"
    taken: dict[str, float] = {}
    choice = {(name, clause): alternative for name, clause, alternative in unbalanced.choice}
    for contact in contacts:
        element = element_name(contact.name)
        value = max(
            _resists(contact, normal, unbalanced.motion) / size
            for clause, alternatives in enumerate(contact.clauses)
            for number, normal in enumerate(alternatives)
            if choice.get((contact.name, clause), number) == number
        )
        if element in preloads:
            taken[element] = max(taken.get(element, -np.inf), preloads[element] * value)
        elif value > limit_of(scale) + (1 / size if element == spared else 0.0):
            return f"{contact.name} resists the motion by {value:.1e} a newton"
    at_contacts = _about(unbalanced.wrench, scale) @ motion_scaled(unbalanced.motion, scale.reference, scale.length)
    return (float(at_contacts) / size - sum(taken.values())) * (1.0 if spared is None else size)


def _resists(contact: Contact, normal: Point, motion: Vector) -> float:
    """n . v + friction |[v_t; c w_n]| + e (hypot(1, friction) |v| + friction c |w|), e the error of the normal."""
    unit, v = unit_normal(normal), velocity(motion, contact.point)
    along = float(unit @ v)
    slip = float(np.linalg.norm(v - along * unit))
    turning = 0.0
    if contact.torsion:
        slip = float(np.hypot(slip, contact.torsion * float(unit @ motion[3:])))
        turning = contact.friction * contact.torsion * float(np.linalg.norm(motion[3:]))
    blur = float(np.hypot(1.0, contact.friction)) * float(np.linalg.norm(v)) + turning
    return along + contact.friction * slip + contact.provenance.normal_error * blur


def unbalanced_fault(motion: Unbalanced, contacts: Sequence[Contact], preloads: Mapping[str, float]) -> str | None:
    """What is wrong with a motion that should prove, for one branch, that nothing balances a wrench."""
    counts = {(c.name, k): len(clause) for c in contacts for k, clause in enumerate(c.clauses)}
    if not all(0 <= alternative < counts.get((name, clause), 0) for name, clause, alternative in motion.choice):
        return "its choice names alternatives that there are not"
    excess = motion_surplus(motion, contacts, preloads)
    if isinstance(excess, str):
        return excess
    unit = max([float(np.linalg.norm(_about(motion.wrench, scale_of(contacts)))), *preloads.values()])
    return None if excess > unit * DEFAULT.near else f"the motion gains {excess:.1e} N, which proves nothing"
