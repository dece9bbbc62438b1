"""A plan through the contact states: where to go next, and which contacts may be met on the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fixture_design.assembly import ContactStateGraph, state_at
from fixture_design.assembly.assembly import Configuration
from fixture_design.assembly.features import planar_features
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.assembly.least_squares import solved
from fixture_design.errors import AssemblyError
from fixture_design.tolerances import SOLVED


@dataclass(frozen=True, eq=False)
class Leg:
    """One motion of a plan.

    Attributes:
        goal: the configuration to reach, as the assembly has the fixed parts.  state: the contact state there.
        allowed: ids of the states that are expected on the way; others are a surprise.
        press: the force with which contacts are kept [N].
    """

    goal: Configuration
    state: str
    allowed: frozenset[str]
    press: float


@dataclass(frozen=True, eq=False)
class Plan:
    """Legs one after the other; each is a way of the graph."""

    graph: ContactStateGraph
    legs: tuple[Leg, ...]

    def joining(self, state: str, before: int) -> int:
        """The leg to go on with in a state that the present one does not expect: the last that does, else the first."""
        fits = [k for k in range(before + 1) if state in self.legs[k].allowed]
        return fits[-1] if fits else 0


@dataclass(frozen=True)
class Wanted:
    """What a leg is to be, before the geometry was asked.

    Attributes:
        near: a configuration near the goal.  contacts: those at the goal; the goal is moved until they are closed.
        on_the_way: contacts that may be met, besides those of this goal and the one before.
    """

    near: tuple[float, float, float]
    contacts: tuple[str, ...] = ()
    on_the_way: tuple[str, ...] = ()
    press: float = 0.0


def plan_of(graph: ContactStateGraph, wanted: Sequence[Wanted]) -> Plan:
    """A plan whose goals are admissible and whose legs are ways of the graph.

    Raises:
        AssemblyError: a goal that is in no state with its contacts, or a leg that the graph has no way for within its
            contacts; with its number.
    """
    goals = [_goal(graph, leg, number) for number, leg in enumerate(wanted, start=1)]
    legs = []
    for number, (leg, goal) in enumerate(zip(wanted, goals, strict=True), start=1):
        before = wanted[max(number - 2, 0)].contacts
        allowed = _within(graph, {*before, *leg.contacts, *leg.on_the_way})
        legs.append(Leg(*goal, allowed, leg.press))
    for number, (first, second) in enumerate(pairwise(legs), start=2):
        _require_way(graph, first.state, second, number)
    return Plan(graph, tuple(legs))


def _goal(graph: ContactStateGraph, leg: Wanted, number: int) -> tuple[Configuration, str]:
    """The goal with its contacts closed at the given angle, and its state."""
    geometry = geometry_of(graph.assembly)
    q = np.array([leg.near], dtype=np.float64)
    if leg.contacts:
        unknown = [name for name in leg.contacts if name not in geometry.names]
        if unknown:
            raise AssemblyError(f"leg {number}: the assembly has no pair {unknown[0]!r}")
        chosen = np.array([[geometry.names.index(name) for name in leg.contacts]])
        q, left = solved(geometry, q, chosen, turning=False)
        if left[0] > SOLVED * geometry.size:
            raise AssemblyError(f"leg {number}: {', '.join(leg.contacts)} cannot be closed at this angle")
    found = state_at(graph.assembly, q[0])
    state = graph.with_contacts(leg.contacts)
    if state is None or not found.admissible or set(found.contacts) != set(leg.contacts):
        raise AssemblyError(
            f"leg {number}: the goal is in another state, or in none",
            found=f"{', '.join(found.contacts) or 'no contact'} at {q[0].tolist()}, {found.overlap:g} m deep",
            expected=", ".join(leg.contacts) or "no contact",
        )
    return q[0], state.id


def _within(graph: ContactStateGraph, contacts: set[str]) -> frozenset[str]:
    """States with no other contacts; two apices in one point pass where some of their pairs may touch."""
    return frozenset(
        state.id
        for state in graph.states
        if set(state.contacts) <= contacts or (state.coincident and set(state.contacts) & contacts)
    )


def _require_way(graph: ContactStateGraph, start: str, leg: Leg, number: int) -> None:
    import networkx  # noqa: PLC0415 - 100 ms of any start

    ways = graph.networkx().subgraph(leg.allowed | {start})
    if not networkx.has_path(ways, start, leg.state):
        raise AssemblyError(
            f"leg {number}: the graph has no way from {start} to {leg.state} within {sorted(leg.allowed)}"
        )


#: Beyond the angle at which a leaning peg's right corner reaches the edge, and short of it [rad].
_BEYOND, _SHORT = 0.14, 0.01


def corner_first(graph: ContactStateGraph, depth: float = 0.025, above: float = 0.012) -> Plan:
    """The plan for a peg in a hole that is named as in Figure 14: tilted, its left corner into the mouth, then upright.

    The tilted corner is far smaller than the hole: it gets in with errors of nearly the hole's half width. Pushed down
    to the left it stands on both edges of the hole, which is a state that no error of position hides. It is turned
    upright on both until the right corner is at the right edge, at cos(theta) = width / hole (the edges see the corner
    under a right angle); there it falls in, and the peg follows the walls down.

    Args:
        depth: how deep to go [m].  above: height of the peg's origin over the hole at the start [m].

    Raises:
        AssemblyError: an assembly without these names, or with other shapes.
    """
    width, hole = (_between(graph, *names) for names in (("apex 3", "apex 4"), ("apex 1", "apex 2")))
    edge = float(np.arccos(min(width / hole, 1.0)))
    tilt, half = edge + _BEYOND, width / 2
    left, under, right = "facet 2 - apex 1", "facet 3 - apex 2", "apex 4 - facet 7"
    tops = ("apex 3 - facet 5", "apex 3 - facet 8")
    walls = ("apex 3 - facet 6", right, left, "facet 4 - apex 2")
    return plan_of(
        graph,
        [
            Wanted((half * float(np.cos(tilt)), above, tilt)),
            Wanted((half / 4, -half / 2, tilt), (left, under), tops, press=6.0),
            Wanted((half / 8, -half / 3, edge + _SHORT), (left, under), press=6.0),
            Wanted((0.0, -hole / 2 * float(np.sin(edge)), edge / 2), (left,), (under, right), press=6.0),
            Wanted((0.0, -half / 2, 0.0), (), walls, press=2.0),
            Wanted((0.0, -depth, 0.0), (), walls, press=0.5),
        ],
    )


def _between(graph: ContactStateGraph, first: str, second: str) -> float:
    """The distance of two apices of one side [m]."""
    places = {}
    for side in planar_features(graph.assembly):
        places.update({name: at for name, at in zip(side.apex_names, side.starts, strict=True) if name is not None})
    missing = [name for name in (first, second) if name not in places]
    if missing:
        raise AssemblyError(f"this plan needs {missing[0]!r}", expected="features named as in Figure 14")
    return float(np.linalg.norm(places[first] - places[second]))
