"""The contact state graph: states as nodes, direct transitions as undirected edges (section 3.2.1)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.arrays import Vector
from fixture_design.assembly.assembly import Assembly, Configuration
from fixture_design.assembly.unseen import Unseen
from fixture_design.errors import UnknownNameError

if TYPE_CHECKING:
    import networkx


@dataclass(frozen=True, eq=False)
class ContactState:
    """A contact state N_i.

    Attributes:
        id: N1 for no contact, the others by number of contacts and names.
        contacts: the contacting pairs, sorted; the moving part's feature first.
        coincident: whether two apices are in one point.
        samples: configurations in it, shape (n, c).
    """

    id: str
    contacts: tuple[str, ...]
    coincident: bool
    samples: np.ndarray


@dataclass(frozen=True, eq=False)
class StateTransition:
    """A direct transition between two states, with its witness.

    Attributes:
        tight, loose: ids; the contacts of ``loose`` are some of those of ``tight``.
        configuration: in ``tight``, shape (c,).
        displacement: leads from there into ``loose``, shape (d,); about the moving body's origin, fixed axes (3-34).
    """

    tight: str
    loose: str
    configuration: Configuration
    displacement: Vector


@dataclass(frozen=True, eq=False)
class ContactStateGraph:
    """All contact states that were found, and all direct transitions between them.

    Attributes:
        seed: of the random starts.
        complete: False if the search was interrupted.
        unseen: what sampling says of states that it has not seen.
    """

    assembly: Assembly
    states: tuple[ContactState, ...]
    transitions: tuple[StateTransition, ...]
    unseen: Unseen
    seed: int = 0
    complete: bool = True

    def state(self, name: str) -> ContactState:
        """The state with this id.

        Raises:
            UnknownNameError: there is none.
        """
        if name not in self._by_id:
            raise UnknownNameError("state", name, self._by_id)
        return self._by_id[name]

    def with_contacts(self, contacts: tuple[str, ...] | list[str]) -> ContactState | None:
        """The state with exactly these contacts, in any order; None if it is not admissible."""
        wanted = set(contacts)
        return next((state for state in self.states if set(state.contacts) == wanted), None)

    @cached_property
    def _by_id(self) -> dict[str, ContactState]:
        return {state.id: state for state in self.states}

    def networkx(self) -> networkx.Graph:
        """As a networkx graph: nodes by id with their contacts, edges with tight and loose state."""
        import networkx  # 100 ms of any start

        graph = networkx.Graph(name=self.assembly.name)
        for state in self.states:
            contacts = list(state.contacts)
            graph.add_node(state.id, contacts=contacts, coincident=state.coincident, samples=state.samples.tolist())
        for edge in self.transitions:
            graph.add_edge(
                edge.loose, edge.tight, loose=edge.loose, tight=edge.tight,
                configuration=edge.configuration.tolist(), displacement=edge.displacement.tolist(),
            )  # fmt: skip
        return graph
