"""Where results go: looked at before any work, so that nothing that the user made is lost and no work is in vain."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from fixture_design.errors import FileFormatError


def check_outputs(outputs: Iterable[Path | None], inputs: Iterable[Path | None]) -> None:
    """Every output can be written and is a file of its own; None stands for one that nobody asked for.

    Raises:
        FileFormatError: an output is one of the inputs or another output, a folder, or in none.
    """
    read = [path for path in inputs if path is not None]
    taken: list[str] = []
    for path in filter(None, outputs):
        refuse_inputs(path, read)
        place = os.path.realpath(path)
        if place in taken:  # also where it is not there yet
            raise FileFormatError("two outputs would go to one file", source=path, expected="another name for each")
        if path.is_dir():
            raise FileFormatError("this is a folder", source=path, expected="a file's name")
        if not path.absolute().parent.is_dir():
            raise FileFormatError("the folder to write to is not there", source=path, expected="an existing folder")
        taken.append(place)


def refuse_inputs(path: Path, inputs: Iterable[Path]) -> None:
    """Nothing that the user made may be lost.

    Raises:
        FileFormatError: ``path`` is one of the inputs.
    """
    if path.exists() and any(path.samefile(file) for file in inputs if file.exists()):
        raise FileFormatError("this file is an input and would be lost", source=path, expected="another name")
