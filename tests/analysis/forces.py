"""What the tests of forces share: fixtures with known statics, random ones, and an independent route by pyramids."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.optimize import linprog

from fixture_design.analysis.acting import LoadRow
from fixture_design.analysis.holding import held_loads
from fixture_design.contacts import Contact, contact_edges, cross, scale_of
from fixture_design.layout import Answer, Element, Finding, Layout, LoadsHeld, LoadVerdict, Part, Pose, groups_of
from fixture_design.tolerances import DEFAULT
from fixture_design.verification.force_checks import loads_fault
from fixture_design.verification.found import FoundContacts
from fixture_design.verification.use import USE_QUESTIONS
from fixture_design.verification.use_proofs import USE_PROOFS

#: Edges of the pyramids that bracket friction cones.
EDGES = 48

#: A 3-2-1 under a block of 0.2 x 0.1 x 0.05 m, and clamps against it: points and outward normals.
SIX = {
    "S1": ([0.02, 0.02, 0], [0, 0, -1]),
    "S2": ([0.18, 0.02, 0], [0, 0, -1]),
    "S3": ([0.1, 0.08, 0], [0, 0, -1]),
    "S4": ([0.05, 0, 0.02], [0, -1, 0]),
    "S5": ([0.15, 0, 0.02], [0, -1, 0]),
    "S6": ([0, 0.05, 0.02], [-1, 0, 0]),
}
CLAMPS = {
    "K1": ([0.1, 0.05, 0.05], [0, 0, 1]),
    "K2": ([0.1, 0.1, 0.02], [0, 1, 0]),
    "K3": ([0.2, 0.05, 0.02], [1, 0, 0]),
    "corner": ([0.199, 0.099, 0.05], [0, 0, 1]),
}
WEIGHT = 2.0 * 9.81


def opposed(friction: float = 0.2, role: str = "clamp") -> list[Contact]:
    """A locator and a clamp opposite each other, 2 m apart along x."""
    return [
        Contact.on_facet("L", "locator", [-1, 0, 0], [-1, 0, 0], friction),
        Contact.on_facet("K", role, [1, 0, 0], [1, 0, 0], friction),
    ]


def across(force: float) -> LoadRow:
    """A load along z in the origin [N]."""
    return LoadRow("across", None, np.array([0, 0, force, 0, 0, 0.0]))


def block(preloads: Mapping[str, float | None] = {}, friction: float = 0.0, **keys: object) -> Layout:
    """The block of 2 kg on its 3-2-1 with these clamps; contacts are given, so that it needs no geometry."""
    part = Part("block", "mesh", None, None, 1.0, Pose.identity(3), mass=2.0, center=np.array([0.1, 0.05, 0.025]))
    contacts = [Contact.on_facet(name, "locator", *place, friction) for name, place in SIX.items()]
    contacts += [Contact.on_facet(name, "clamp", *CLAMPS[name], friction) for name in preloads]
    elements = tuple(Element(name, "clamp", np.zeros(3), preload=force) for name, force in preloads.items())
    given = {"gravity": np.array([0, 0, -9.81]), "part": part, "elements": elements, "contacts": tuple(contacts)}
    return Layout("block", **(given | keys))


def asked(layout: Layout, question: str, group: str = "all") -> Finding:
    """A finding about a layout whose contacts are given; its proofs are checked."""
    found = FoundContacts(layout.contacts, scale_of(layout.contacts), ())
    members = next(g for g in groups_of(layout, layout.contacts) if g.name == group)
    finding = USE_QUESTIONS[question](layout, members, found, DEFAULT)
    if finding.answer is Answer.UNDECIDED:
        assert finding.reason
    else:
        assert USE_PROOFS[question](finding, members.contacts) is None
    return finding


def held(contacts: Sequence[Contact], preloads: Mapping[str, float], load: LoadRow, constant=None) -> LoadVerdict:
    """The verdict about one load; its proof is checked, and it has a reason where it has none."""
    constant = np.zeros(len(load.wrench)) if constant is None else constant
    (verdict,) = held_loads(contacts, preloads, constant, [load])
    use = LoadsHeld((verdict,), 0, preloads, constant)
    if verdict.answer is Answer.UNDECIDED:
        assert verdict.reason
    else:
        assert loads_fault(Finding(verdict.answer, use=use), contacts) is None
    return verdict


def random_case(seed: int) -> tuple[list[Contact], dict[str, float], np.ndarray, LoadRow]:
    """Contacts around a body, some of them clamps or soft; a weight and a load. Every fourth is planar."""
    rng = np.random.default_rng(seed)
    plane = 2 if seed % 4 == 0 else 3
    count = int(rng.integers(3, 6) if plane == 2 else rng.integers(4, 9))
    contacts, preloads = [], {}
    for index in range(count):
        normal = rng.normal(size=plane)
        normal /= np.linalg.norm(normal)
        point = normal * np.array([1, 0.8, 0.6])[:plane] + 0.2 * rng.normal(size=plane)
        friction = float(rng.choice([0, 0.1, 0.3, 0.6]))
        torsion = 0.1 if plane == 3 and friction and rng.random() < 0.3 else 0.0
        clamp = rng.random() < 0.35
        name = f"C{index}"
        contacts.append(Contact(name, "clamp" if clamp else "locator", point, ((normal,),), friction, torsion=torsion))
        if clamp:
            preloads[name] = float(rng.uniform(10, 200))
    weight = np.zeros(3 * (plane - 1))
    weight[plane - 1] = -20
    return contacts, preloads, weight, LoadRow("cut", None, 50 * rng.normal(size=len(weight)))


def pyramid_factors(contacts, preloads, weight, wrench, side) -> tuple[float, float] | None:
    """Smallest and largest factor on a load by linear programs over pyramids inside or outside the friction cones."""
    columns, owners = [], []
    for contact in contacts:
        for normal in contact.normals:
            forces, moments = contact_edges(normal, contact.friction, contact.torsion, EDGES, side)
            turning = cross(np.broadcast_to(contact.point, forces.shape), forces) + moments
            columns.append(-np.hstack([forces, turning]))
            owners += [contact.name] * len(forces)
    edges = np.vstack(columns)
    shares = [[float(owner == name) for owner in owners] + [0.0] for name in preloads]
    equations = np.vstack([np.column_stack([edges.T, wrench]), *shares])
    sides = np.concatenate([-weight, list(preloads.values())])
    bounds = [(0, None)] * len(edges) + [(None, None)]
    ends = []
    for sign in (1.0, -1.0):
        cost = np.zeros(len(bounds))
        cost[-1] = sign
        solved = linprog(cost, A_eq=equations, b_eq=sides, bounds=bounds, method="highs")
        if solved.status == 2:
            return None
        assert solved.status in (0, 3), solved.message
        ends.append(-sign * np.inf if solved.status == 3 else float(solved.x[-1]))
    return ends[0], ends[1]
