"""Where a session saves, and where it leaves what nobody saved. No file that is there already is replaced unasked."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from itertools import count
from pathlib import Path

from fixture_design.errors import FileFormatError
from fixture_design.io import layout_text, write_layout
from fixture_design.layout import Layout
from fixture_design.viewing.report import refuse_inputs

#: Endings of layout files, which are left out of the names that are made of them.
_ENDINGS = (".layout", ".edited", ".recovered")


def stem_of(path: Path) -> str:
    """A file's name without its endings: "bracket" of bracket.layout.yaml."""
    name = path.stem
    while Path(name).suffix in _ENDINGS:
        name = Path(name).stem
    return name


def free_name(folder: Path, stem: str, ending: str) -> Path:
    """stem.ending, or stem.ending with the first number that no file has: "bracket.edited-2.yaml"."""
    names = (folder / f"{stem}.{ending}{'' if number == 1 else f'-{number}'}.yaml" for number in count(1))
    return next(path for path in names if not path.exists())


def target_of(source: Path | None, out: Path | None, inputs: tuple[Path, ...]) -> Path:
    """Where `save` writes: the file asked for, which may be the layout itself; else a new one beside the input.

    Raises:
        FileFormatError: the file asked for is the part's or another input, is no layout by its name, or its folder is
            not there.
    """
    if out is None:
        folder = Path.cwd() if source is None else source.absolute().parent
        is_layout = source is not None and source.suffix.lower() in (".yaml", ".yml", ".json")
        return free_name(folder, "layout" if source is None else stem_of(source), "edited" if is_layout else "layout")
    refuse_inputs(out, inputs)
    if out.suffix.lower() not in (".yaml", ".yml", ".json"):
        raise FileFormatError("layouts are YAML or JSON", source=out, expected="a name with .yaml or .json")
    if not out.absolute().parent.is_dir():
        raise FileFormatError("the folder to write to is not there", source=out, expected="an existing folder")
    return out


def another(target: Path) -> Path:
    """A new file beside the one saved to, for a copy."""
    return free_name(target.absolute().parent, stem_of(target), "edited")


def recover(layout: Layout, target: Path) -> Path | None:
    """Writes what nobody saved beside the file it would have gone to, or where that is not possible here, or in the
    folder for temporary files; and if there is no place at all, to stderr.

    Returns:
        The file; None without a place.
    """
    problems = []
    for folder in _folders(target):
        path = free_name(folder, stem_of(target), "recovered")
        try:
            write_layout(layout, path)
        except FileFormatError as refused:
            problems.append(str(refused))
            continue
        return path
    print(f"fixture-design: no place for unsaved changes ({'; '.join(problems)}); they are:", file=sys.stderr)
    print(layout_text(layout, Path.cwd()), file=sys.stderr)
    return None


def _folders(target: Path) -> Iterator[Path]:
    yield from (target.absolute().parent, Path.cwd(), Path(tempfile.gettempdir()))
