"""`fixture-design classifier GRAPH`: measurement sets and discriminants of a contact-state graph."""

from __future__ import annotations

from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from fixture_design.cli.messages import say
from fixture_design.cli.numbers import at_least_zero, numbers
from fixture_design.cli.progress import shown
from fixture_design.errors import InputError
from fixture_design.io import dumps, read_graph
from fixture_design.io.outputs import check_outputs

if TYPE_CHECKING:
    from fixture_design.recognition import Classifier


def classifier(
    graph: Annotated[Path, typer.Argument(help="Graph file, from `states`.", metavar="GRAPH", readable=False)],
    out: Annotated[Path | None, typer.Option("-o", "--out", help="Classifier file.", metavar="FILE.json")] = None,
    measure: Annotated[
        Literal["force", "displacement", "both"], typer.Option("--measure", help="What is measured.")
    ] = "force",
    axes: Annotated[
        Literal["fixed", "part"], typer.Option("--axes", help="Axes of what is measured: the world's, or the part's.")
    ] = "fixed",
    friction: Annotated[float, typer.Option("--friction", help="Coefficient of every contact.")] = 0.0,
    mass: Annotated[float, typer.Option("--mass", help="Of the moving part, if its weight is not tared (kg).")] = 0.0,
    center: Annotated[
        str | None, typer.Option("--center", help="Its centre of mass, in its own frame (m).", metavar="X,Y[,Z]")
    ] = None,
    gravity: Annotated[
        str | None, typer.Option("--gravity", help="Default: 9.81 along -y, in space -z.", metavar="X,Y[,Z]")
    ] = None,
    noise: Annotated[float, typer.Option("--noise", help="Bound of the error of forces, relative to them.")] = 0.0,
    twist_noise: Annotated[float, typer.Option("--twist-noise", help="Likewise of displacements.")] = 0.0,
    floor: Annotated[float, typer.Option("--floor", help="Forces up to this tell nothing (N); not with --mass.")] = 0.0,
    interpolation: Annotated[
        Literal["neighbours", "none", "hull"], typer.Option("--interpolation", help="What is between samples.")
    ] = "neighbours",
    accuracy: Annotated[float, typer.Option("--accuracy", help="Of the interpolation (sine of an angle).")] = 0.005,
    discriminants: Annotated[
        bool, typer.Option("--discriminants/--no-discriminants", help="None: not for --c, --python; sooner.")
    ] = True,
    fewest: Annotated[bool, typer.Option("--fewest", help="The smallest groups of discriminants.")] = False,
    seed: Annotated[int, typer.Option("--seed", help="Of the samples that sets are checked on.", min=0)] = 0,
    c_file: Annotated[Path | None, typer.Option("--c", help="Discriminants as C code.", metavar="OUT.c")] = None,
    python_file: Annotated[
        Path | None, typer.Option("--python", help="Discriminants as a numpy function.", metavar="OUT.py")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout.")] = False,
) -> None:
    """Compute what may be measured in each contact state, and the fewest tests that tell one from the next.

    Exit code: 0, 2 bad input.
    """
    for value, option in ((friction, "--friction"), (mass, "--mass"), (noise, "--noise"),
                          (twist_noise, "--twist-noise"), (floor, "--floor")):  # fmt: skip
        at_least_zero(value, option)
    if not (isfinite(accuracy) and accuracy > 0):
        raise InputError("--accuracy takes a number > 0", found=repr(accuracy))
    _require_used(measure, mass, floor, twist_noise)
    if not discriminants and (fewest or c_file or python_file):
        raise InputError("--fewest, --c and --python are about discriminants, and --no-discriminants leaves them out")
    check_outputs((out, c_file, python_file), (graph,))
    known = read_graph(graph)
    if noise > 0 and floor == 0 and mass == 0 and measure != "displacement":
        say("--noise without --floor: forces of a part in free air are noise, and fit no state or a wrong one; "
            "set --floor to what the sensor shows then (N)")  # fmt: skip
    from fixture_design.recognition import Noise, build_classifier  # noqa: PLC0415 - after the arguments are known good

    try:
        made = build_classifier(
            known,
            measure=measure,
            axes=axes,
            friction=friction,
            mass=mass,
            center=numbers(center, "--center"),
            gravity=numbers(gravity, "--gravity"),
            noise=Noise(noise, twist_noise, floor),
            interpolation=interpolation,
            accuracy=accuracy,
            discriminants=discriminants,
            fewest=fewest,
            seed=seed,
            progress=shown,
        )
    except InputError as error:
        raise error.within(graph) from error
    finally:
        shown("")
    _write(made, out, c_file, python_file)
    if as_json:
        from fixture_design.io import classifier_to_dict  # noqa: PLC0415 - only where asked for

        typer.echo(dumps(classifier_to_dict(made)))
    else:
        _print(made)


def _require_used(measure: str, mass: float, floor: float, twist_noise: float) -> None:
    """No option is given that nothing would come of."""
    if floor and mass:
        raise InputError("--floor is not used with --mass: no force tells something, then")
    if floor and measure == "displacement":
        raise InputError("--floor is of forces, and --measure displacement measures none")
    if twist_noise and measure == "force":
        raise InputError("--twist-noise is of displacements, and --measure force measures none")


def _write(made: Classifier, out: Path | None, c_file: Path | None, python_file: Path | None) -> None:
    from fixture_design.io import write_classifier  # noqa: PLC0415 - as above
    from fixture_design.io.text_file import write_text  # noqa: PLC0415
    from fixture_design.recognition import c_source, numpy_source  # noqa: PLC0415

    if out is not None:
        write_classifier(made, out)
    if c_file is not None:
        write_text(c_file, c_source(made))
    if python_file is not None:
        write_text(python_file, numpy_source(made))


def _print(made: Classifier) -> None:
    cones = sum(len(state.measured) for state in made.states)
    typer.echo(f"{made.name}: {len(made.states)} states, {cones} cones, {len(made.transitions)} transitions")
    for state in made.states:
        widening = state.measured.widening
        bounds = ", ".join(
            f"{what} {value:.2g}"
            for what, value in (("forces", widening.force), ("displacements", widening.displacement))
            if f"{value:.2g}" != "0"
        )
        wider = f", widened by {bounds}" if bounds else ""
        contacts = "; ".join(state.contacts) or "no contact"
        typer.echo(f"  {state.id:>4}  {_counted(len(state.measured), 'cone')}{wider}  {contacts}")


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"
