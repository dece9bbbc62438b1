"""The command line: one thin file a subcommand, exit codes that tell yes from no from undecided from bad input."""

from fixture_design.cli.main import main

__all__ = ["main"]
