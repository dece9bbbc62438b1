"""What a command says of contact states beyond their graph's file: control sets, and a path between two states."""

from __future__ import annotations

from typing import Any

from fixture_design.assembly import ContactStateGraph, StatePath, control_of, geometry_of
from fixture_design.errors import UnsupportedError
from fixture_design.io.graph_file import graph_to_dict
from fixture_design.io.verdict_record import cone_to_dict

Data = dict[str, Any]


def graph_with_control(graph: ContactStateGraph) -> Data:
    """The graph, and for each node the sets of hybrid position/force control at its first sample.

    They are about the moving body's origin, along W's axes: the admissible displacements as cones, the forces that
    contacts can give, and the largest subspaces of each. Where too many cones make the displacements, `reason` says so.
    """
    data = graph_to_dict(graph)
    geometry = geometry_of(graph.assembly)
    for node, state in zip(data["nodes"], graph.states, strict=True):
        try:
            control = control_of(geometry, state.samples[0])
        except UnsupportedError as error:
            node["control"] = {"reason": error.problem}
            continue
        node["control"] = {
            "admissible_displacements": {"cones": [cone_to_dict(cone) for cone in control.displacements]},
            "admissible_forces": cone_to_dict(control.forces),
            "position_controlled": control.position_controlled.tolist(),
            "force_controlled": control.force_controlled.tolist(),
            "bidirectional": control.bidirectional,
        }
    return data


def path_to_dict(path: StatePath) -> Data:
    """The states on the way, and its configurations: between two of one state the motion keeps its contacts."""
    places = [{"state": place.state, "configuration": place.configuration.tolist()} for place in path.waypoints]
    return {"states": list(path.states), "waypoints": places}
