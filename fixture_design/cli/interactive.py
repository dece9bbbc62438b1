"""`fixture-design interactive LAYOUT or PART`: a layout changed in the browser, with its verdict at every moment."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fixture_design.cli.exit_codes import ExitCode
from fixture_design.cli.long_work import interruptible
from fixture_design.cli.messages import printable, say
from fixture_design.errors import InputError

_OUT = typer.Option("--out", "-o", help="File that `save` writes; by default a new one beside the input.")


def interactive(
    layout_or_part: Annotated[Path, typer.Argument(help="Layout file, or a part.", metavar="LAYOUT", readable=False)],
    port: Annotated[
        int | None, typer.Option(help="On this machine only; by default the first free one from 7000 on.")
    ] = None,
    scale: Annotated[float, typer.Option(help="Factor that makes a part file's vertices metres.")] = 1.0,
    out: Annotated[Path | None, _OUT] = None,
) -> None:
    """Change a layout in the browser: slide, add and remove elements, make it valid; verdicts follow at once.

    What is not saved in the end goes to a recovery file, which is told.

    Exit code: 0 after `quit`, 130 after Ctrl-C, 143 when terminated, 129 when the terminal is closed, 2 bad input.
    """
    from fixture_design.viewing.session import Live, Steering, begun  # noqa: PLC0415 - after the arguments are known

    with interruptible(patient=True) as ended:
        try:
            steering = begun(Steering, layout_or_part, scale, out)
            live = Live(steering, port)
        except InputError as error:
            raise error.within(layout_or_part) from error
        try:
            typer.echo(f"{live.address} (quit there, or Ctrl-C here)")
            live.run(ended)
        finally:
            path = steering.leave()
            if path is not None:
                say(f"unsaved changes are in {printable(str(path))}")
    raise typer.Exit(ended.code if ended() else ExitCode.HOLDS)
