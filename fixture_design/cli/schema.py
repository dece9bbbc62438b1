"""`fixture-design schema NAME`: the JSON Schema of a file kind."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from fixture_design.io import json_schema

_KINDS = "assembly, classifier, graph, hand, layout, task or verdict"


def schema(
    name: Annotated[str, typer.Argument(help=_KINDS, metavar="NAME")],
) -> None:
    """Print the JSON Schema of a file kind."""
    typer.echo(json.dumps(json_schema(name), indent=2))
