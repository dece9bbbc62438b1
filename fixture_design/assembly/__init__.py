"""Contact states of two parts and their transitions, from geometry (thesis chapter 3).

Two parts in, a graph out: which contacts they can have, and which can follow which. `contact_geometry` is what the
method asks of the geometry; `planar`, `spatial` and, for round pegs and holes by their true shapes, `round_space` fill
it. `sampling` is the modified Monte Carlo method, `completion` finds what is beside the states that it finds: one
loosening away by the cones (`modes`, `following`), one tightening away by motions (`tracing`). Where parts and region
are symmetric (`symmetry_search`), one state of each orbit is searched, and `unfolding` writes down the others.
"""

from fixture_design.assembly.assembly import Assembly, AssemblyBody, Region
from fixture_design.assembly.control import contacts_at, control_of, state_control
from fixture_design.assembly.generate import state_graph
from fixture_design.assembly.geometry_of import geometry_of
from fixture_design.assembly.graph import ContactState, ContactStateGraph, StateTransition
from fixture_design.assembly.path import StatePath, Waypoint, state_path
from fixture_design.assembly.round_space import RIM_POINTS
from fixture_design.assembly.state_at import StateAt, state_at
from fixture_design.assembly.unseen import Unseen

__all__ = [
    "RIM_POINTS",
    "Assembly",
    "AssemblyBody",
    "ContactState",
    "ContactStateGraph",
    "Region",
    "StateAt",
    "StatePath",
    "StateTransition",
    "Unseen",
    "Waypoint",
    "contacts_at",
    "control_of",
    "geometry_of",
    "state_at",
    "state_control",
    "state_graph",
    "state_path",
]
