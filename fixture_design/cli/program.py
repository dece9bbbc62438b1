"""`fixture-design`: the options of the program itself, its subcommands, and what happens to exceptions."""

from __future__ import annotations

import os
import sys
from importlib.metadata import PackageNotFoundError, version
from typing import Annotated

import typer
from typer.exceptions import TyperException

from fixture_design.cli.commands import CommandGroup
from fixture_design.cli.exit_codes import ExitCode
from fixture_design.cli.messages import say, say_internal_error
from fixture_design.cones.kernel import NAME as KERNEL
from fixture_design.errors import InputError
from fixture_design.version import VERSION

app = typer.Typer(
    name="fixture-design",
    help="Does this fixture locate the part, let it in and out, and hold it? A verdict with proof.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    cls=CommandGroup,
)


def _show_version(wanted: bool) -> bool:
    if wanted:
        try:
            drake = version("drake")
        except PackageNotFoundError:
            drake = "not installed"
        typer.echo(f"fixture-design {VERSION}, Drake {drake}, kernel {KERNEL}")
        raise typer.Exit
    return wanted


@app.callback()
def _options(
    show_version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Versions and kernel in use.")
    ] = False,
) -> None:
    """Options of the program itself."""


def run() -> None:
    """Run the command line; every exception becomes one message and an exit code."""
    try:
        code = app(prog_name="fixture-design", standalone_mode=False)
        sys.stdout.flush()
    except (BrokenPipeError, SystemExit) as left:
        # `| head`: nobody reads on. Typer makes that an exit with 1, which here means that requirements fail
        if isinstance(left, SystemExit) and not isinstance(left.__context__, BrokenPipeError):
            raise
        # Python's own flush at the end must not complain
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = ExitCode.BROKEN_PIPE
    except InputError as error:
        say(str(error))
        code = ExitCode.BAD_INPUT
    except (KeyboardInterrupt, typer.Abort):
        code = ExitCode.INTERRUPTED
    except typer.Exit as leaving:
        code = leaving.exit_code
    except TyperException as error:
        if problem := error.format_message():  # empty without arguments: the help is printed then
            say(f"{problem.rstrip('.')}; see fixture-design --help")
        code = ExitCode.BAD_INPUT
    except Exception as error:  # noqa: BLE001 - the last resort: say that it is our fault, with all there is to know
        say_internal_error(error)
        code = ExitCode.INTERNAL_ERROR
    if code == ExitCode.INTERRUPTED:  # Typer turns Ctrl-C into this code without a word
        say("interrupted")
    sys.exit(int(code or 0))
