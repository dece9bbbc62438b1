"""`fixture-design batch PATH... -o OUT.jsonl`: thousands of layouts, records in order, resumed where it stopped."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fixture_design.cli.exit_codes import ExitCode, worst
from fixture_design.cli.long_work import Ending, interruptible
from fixture_design.cli.messages import say
from fixture_design.errors import InputError
from fixture_design.io import dumps
from fixture_design.io.outputs import check_outputs

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
        typer.Argument(help="Layout files, .jsonl of layouts, folders, globs.", metavar="PATH", readable=False),
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
        float | None,
        typer.Option(
            "--limit", min=0.001, help="Seconds that one layout may take; not with --cluster.", metavar="SECONDS"
        ),
    ] = None,
    retry: Annotated[
        bool,
        typer.Option("--retry", help="Look again at errors: dead workers, time limits, bad files."),
    ] = False,
    cluster: Annotated[
        str | None,
        typer.Option("--cluster", help="Dask scheduler that runs it instead of this machine.", metavar="ADDRESS"),
    ] = None,
    report: Annotated[
        Path | None, typer.Option("--report", help="Also write an HTML page about all records.", metavar="OUT.html")
    ] = None,
    table: Annotated[
        Path | None, typer.Option("--table", help="Also write all records as a table.", metavar="OUT.csv|OUT.parquet")
    ] = None,
    against: Annotated[
        Path | None, typer.Option("--against", help="Compare with an earlier output.", metavar="OLD.jsonl")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="The summary as one JSON document on stdout.")] = False,
) -> None:
    """Verify thousands of layouts, in worker processes; a run that was stopped goes on where it was.

    Exit code, the first that is true of some layout: 4 internal error, 2 bad input, 1 a requirement fails, 3
    undecided; else 0; 130, 143 or 129 after Ctrl-C, a termination or a closed terminal.
    """
    with interruptible() as ended:
        _run(
            paths, output, brief, sets, jobs, limit, retry, cluster, report, table, against, as_json, ended
        )  # fmt: skip


def _run(
    paths: list[Path],
    output: Path,
    brief: bool,
    sets: bool,
    jobs: int | None,
    limit: float | None,
    retry: bool,
    cluster: str | None,
    report: Path | None,
    table: Path | None,
    against: Path | None,
    as_json: bool,
    ended: Ending,
) -> None:
    from fixture_design.batch import detail_wanted, input_files, local_workers, run_batch, total_share  # noqa: PLC0415
    from fixture_design.batch.against import compare  # noqa: PLC0415 - after the arguments are known good
    from fixture_design.batch.cluster import Cluster  # noqa: PLC0415
    from fixture_design.batch.progress import Progress  # noqa: PLC0415
    from fixture_design.batch.report import write_batch_report  # noqa: PLC0415
    from fixture_design.batch.table import write_table  # noqa: PLC0415
    from fixture_design.cli.batch_summary import print_summary  # noqa: PLC0415

    detail = detail_wanted(brief, sets)
    if cluster is not None and (jobs is not None or limit is not None):
        raise InputError(
            "--jobs and --limit are for this machine: a cluster has its own workers, and Dask ends none for its time",
            expected="neither of them with --cluster",
        )
    # on a cluster all see the same files, but none has this folder
    files = input_files([path.absolute() for path in paths] if cluster else paths, besides=output)
    _check_others(output, files, report, table, against)
    progress = Progress(total_share(files))
    workers = local_workers(detail, jobs, limit) if cluster is None else Cluster(cluster, detail)
    summary = run_batch(
        files, output, workers,
        detail=detail, watch=progress.add, ready=progress.resumed, retry=retry, stop=ended,
    )  # fmt: skip
    progress.close()
    comparison = compare(output, against) if against is not None and not summary.interrupted else None
    try:  # what is known is said first; who does not listen has the files all the same
        if as_json:
            said = summary.as_dict() | ({} if comparison is None else {"against": comparison.as_dict()})
            typer.echo(dumps(said))
        else:
            print_summary(summary, comparison)
    finally:
        if table is not None:
            write_table(output, table)
        if report is not None:
            # whoever interrupts it does not want to wait for drawings
            write_batch_report(output, report, summary, comparison, files=[] if summary.interrupted else files)
    if summary.interrupted:
        records = "1 record is" if summary.count == 1 else f"{summary.count} records are"
        say(f"{records} in {output}; the same command goes on from there")
        raise typer.Exit(ended.code)
    raise typer.Exit(worst(_CODES[outcome] for outcome in summary.outcomes))


def _check_others(
    output: Path, inputs: list[Path], report: Path | None, table: Path | None, against: Path | None
) -> None:
    """What would fail at the end fails before the beginning, and nothing that the user made is lost.

    Raises:
        InputError: a file is to be written that is something else too; the earlier output cannot be read.
    """
    from fixture_design.batch.results import records_in  # noqa: PLC0415
    from fixture_design.batch.table import check_table  # noqa: PLC0415

    check_outputs((output, report, table), (*inputs, against))
    if table is not None:
        check_table(table)
    if against is not None:
        next(records_in(against), None)
