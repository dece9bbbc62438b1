"""The command line runs in this process here too."""

from tests.cli.conftest import command

__all__ = ["command"]
