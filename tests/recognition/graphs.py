"""Parts of Figure 14's graph, for tests that need few states."""

from __future__ import annotations

from dataclasses import replace

from fixture_design.assembly import ContactStateGraph

#: N1 to N4 of section 4.7.
FOUR = ((), ("apex 3 - facet 5",), ("facet 2 - apex 1",), ("apex 4 - facet 7", "facet 2 - apex 1"))


def subgraph(graph: ContactStateGraph, wanted: tuple[tuple[str, ...], ...]) -> ContactStateGraph:
    """The states with these contacts, and the transitions between them."""
    states = tuple(state for state in graph.states if state.contacts in {tuple(sorted(some)) for some in wanted})
    assert len(states) == len(wanted)
    ids = {state.id for state in states}
    edges = tuple(edge for edge in graph.transitions if edge.tight in ids and edge.loose in ids)
    return replace(graph, states=states, transitions=edges)
