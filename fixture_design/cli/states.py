"""`fixture-design states ASSEMBLY`: the contact-state graph of two parts, the state of one configuration, a path."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fixture_design.cli.exit_codes import ExitCode
from fixture_design.cli.long_work import interruptible
from fixture_design.cli.messages import say
from fixture_design.cli.progress import shown
from fixture_design.cli.state_path import say_path
from fixture_design.errors import InputError
from fixture_design.io import dumps, read_assembly, read_graph, write_graph, write_graphml
from fixture_design.io.graph_file import is_graph
from fixture_design.io.outputs import check_outputs
from fixture_design.io.state_records import graph_with_control

if TYPE_CHECKING:
    from fixture_design.assembly import Assembly, ContactStateGraph


def states(
    assembly: Annotated[
        Path,
        typer.Argument(
            help="Assembly file (YAML or JSON), or a graph found before.", metavar="ASSEMBLY", readable=False
        ),
    ],
    out: Annotated[Path | None, typer.Option("-o", "--out", help="Graph file.", metavar="GRAPH.json")] = None,
    graphml: Annotated[
        Path | None, typer.Option("--graphml", help="The graph for other tools.", metavar="OUT.graphml")
    ] = None,
    png: Annotated[
        Path | None, typer.Option("--png", help="The graph as a picture (SVG, by its suffix).", metavar="OUT.svg")
    ] = None,
    at: Annotated[
        str | None, typer.Option("--at", help="The state of one configuration: x,y,theta.", metavar="CONFIG")
    ] = None,
    within: Annotated[
        float | None, typer.Option("--within", help="With --at: touching up to this distance (m).")
    ] = None,
    path: Annotated[
        tuple[str, str] | None,
        typer.Option("--path", help="The way from one state to another, with its motions.", metavar="FROM TO"),
    ] = None,
    seed: Annotated[int, typer.Option("--seed", help="Of the random starts.")] = 0,
    samples: Annotated[int, typer.Option("--samples", help="Configurations kept of a state.", min=1)] = 10,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout.")] = False,
) -> None:
    """Find the contact states of two parts and the transitions between them, the state of one configuration, or a path.

    With --json each state has the sets of hybrid position/force control at its first configuration.

    Exit code: 0, 1 no path was found, 2 bad input; 130, 143 or 129 after Ctrl-C, a
    termination or a closed terminal, after saving what was found.
    """
    given = read_graph(assembly) if is_graph(assembly) else None
    parts = read_assembly(assembly) if given is None else given.assembly
    check_outputs((out, graphml, png), (assembly, *parts.files))
    try:
        if at is not None:
            _say_state(parts, at, within, as_json)
            return
        graph, code = _found(parts, seed, samples) if given is None else (given, ExitCode.HOLDS)
    except InputError as error:
        raise error.within(assembly) from error
    if out is not None:
        write_graph(graph, out)
    if graphml is not None:
        write_graphml(graph, graphml)
    if png is not None:
        from fixture_design.viewing import write_graph_picture  # noqa: PLC0415 - only where asked for

        write_graph_picture(graph, png)
    if path is not None:
        say_path(graph, *path, as_json)
    elif as_json:
        typer.echo(dumps(graph_with_control(graph)))
    else:
        _print_graph(graph)
    raise typer.Exit(code)


def _found(assembly: Assembly, seed: int, samples: int) -> tuple[ContactStateGraph, ExitCode]:
    """The graph; Ctrl-C and the like end the search here, not the program, so that what was found is kept."""
    from fixture_design.assembly import state_graph  # noqa: PLC0415 - after the arguments are known good

    with interruptible(raising=True) as ended:
        try:
            graph = state_graph(assembly, seed=seed, samples=samples, progress=shown)
        finally:
            shown("")
    if graph.complete:
        return graph, ExitCode.HOLDS
    say("stopped: what was found is kept")
    return graph, ended.code


def _say_state(assembly: Assembly, text: str, within: float | None, as_json: bool) -> None:
    from fixture_design.assembly import state_at  # noqa: PLC0415 - as above

    try:
        configuration = [float(number) for number in text.strip("[] ").replace(",", " ").split()]
    except ValueError as cause:
        raise InputError("a configuration is numbers: x,y,theta", found=text, expected="--at 0,1,0.1") from cause
    found = state_at(assembly, configuration, within)
    if as_json:
        record = {"contacts": list(found.contacts), "coincident": found.coincident, "admissible": found.admissible}
        typer.echo(dumps(record | {"overlap": found.overlap, "within": found.within}))
        return
    typer.echo("; ".join(found.contacts) or "no contact")
    if found.coincident:
        typer.echo("two apices are in one point")
    if found.overlap > found.within:
        typer.echo(f"not admissible: the parts overlap by {found.overlap:.3g} m")
    elif not found.admissible:
        typer.echo("not in the region")


def _print_graph(graph: ContactStateGraph) -> None:
    coincident = sum(state.coincident for state in graph.states)
    apart = f"{coincident} with two apices in one point" if coincident else "none with two apices in one point"
    count = len(graph.states)
    typer.echo(f"{graph.assembly.name}: {count} contact states ({apart}), {len(graph.transitions)} transitions")
    for state in graph.states:
        mark = "  (two apices in one point)" if state.coincident else ""
        typer.echo(f"  {state.id:>4}  {'; '.join(state.contacts) or 'no contact'}{mark}")
    rest = graph.unseen
    typer.echo(
        f"{rest.found - rest.found_by_starts} states were found beside others only; the chance that one more random "
        f"start ends in a state that none ended in is about {rest.chance:.2g} ({rest.once} of {rest.starts})"
    )
    if not graph.complete:
        typer.echo("interrupted: the graph is not complete")
