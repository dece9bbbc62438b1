"""What goes to stderr: one line where the input is at fault, all there is to know where we are."""

from __future__ import annotations

import sys
import traceback
from pathlib import Path

from fixture_design.errors import InputError


def say(message: str) -> None:
    """One line on stderr, with the program's name; characters that could steer a terminal are escaped."""
    print(f"fixture-design: {printable(message)}", file=sys.stderr)


def printable(text: str) -> str:
    """The text with control characters, line ends and lone surrogates as escapes."""
    return "".join(
        character if character.isprintable() else character.encode("unicode_escape").decode() for character in text
    )


def met_in(path: Path, error: InputError) -> str:
    """The error's message; it names the layout too where another file, such as its mesh, is at fault."""
    error.within(path)
    return str(error) if str(error.source) == str(path) else f"{path}: {error}"


def say_internal_error(error: Exception, path: Path | None = None) -> None:
    """The traceback, and that it is a fault of ours; call it where the exception is caught."""
    traceback.print_exc()
    where = f"{path}: " if path else ""
    say(f"{where}internal error ({type(error).__name__}); this is a fault of ours")
