"""`fixture-design design TASK or PART`: a fixture for a part."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fixture_design.cli.design_report import design_in_words
from fixture_design.cli.exit_codes import of_answer
from fixture_design.cli.long_work import interruptible
from fixture_design.cli.messages import say
from fixture_design.cli.progress import shown
from fixture_design.design import DesignResult, Task
from fixture_design.errors import FileFormatError, InputError, UnsupportedError
from fixture_design.io import (
    TASK_ENDINGS,
    design_to_dict,
    dumps,
    layout_text,
    read_task_or_layout,
    task_of_part,
    write_layout,
)
from fixture_design.io import write_csv as save_csv
from fixture_design.io import write_urdf as save_urdf
from fixture_design.io.outputs import check_outputs
from fixture_design.layout import Layout

_GIVEN = "Task file, a part (STL, OBJ, ..., URDF), or a layout to repair."
_OUT = typer.Option("--out", "-o", help="Layout file to write (YAML, or JSON by its ending); default: stdout.")


def design(
    task_or_part: Annotated[Path, typer.Argument(help=_GIVEN, readable=False)],
    out: Annotated[Path | None, _OUT] = None,
    scale: Annotated[float, typer.Option(help="Factor that makes a part file's vertices metres.")] = 1.0,
    seed: Annotated[int, typer.Option(help="Of the random numbers; the same one gives the same layout.", min=0)] = 0,
    urdf: Annotated[Path | None, typer.Option(help="Elements with stem and body, as URDF.")] = None,
    csv: Annotated[Path | None, typer.Option(help="Contacts as a table.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout.")] = False,
) -> None:
    """Find a layout that locates a part, lets it out and closes it, with the fewest elements; and say why they are few.

    Of a layout: the fewest elements moved, added or removed, and preloads changed, that make its requirements hold.

    Exit code: 0 a layout that holds, 1 there is none, 3 none was found or it is undecided, 2 bad input; 130, 143 or
    129 after Ctrl-C, a termination or a closed terminal.
    """
    task = _task(task_or_part, scale)
    check_outputs((out, urdf, csv), _inputs(task))
    if urdf is not None and task.space == "planar":
        raise UnsupportedError("a planar layout has no URDF form", source=task.source, expected="`--csv`")
    from fixture_design.design import design as design_layout  # noqa: PLC0415 - after the arguments are known good
    from fixture_design.design import repair  # noqa: PLC0415 - likewise

    with interruptible() as cancelled:
        try:
            if isinstance(task, Layout):
                result = repair(task, seed=seed, progress=shown, cancelled=cancelled)
            else:
                result = design_layout(task, seed=seed, progress=shown, cancelled=cancelled)
        except InputError as error:
            raise error.within(task_or_part) from error
        finally:
            shown("", 1.0)
        _write(result, task, out, urdf, csv)
        _report(result, out, as_json)
        raise typer.Exit(cancelled.code if cancelled() else of_answer(result.satisfied))


def _task(path: Path, scale: float) -> Task | Layout:
    if path.suffix.lower() not in TASK_ENDINGS:
        return task_of_part(path, scale)
    if scale != 1:
        raise FileFormatError("`--scale` is for part files", source=path, expected="`scale` in the task's `part`")
    return read_task_or_layout(path)


def _inputs(task: Task | Layout) -> tuple[Path | None, ...]:
    """All files that a task or a layout is made of, so far as they are there."""
    from fixture_design.geometry.input_files import with_meshes  # noqa: PLC0415 - Drake and trimesh

    start = task.start if isinstance(task, Task) else task
    models = [None if task.part is None else task.part.file, *(body.file for body in (start.bodies if start else ()))]
    meshes = [file for model in models if model is not None and model.is_file() for file in with_meshes(model)]
    loads = [load.path for one in (task, start) if one is not None for load in one.loads]
    return (task.source, None if start is None else start.source, *meshes, *loads)


def _write(result: DesignResult, task: Task | Layout, out: Path | None, urdf: Path | None, csv: Path | None) -> None:
    if result.layout is None or result.verdict is None:
        return
    if out is not None:
        write_layout(result.layout, out)
    if urdf is not None:
        sizes = task.candidates.stem if isinstance(task, Task) else None
        save_urdf(result.layout, result.verdict, urdf, sizes)
    if csv is not None:
        save_csv(result.verdict, csv)


def _report(result: DesignResult, out: Path | None, as_json: bool) -> None:
    """JSON alone; or words, which make way for the layout where that goes to stdout."""
    folder = Path.cwd() if out is None else out.absolute().parent
    if as_json:
        typer.echo(dumps(design_to_dict(result, folder)))
        return
    aside = out is None and result.layout is not None
    for line in design_in_words(result):
        if aside:
            say(line)
        else:
            typer.echo(line)
    if aside and result.layout is not None:
        typer.echo(layout_text(result.layout, folder), nl=False)
