"""`fixture-design states ... --path FROM TO`: a way through the contact states, with its motions."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import typer

from fixture_design.cli.exit_codes import ExitCode
from fixture_design.errors import InputError
from fixture_design.io import dumps
from fixture_design.io.state_records import path_to_dict

if TYPE_CHECKING:
    from fixture_design.assembly import ContactStateGraph, StatePath
    from fixture_design.assembly.assembly import Configuration


def say_path(graph: ContactStateGraph, start: str, goal: str, as_json: bool) -> None:
    """Prints the way with the fewest transitions.

    Raises:
        InputError: there is no such state.
        typer.Exit: with 1, where no way was found.
    """
    from fixture_design.assembly import state_path  # noqa: PLC0415 - after the arguments are known good

    try:
        path = state_path(graph, start, goal)
    except InputError as error:
        raise error if graph.assembly.source is None else error.within(graph.assembly.source) from error
    if path is None:
        typer.echo(dumps(None) if as_json else f"no path from {start} to {goal} was found")
        raise typer.Exit(ExitCode.FAILS)
    if as_json:
        typer.echo(dumps(path_to_dict(path)))
    else:
        _print(graph, path)


def _print(graph: ContactStateGraph, path: StatePath) -> None:
    typer.echo(" - ".join(path.states))
    first = path.waypoints[0]
    typer.echo(f"  {first.state:>4}  {_contacts(graph, first.state)}")
    typer.echo(f"        at {_numbers(first.configuration)}")
    for before, after in pairwise(path.waypoints):
        if before.state != after.state:
            typer.echo(f"  {after.state:>4}  {_contacts(graph, after.state)}")
        typer.echo(f"        to {_numbers(after.configuration)}")


def _contacts(graph: ContactStateGraph, state: str) -> str:
    return "; ".join(graph.state(state).contacts) or "no contact"


def _numbers(configuration: Configuration) -> str:
    return ", ".join(f"{value:.6g}" for value in configuration)
