"""`fixture-design verify LAYOUT...`: contacts, verdicts and their evidence."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from fixture_design.cli.exit_codes import ExitCode, of_answer, worst
from fixture_design.cli.messages import met_in, say, say_internal_error
from fixture_design.errors import InputError
from fixture_design.io import dumps, error_record, read_layout, verdict_to_dict
from fixture_design.layout import Layout, Verdict, named_files


def verify(
    layouts: Annotated[  # `readable`: whether one can be read is not Typer's to say, which would leave out the others
        list[Path], typer.Argument(help="Layout files (YAML or JSON).", metavar="LAYOUT", readable=False)
    ],
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout (several: an array).")] = False,
    report: Annotated[
        Path | None, typer.Option("--report", help="Also write a sheet to sign, as HTML.", metavar="OUT.html")
    ] = None,
    html: Annotated[
        Path | None,
        typer.Option("--html", help="Also write the scene to turn and play, of one layout.", metavar="OUT.html"),
    ] = None,
) -> None:
    """Say whether layouts locate the part, let it out and hold it, with evidence.

    Exit code: 0 requirements hold or none given, 1 some do not, 3 undecided, 2 bad input.
    """
    from fixture_design.verification import verify as verify_layout  # noqa: PLC0415 - after the arguments are known good

    if html is not None and len(layouts) != 1:
        raise InputError(
            "a preview shows one layout", found=f"{len(layouts)} layouts", expected="--html with one of them"
        )
    codes: list[ExitCode] = []
    records: list[dict[str, Any]] = []
    verified: list[tuple[Layout, Verdict]] = []
    inputs = list(layouts)
    for path in layouts:
        try:
            layout = read_layout(path)
            inputs += named_files(layout)
            verdict = verify_layout(layout)
        except InputError as error:
            say(met_in(path, error))
            codes.append(ExitCode.BAD_INPUT)
            records.append(error_record(path, error))
            continue
        except Exception as error:  # noqa: BLE001 - a fault of ours in one layout must not cost the others' verdicts
            say_internal_error(error, path)
            codes.append(ExitCode.INTERNAL_ERROR)
            records.append(error_record(path, error))
            continue
        codes.append(of_answer(verdict.satisfied))
        verified.append((layout, verdict))
        if as_json:
            records.append(verdict_to_dict(verdict))
        else:
            from fixture_design.cli.verdict_table import print_verdict  # noqa: PLC0415 - rich is not needed for JSON

            print_verdict(verdict)
    if as_json:
        typer.echo(dumps(records[0] if len(layouts) == 1 else records))
    if report is not None:
        codes.append(_write_report(report, inputs, verified))
    if html is not None:
        codes.append(_write_preview(html, verified))
    raise typer.Exit(worst(codes))


def _write_preview(html: Path, verified: list[tuple[Layout, Verdict]]) -> ExitCode:
    """The scene of the layout, if it could be verified."""
    from fixture_design.viewing import preview  # noqa: PLC0415 - reads geometry again

    try:
        for layout, verdict in verified:
            preview(layout, verdict).save(html)
    except InputError as error:
        say(met_in(html, error))
        return ExitCode.BAD_INPUT
    except Exception as error:  # noqa: BLE001 - the verdict has been said
        say_internal_error(error, html)
        return ExitCode.INTERNAL_ERROR
    return ExitCode.HOLDS


def _write_report(report: Path, inputs: list[Path], verified: list[tuple[Layout, Verdict]]) -> ExitCode:
    """Sheets of the layouts that could be verified; the others have had their message."""
    from fixture_design.io.outputs import refuse_inputs  # noqa: PLC0415 - as below
    from fixture_design.viewing import write_report  # noqa: PLC0415 - reads geometry again

    try:
        refuse_inputs(report, inputs)
        if verified:
            write_report(verified, report)
    except InputError as error:
        say(met_in(report, error))
        return ExitCode.BAD_INPUT
    except Exception as error:  # noqa: BLE001 - the verdicts have been said
        say_internal_error(error, report)
        return ExitCode.INTERNAL_ERROR
    return ExitCode.HOLDS
