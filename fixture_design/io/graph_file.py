"""Graph files `fixture_design/graph/1`: networkx node-link JSON with the assembly embedded, and GraphML."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from fixture_design.arrays import read_only
from fixture_design.assembly import (
    RIM_POINTS,
    Assembly,
    ContactState,
    ContactStateGraph,
    StateTransition,
    Unseen,
)
from fixture_design.io.assembly_file import assembly_from_data
from fixture_design.io.documents import Document, read_document
from fixture_design.io.graph_records import GraphRecord
from fixture_design.io.json_writer import json_text
from fixture_design.io.plain_words import validated
from fixture_design.io.problems import Problem, content_error
from fixture_design.io.schema_key import require_schema
from fixture_design.io.text_file import write_text
from fixture_design.version import VERSION


def graph_to_dict(graph: ContactStateGraph, path: Path | None = None) -> dict[str, Any]:
    """The graph as its file has it; `networkx.node_link_graph(data, edges="edges")` reads it.

    Args:
        path: where it will be written, so that the assembly's files are named relative to it.
    """
    return {
        "schema": "fixture_design/graph/1",
        "directed": False,
        "multigraph": False,
        "graph": {
            "name": graph.assembly.name,
            "space": graph.assembly.space,
            "units": "m",
            "complete": graph.complete,
            "unseen": {
                "starts": graph.unseen.starts,
                "once": graph.unseen.once,
                "found_by_starts": graph.unseen.found_by_starts,
                "found": graph.unseen.found,
                "chance": graph.unseen.chance,
            },
            "run": {"version": VERSION, "seed": graph.seed},
            **_approximations(graph),
        },
        "assembly": _embedded(graph.assembly, path),
        "nodes": [
            {
                "id": state.id,
                "contacts": list(state.contacts),
                "coincident": state.coincident,
                "samples": state.samples.tolist(),
            }
            for state in graph.states
        ],
        "edges": [
            {
                "source": edge.loose,
                "target": edge.tight,
                "configuration": edge.configuration.tolist(),
                "displacement": edge.displacement.tolist(),
            }
            for edge in graph.transitions
        ],
    }


def _approximations(graph: ContactStateGraph) -> dict[str, Any]:
    """What of the graph is not exact, in words."""
    if not any(contact.startswith("disk ") for state in graph.states for contact in state.contacts):
        return {}
    return {
        "approximations": [
            f"a disk on a plane counts as {RIM_POINTS} points of its rim: its cones of motions are approximate"
        ]
    }


def write_graph(graph: ContactStateGraph, path: str | Path) -> None:
    """Writes a graph file; the file is replaced at once.

    Raises:
        FileFormatError: the file cannot be written.
    """
    path = Path(path)
    write_text(path, json_text(graph_to_dict(graph, path)))


def write_graphml(graph: ContactStateGraph, path: str | Path) -> None:
    """Writes GraphML for other tools: contacts as one text, everything else as JSON text.

    Raises:
        FileFormatError: the file cannot be written.
    """
    import networkx  # noqa: PLC0415 - 100 ms of any start

    plain = networkx.Graph(name=graph.assembly.name)
    for state in graph.states:
        label = "; ".join(state.contacts) or "no contact"
        samples = json.dumps(state.samples.tolist())
        plain.add_node(state.id, contacts=label, coincident=state.coincident, samples=samples)
    for edge in graph.transitions:
        witness = {key: json.dumps(getattr(edge, key).tolist()) for key in ("configuration", "displacement")}
        plain.add_edge(edge.loose, edge.tight, **witness)
    write_text(Path(path), "\n".join(networkx.generate_graphml(plain)) + "\n")


def is_graph(path: str | Path) -> bool:
    """Whether a file says that it is a graph.

    Raises:
        FileFormatError: the file cannot be read.
    """
    schema = read_document(path).values.get("schema")
    return isinstance(schema, str) and schema.startswith("fixture_design/graph/")


def read_graph(path: str | Path) -> ContactStateGraph:
    """The graph in a file.

    Raises:
        FileFormatError: the file cannot be read, or is no graph file.
    """
    document = read_document(path)
    require_schema(document, "graph")
    record = validated(GraphRecord, document)
    assembly = assembly_from_data(dict(record.assembly), path)
    known = [node.id for node in record.nodes]
    unknown = [
        Problem(("edges", index, key), f"there is no node {name!r}", expected="the id of a node")
        for index, edge in enumerate(record.edges)
        for key, name in (("source", edge.source), ("target", edge.target))
        if name not in known
    ]
    if unknown:
        raise content_error(unknown, document)
    rest = record.graph.unseen
    return ContactStateGraph(
        assembly=assembly,
        states=tuple(
            ContactState(node.id, node.contacts, node.coincident, _rows(node.samples, document))
            for node in record.nodes
        ),
        transitions=tuple(
            StateTransition(edge.target, edge.source, read_only(edge.configuration), read_only(edge.displacement))
            for edge in record.edges
        ),
        unseen=Unseen(rest.starts, rest.once, rest.found_by_starts, rest.found),
        seed=record.graph.run.seed,
        complete=record.graph.complete,
    )


def _rows(samples: tuple[tuple[float, ...], ...], document: Document) -> np.ndarray:
    if len({len(sample) for sample in samples}) > 1:
        raise content_error([Problem(("nodes",), "samples have different lengths")], document)
    return read_only(samples)


def _embedded(assembly: Assembly, path: Path | None) -> dict[str, Any]:
    """The assembly's own mapping, with its name, and files that it names found from the new place."""
    data = json.loads(json.dumps(dict(assembly.data))) | {"name": assembly.name}
    if path is None or assembly.source is None:
        return data
    fixed = data["fixed"] if isinstance(data["fixed"], list) else [data["fixed"]]
    for body in [data["moving"], *fixed]:
        for key in ("mesh", "urdf"):
            if key in body:
                body[key] = os.path.relpath(assembly.source.parent / body[key], path.parent)
    return data
