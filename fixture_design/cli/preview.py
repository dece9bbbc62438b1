"""`fixture-design preview LAYOUT or GRAPH`: a page to turn and play, and a picture."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fixture_design.cli.messages import printable
from fixture_design.errors import InputError


def preview(
    file: Annotated[Path, typer.Argument(help="Layout or contact-state graph file.", metavar="LAYOUT", readable=False)],
    out: Annotated[
        Path | None,
        typer.Option("-o", "--out", help="Page, one file that needs no network; by default LAYOUT.html here."),
    ] = None,
    png: Annotated[
        Path | None, typer.Option("--png", help="Picture, drawn without a browser.", metavar="OUT.png")
    ] = None,
    show: Annotated[
        str | None,
        typer.Option("--show", help="The answer to begin with, as locators:form_closure.", metavar="GROUP:QUESTION"),
    ] = None,
) -> None:
    """Write a preview: the part, what touches it, what acts on it, how it is held or gets away, and the verdict.

    Exit code: 0, 2 bad input. What the verdict is, `verify` says.
    """
    from fixture_design.viewing import preview as preview_of  # noqa: PLC0415 - after the arguments are known good

    if out is None and png is None:
        out = Path(f"{file.name.split('.')[0]}.html")
    if png is not None and png.suffix.lower() != ".png":
        raise InputError("pictures are PNG", source=png, expected="a name with .png")
    try:
        shown = preview_of(file, show=show)
    except InputError as error:
        raise error.within(file) from error
    for path in filter(None, (out, png)):
        shown.save(path)
        typer.echo(printable(str(path)))
