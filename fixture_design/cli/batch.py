"""`fixture-design batch PATH... -o OUT.jsonl`: thousands of layouts, records in order, resumed where it stopped."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from fixture_design.cli.exit_codes import ExitCode, worst
from fixture_design.cli.messages import say
from fixture_design.io import dumps

_CODES = {
    "internal error": ExitCode.INTERNAL_ERROR,
    "bad input": ExitCode.BAD_INPUT,
    "no": ExitCode.FAILS,
    "undecided": ExitCode.UNDECIDED,
    "nothing required": ExitCode.HOLDS,
    "yes": ExitCode.HOLDS,
}


def batch(
    paths: Annotated[
        list[Path],
        typer.Argument(help="Layout files, .jsonl of layouts, folders, globs.", metavar="PATH...", readable=False),
    ],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Records, one a line; gone on with if there.", metavar="OUT.jsonl")
    ],
    brief: Annotated[bool, typer.Option("--brief", help="Without witnesses, margins and contacts.")] = False,
    sets: Annotated[bool, typer.Option("--sets", help="With the admissible sets, as verify has them; slow.")] = False,
    jobs: Annotated[
        int | None, typer.Option("--jobs", min=1, help="Worker processes.", show_default="all cores")
    ] = None,
    limit: Annotated[
        float | None, typer.Option("--limit", min=0.001, help="Seconds that one layout may take.", metavar="SECONDS")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="The summary as one JSON document on stdout.")] = False,
) -> None:
    """Verify thousands of layouts, in worker processes; a run that was stopped goes on where it was.

    Exit code, the first that is true of some layout: 4 internal error, 2 bad input, 1 a requirement fails, 3
    undecided; else 0; 130 if it was interrupted.
    """
    from fixture_design.batch import detail_wanted, input_files, local_workers, run_batch, total_share  # noqa: PLC0415 - as `verify`
    from fixture_design.batch.progress import Progress  # noqa: PLC0415

    detail = detail_wanted(brief, sets)
    files = input_files(paths, besides=output)
    progress = Progress(total_share(files))
    with _interrupts() as interrupted:
        summary = run_batch(
            files, output, local_workers(detail, jobs, limit),
            detail=detail, watch=progress.add, ready=progress.resumed, stop=interrupted,
        )  # fmt: skip
    progress.close()
    if as_json:
        typer.echo(dumps(summary.as_dict()))
    else:
        from fixture_design.cli.batch_summary import print_summary  # noqa: PLC0415 - rich is not needed for JSON

        print_summary(summary)
    if summary.interrupted:
        say(f"{summary.count} records are in {output}; the same command goes on from there")
        raise typer.Exit(ExitCode.INTERRUPTED)
    raise typer.Exit(worst(_CODES[outcome] for outcome in summary.outcomes))


@contextmanager
def _interrupts() -> Iterator[Callable[[], bool]]:
    """In here Ctrl-C (and SIGTERM) only set what the function asks for; a second one ends the process."""
    told: list[int] = []

    def hear(number: int, frame: object) -> None:
        if told:
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
        told.append(number)

    try:
        before = {number: signal.signal(number, hear) for number in (signal.SIGINT, signal.SIGTERM)}
    except ValueError:  # not the main thread: signals are somebody else's
        before = {}
    try:
        yield lambda: bool(told)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        sys.stderr.flush()
