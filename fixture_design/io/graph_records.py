"""The graph file `fixture_design/graph/1`, key by key: networkx node-link JSON."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from fixture_design.io.record_types import Number, Record, Text

Numbers = Annotated[tuple[Number, ...], Field(strict=False, min_length=3)]


class NodeRecord(Record):
    """A contact state."""

    WANTED: ClassVar[str] = "a node with id, contacts and samples"
    id: Text
    contacts: Annotated[tuple[str, ...], Field(strict=False)]
    coincident: bool = False
    samples: Annotated[tuple[Numbers, ...], Field(strict=False)]


class EdgeRecord(Record):
    """A direct transition; `target` has more contacts, and the configuration is in it."""

    WANTED: ClassVar[str] = "an edge with source, target, configuration and displacement"
    source: Text
    target: Text
    configuration: Numbers
    displacement: Numbers


class UnseenRecord(Record):
    """What sampling says of states that it has not seen."""

    WANTED: ClassVar[str] = "{starts: n, once: n, found_by_starts: n, found: n, chance: p}"
    starts: int
    once: int
    found_by_starts: int
    found: int
    chance: Number


class RunRecord(Record):
    """What made the graph."""

    WANTED: ClassVar[str] = "{version: text, seed: number}"
    version: Text
    seed: int


class AboutRecord(Record):
    """Attributes of the graph itself."""

    WANTED: ClassVar[str] = "the attributes of the graph"
    name: Text
    space: Literal["planar", "spatial"]
    units: Literal["m"]
    complete: bool = True
    unseen: UnseenRecord
    run: RunRecord
    approximations: Annotated[tuple[Text, ...], Field(strict=False)] = ()


class GraphRecord(Record):
    """A contact state graph."""

    WANTED: ClassVar[str] = "a contact-state graph"
    schema_: Literal["fixture_design/graph/1"] = Field(alias="schema")
    directed: Literal[False]
    multigraph: Literal[False]
    graph: AboutRecord
    assembly: dict[str, Any]
    nodes: Annotated[tuple[NodeRecord, ...], Field(strict=False)]
    edges: Annotated[tuple[EdgeRecord, ...], Field(strict=False)]
