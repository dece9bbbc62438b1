"""Which files a batch is about: layout files, .jsonl of layouts, folders of both, globs."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from glob import glob, has_magic
from pathlib import Path

from fixture_design.errors import FileFormatError

#: Endings of files that hold one layout.
LAYOUT_ENDINGS = (".yaml", ".yml", ".json")
#: Endings of files that hold a layout a line.
LINES_ENDINGS = (".jsonl", ".ndjson")
#: Kinds of our files that are no layouts: a folder may hold them beside its layouts.
_OTHERS = tuple(f"fixture_design/{kind}/" for kind in ("task", "assembly", "graph", "classifier", "verdict"))
#: How much of a file is looked at for its schema [bytes].
_HEAD = 4096


def input_files(paths: Sequence[str | Path], besides: Path | None = None) -> list[Path]:
    """The files that some paths stand for, in the order given, those of a folder or glob sorted by name; each once.

    A folder stands for all .yaml, .yml, .json and .jsonl files in and below it, but for hidden ones and for files of
    ours that say they are something else than a layout. A file that is named is taken whatever it holds.

    Args:
        besides: a file that is left out of folders and globs: the batch's own output.

    Raises:
        FileFormatError: a path that is not there, a glob without matches, a folder without layouts that is named, a
            folder that cannot be read, no paths.
    """
    files: dict[str, Path] = {}
    for path in map(Path, paths):
        for file in _files_of(path, besides):
            files.setdefault(os.path.abspath(file), file)
    if not files:
        raise FileFormatError("there is nothing to look at", expected="layout files, folders, globs or .jsonl files")
    return list(files.values())


def is_lines(file: Path) -> bool:
    """Whether the file holds a layout a line."""
    return file.suffix.lower() in LINES_ENDINGS


def _files_of(path: Path, besides: Path | None) -> list[Path]:
    if path.is_dir():
        found = _layouts_in(path, besides)
        if not found:
            endings = ", ".join((*LAYOUT_ENDINGS, *LINES_ENDINGS[:1]))
            raise FileFormatError("there are no layouts in this folder", source=path, expected=f"files in {endings}")
        return found
    if os.path.lexists(path):
        return [path]
    if not has_magic(str(path)):
        raise FileFormatError("there is no such file or folder", source=path)
    matches = [Path(match) for match in sorted(glob(str(path), recursive=True))]
    if not matches:
        raise FileFormatError("no file matches this pattern", source=path)
    files = [file for match in matches if not _same(match, besides) for file in _matched(match, besides)]
    if not files and any(match.is_dir() for match in matches):
        raise FileFormatError("there are no layouts in what matches this pattern", source=path)
    return files


def _matched(match: Path, besides: Path | None) -> list[Path]:
    """A folder that a pattern happens to match need have no layouts."""
    return _layouts_in(match, besides) if match.is_dir() else [match]


def _layouts_in(folder: Path, besides: Path | None) -> list[Path]:
    return [file for file in sorted(_below(folder)) if not _same(file, besides) and not _is_another_kind(file)]


def _below(folder: Path) -> Iterator[Path]:
    """Also of folders that are links; each once, since links may lead in circles.

    Raises:
        FileFormatError: a folder that may not be read: its layouts would be missing, and nobody would know.
    """

    def unreadable(cause: OSError) -> None:
        problem = f"the folder cannot be read: {cause.strerror or cause}"
        raise FileFormatError(problem, source=cause.filename) from cause

    met: set[tuple[int, int]] = set()
    for parent, folders, names in os.walk(folder, onerror=unreadable, followlinks=True):
        status = Path(parent).stat()
        if (status.st_dev, status.st_ino) in met:
            folders.clear()
            continue
        met.add((status.st_dev, status.st_ino))
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in names:
            if not name.startswith(".") and Path(name).suffix.lower() in (*LAYOUT_ENDINGS, *LINES_ENDINGS):
                yield Path(parent, name)


def _same(file: Path, other: Path | None) -> bool:
    return other is not None and other.exists() and file.exists() and file.samefile(other)


def _is_another_kind(file: Path) -> bool:
    """Whether it says that it is a verdict, a task, ...; what cannot be read is a layout that cannot be read."""
    if not file.is_file() or not os.access(file, os.R_OK):
        return False
    with file.open("rb") as opened:
        head = opened.read(_HEAD)
    first = head.partition(b"schema")[2].lstrip(b"\"' :")[:40]
    return first.startswith(tuple(kind.encode() for kind in _OTHERS))
