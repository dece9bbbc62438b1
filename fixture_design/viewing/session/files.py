"""Where a session saves, and where it leaves what nobody saved. No file is replaced that the session does not know: new
names are made anew, and what somebody else has written to its file since then stays.
"""

from __future__ import annotations

import hashlib
import sys
import tempfile
from collections.abc import Iterator
from itertools import count
from pathlib import Path

from fixture_design.errors import FileFormatError
from fixture_design.io import layout_text, write_layout, write_new_layout
from fixture_design.io.outputs import check_outputs
from fixture_design.layout import Layout

#: Endings of layout files, which are left out of the names that are made of them.
_ENDINGS = (".layout", ".edited", ".recovered")


def stem_of(path: Path) -> str:
    """A file's name without its endings: "bracket" of bracket.layout.yaml."""
    name = path.stem
    while Path(name).suffix in _ENDINGS:
        name = Path(name).stem
    return name


def free_names(folder: Path, stem: str, ending: str) -> Iterator[Path]:
    """stem.ending, stem.ending-2 and so on, those that no file has: "bracket.edited-2.yaml"."""
    names = (folder / f"{stem}.{ending}{'' if number == 1 else f'-{number}'}.yaml" for number in count(1))
    return (path for path in names if not path.exists())


def written_anew(layout: Layout, names: Iterator[Path]) -> Path:
    """Writes a layout to the first of some names that is still free then: others may take names meanwhile.

    Raises:
        FileFormatError: it cannot be written there.
    """
    for path in names:
        try:
            write_new_layout(layout, path)
        except FileExistsError:
            continue
        return path
    raise AssertionError("names never end")


def content_of(path: Path) -> str | None:
    """What a file holds, as SHA-256; None where there is none."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except FileNotFoundError:
        return None
    except OSError as cause:
        raise FileFormatError(f"the file cannot be read: {cause.strerror or cause}", source=path) from cause


def write_known(layout: Layout, path: Path, known: str | None) -> str | None:
    """Writes over a file as long as it holds what it held when it was seen last, or is still not there.

    Args:
        known: its content then.

    Returns:
        its content now.

    Raises:
        FileFormatError: somebody else has written it since then, or it cannot be written.
    """
    changed = FileFormatError("the file has changed on disk", source=path, expected="`save a copy`")
    if content_of(path) != known:
        raise changed
    try:
        write_new_layout(layout, path) if known is None else write_layout(layout, path)
    except FileExistsError as cause:
        raise changed from cause
    return content_of(path)


def target_of(source: Path | None, out: Path | None, inputs: tuple[Path, ...]) -> Path:
    """Where `save` writes: the file asked for, which may be the layout itself; else a new one beside the input.

    Raises:
        FileFormatError: the file asked for is the part's or another input, is no layout by its name, or its folder is
            not there.
    """
    if out is None:
        folder = Path.cwd() if source is None else source.absolute().parent
        is_layout = source is not None and source.suffix.lower() in (".yaml", ".yml", ".json")
        stem, ending = "layout" if source is None else stem_of(source), "edited" if is_layout else "layout"
        return next(free_names(folder, stem, ending))
    check_outputs([out], inputs)
    if out.suffix.lower() not in (".yaml", ".yml", ".json"):
        raise FileFormatError("layouts are YAML or JSON", source=out, expected="a name with .yaml or .json")
    return out


def copies(target: Path) -> Iterator[Path]:
    """New files beside the one saved to, for a copy."""
    return free_names(target.absolute().parent, stem_of(target), "edited")


def recover(layout: Layout, target: Path) -> Path | None:
    """Writes what nobody saved beside the file it would have gone to, or where that is not possible here, or in the
    folder for temporary files; and if there is no place at all, to stderr.

    Returns:
        The file; None without a place.
    """
    problems = []
    for folder in _folders(target):
        try:
            return written_anew(layout, free_names(folder, stem_of(target), "recovered"))
        except FileFormatError as refused:
            problems.append(str(refused))
    print(f"fixture-design: no place for unsaved changes ({'; '.join(problems)}); they are:", file=sys.stderr)
    print(layout_text(layout, Path.cwd()), file=sys.stderr)
    return None


def _folders(target: Path) -> Iterator[Path]:
    yield from (target.absolute().parent, Path.cwd(), Path(tempfile.gettempdir()))
