"""Transitions followed once more: whether each is a feasible path."""

import numpy as np

from fixture_design.assembly import ContactStateGraph, StateTransition
from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.following import held
from fixture_design.assembly.sorting import sort_configurations, states_of


def followed(graph: ContactStateGraph, geometry: ContactGeometry, edge: StateTransition) -> np.ndarray:
    """Configurations along the displacement, with the contacts that stay held: all are in the looser state."""
    tight, loose = graph.state(edge.tight).contacts, graph.state(edge.loose).contacts
    assert set(loose) < set(tight)
    pairs = [geometry.names.index(contact) for contact in loose] or [-1]
    shares = np.array([[0.03], [0.1], [0.3], [0.6], [1.0]])
    begin = np.repeat(edge.configuration[None], len(shares), axis=0)
    assert states_of(geometry, sort_configurations(geometry, begin[:1]).touching) == [tight]
    q, arrived = held(geometry, geometry.moved(begin, shares * edge.displacement), np.array([pairs] * len(shares)))
    found = sort_configurations(geometry, q)
    assert arrived.all()
    assert found.admissible.all()
    assert set(states_of(geometry, found.touching)) == {loose}, (edge.tight, edge.loose)
    return q
