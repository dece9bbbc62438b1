"""A way from one contact state to another: motions within states, and the transitions between them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np

from fixture_design.assembly.assembly import Configuration
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.following import held
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.assembly.graph import ContactStateGraph
from fixture_design.assembly.sorting import sort_configurations

#: Configurations that are looked at along each motion.
_LOOKED_AT = 40


#: Stand for any place of the first and of the last state.
_START, _GOAL = -1, -2


@dataclass(frozen=True, eq=False)
class Waypoint:
    """A configuration on the way and the state it is in; shape (c,)."""

    state: str
    configuration: Configuration


@dataclass(frozen=True, eq=False)
class StatePath:
    """A way through the states.

    Attributes:
        states: ids, in order.
        waypoints: between two of one state the motion is straight, with the contacts held; between two of different
            states it is a direct transition.
    """

    states: tuple[str, ...]
    waypoints: tuple[Waypoint, ...]


def state_path(graph: ContactStateGraph, start: str, goal: str) -> StatePath | None:
    """The way with the fewest transitions, each motion looked at in the geometry; None if none is found.

    Args:
        start, goal: ids of states.

    Raises:
        UnknownNameError: there is no such state.
    """
    import networkx  # noqa: PLC0415 - 100 ms of any start

    for name in (start, goal):
        graph.state(name)
    roadmap = _Roadmap(graph)
    states = graph.networkx()
    # the shortest way through the states first; where its motions do not connect, all states may help
    try:
        shortest = networkx.shortest_path(states, start, goal)
    except networkx.NetworkXNoPath:
        return None
    for allowed in (shortest, list(states)):
        way = roadmap.way(allowed, start, goal)
        if way is not None:
            names = [waypoint.state for waypoint in way]
            changed = [names[0], *(name for before, name in pairwise(names) if name != before)]
            return StatePath(tuple(changed), tuple(way))
    return None


class _Roadmap:
    """Samples and witnesses as places, motions that were looked at and transitions between them."""

    def __init__(self, graph: ContactStateGraph) -> None:
        self.geometry: ContactGeometry = geometry_of(graph.assembly)
        self.places: list[Waypoint] = []
        self.of_state: dict[str, list[int]] = {state.id: [] for state in graph.states}
        self.crossings: list[tuple[int, int]] = []
        for state in graph.states:
            for q in state.samples:
                self._add(state.id, q)
        for edge in graph.transitions:
            ends = self.geometry.moved(edge.configuration[None], edge.displacement[None])[0]
            self.crossings.append((self._add(edge.tight, edge.configuration), self._add(edge.loose, ends)))

    def _add(self, state: str, q: Configuration) -> int:
        self.places.append(Waypoint(state, q))
        self.of_state[state].append(len(self.places) - 1)
        return len(self.places) - 1

    def way(self, allowed: Iterable[str], start: str, goal: str) -> list[Waypoint] | None:
        import networkx  # noqa: PLC0415 - as above

        names = set(allowed)
        roads = networkx.Graph()
        for name in names:
            roads.add_nodes_from(self.of_state[name])
            roads.add_edges_from(self._within(name), weight=1.0)
        roads.add_edges_from(
            ((a, b) for a, b in self.crossings if {self.places[a].state, self.places[b].state} <= names), weight=10.0
        )
        # any place of the start, any place of the goal
        roads.add_edges_from(((_START, place) for place in self.of_state[start]), weight=0.0)
        roads.add_edges_from(((_GOAL, place) for place in self.of_state[goal]), weight=0.0)
        try:
            found = networkx.shortest_path(roads, _START, _GOAL, weight="weight")
        except networkx.NetworkXNoPath:
            return None
        return [self.places[place] for place in found[1:-1]]

    def _within(self, name: str) -> list[tuple[int, int]]:
        """Pairs of places in one state with a straight motion between them that stays in it."""
        pairs = list(combinations(self.of_state[name], 2))
        if not pairs:
            return []
        begin, end = (np.array([self.places[pair[k]].configuration for pair in pairs]) for k in (0, 1))
        touching = sort_configurations(self.geometry, begin).touching
        chosen = np.array([np.flatnonzero(touching[0])] * len(pairs)).reshape(len(pairs), -1)
        if not chosen.size:
            chosen = np.full((len(pairs), 1), -1)
        good, way = np.ones(len(pairs), dtype=bool), self.geometry.between(begin, end)
        for share in np.linspace(0.0, 1.0, _LOOKED_AT):
            q, arrived = held(self.geometry, self.geometry.moved(begin, share * way), chosen)
            found = sort_configurations(self.geometry, q)
            good &= arrived & found.admissible & (found.touching == touching[0]).all(axis=1)
        return [pair for pair, free in zip(pairs, good, strict=True) if free]
