"""Where the first order does not tell: motions are followed in the real geometry (slip 2 of the reading notes)."""

from __future__ import annotations

from fixture_design.assembly import ContactStateGraph, contacts_at, state_graph
from tests.assembly.parts import box, planar


def loosenings(graph: ContactStateGraph, contacts: tuple[str, ...]) -> set[tuple[str, ...]]:
    state = graph.with_contacts(contacts)
    assert state is not None, [s.contacts for s in graph.states]
    return {graph.state(edge.loose).contacts for edge in graph.transitions if edge.tight == state.id}


def test_a_bar_square_across_a_channel_turns_free() -> None:
    """Both contacts are kept to first order, yet turning opens them as the square of the angle."""
    bar = [[-1, 0], [0, -0.2], [1, 0], [0, 0.2]]
    walls = box(-3, -4, 2, 8), box(1, -4, 2, 8)
    graph = state_graph(planar(bar, *walls, region={"x": [-1, 1], "y": [-1, 1], "theta": [-1.5, 1.5]}), samples=4)
    across = ("apex 1 - facet 6", "apex 3 - facet 12")
    assert loosenings(graph, across) == {(), across[:1], across[1:]}


def test_a_strip_between_two_opposed_pins_jams() -> None:
    """To first order it can turn; in fact it can only slide, and leaves neither pin alone."""
    strip = box(-2, -0.5, 4, 1)
    pins = [[-0.3, -1.5], [0.3, -1.5], [0, -0.5]], [[0, 0.5], [0.3, 1.5], [-0.3, 1.5]]
    graph = state_graph(planar(strip, *pins, region={"x": [-1, 1], "y": [-1, 1], "theta": [-1, 1]}), samples=4)
    between = ("facet 1 - apex 7", "facet 3 - apex 8")
    assert loosenings(graph, between) == set()


def test_a_block_in_a_slot_that_fits_exactly() -> None:
    """It slides along, with both sides against the walls, and can do nothing else."""
    block, walls = box(-1, -0.5, 2, 1), (box(-4, 0.5, 8, 2), box(-4, -2.5, 8, 2))
    graph = state_graph(planar(block, *walls, region={"x": [-1, 1], "y": [-1, 1], "theta": [-1, 1]}), samples=4)
    assert len(graph.states) == 1
    (state,) = graph.states
    assert state.id == "N2"  # N1 stands for no contact, which there is no room for
    assert len(state.contacts) == 4
    assert not graph.transitions


def test_an_apex_in_a_concave_corner_is_two_contacts() -> None:
    """The reflex apex of the fixed body is no feature of its own, and two facets there are an AND."""
    corner = [[0, 0], [3, 0], [3, -1], [-1, -1], [-1, 3], [0, 3]][::-1]
    block = [[-0.5, 0], [0, -0.5], [0.5, 0], [0, 0.5]]
    graph = state_graph(planar(block, corner, region={"x": [-1, 2], "y": [-1, 2], "theta": [-0.3, 0.3]}), samples=4)
    names = {contact for state in graph.states for contact in state.contacts}
    reflex = next(k for k, vertex in enumerate(corner) if vertex == [0, 0])
    assert not any(f"apex {len(block) + reflex + 1}" in name for name in names)
    two = [state for state in graph.states if len(state.contacts) == 2]
    assert two
    assert not any(state.coincident for state in two)
    for state in two:
        contacts = contacts_at(graph.assembly, state.samples[0])
        assert [len(contact.clauses) for contact in contacts] == [1, 1]


def test_fixed_orientation() -> None:
    """A box on a floor at theta = 0: its lower side is down, or nothing; both corners together."""
    region = {"x": [-1, 1], "y": [0, 2], "theta": [0, 0]}
    graph = state_graph(planar(box(-0.5, -0.5, 1, 1), box(-5, -1, 10, 1), region=region), samples=4)
    assert [state.contacts for state in graph.states] == [(), ("apex 1 - facet 7", "apex 2 - facet 7")]
    assert len(graph.transitions) == 1
    assert all((state.samples[:, 2] == 0).all() for state in graph.states)


def test_any_orientation() -> None:
    """A triangle on a floor: 3 apices and 3 sides."""
    region = {"x": [-1, 1], "y": [0, 2]}
    graph = state_graph(planar([[-0.5, -0.3], [0.5, -0.3], [0, 0.6]], box(-5, -1, 10, 1), region=region), samples=4)
    assert sorted(len(state.contacts) for state in graph.states) == [0, 1, 1, 1, 2, 2, 2]
    assert len(graph.transitions) == 6 + 3 * 2
