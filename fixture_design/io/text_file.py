"""Writing a text file at once, so that a crash, a full disk or a reader in between never meets half a file."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from fixture_design.errors import FileFormatError


def write_text(path: Path, text: str) -> None:
    """Replaces the file by ``text`` (UTF-8); what was there stays if that fails. A link's target is replaced.

    Raises:
        FileFormatError: as `write_pieces`.
    """
    write_pieces(path, [text])


def write_pieces(path: Path, pieces: Iterable[str]) -> None:
    """Likewise by pieces of text one after the other, which are not held together.

    Raises:
        FileFormatError: the folder is not there, not permitted, the disk is full, or ``path`` is a folder.
    """
    target = Path(os.path.realpath(path))
    try:
        if target.is_dir():
            raise IsADirectoryError(f"{path} is a folder")
        _replace(target, pieces)
    except OSError as cause:
        raise FileFormatError(f"the file cannot be written: {cause.strerror or cause}", source=path) from cause


def _replace(target: Path, pieces: Iterable[str]) -> None:
    handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".new")
    try:
        with open(handle, "w", encoding="utf-8", newline="\n") as file:
            file.writelines(pieces)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(temporary, _mode(target))
        os.replace(temporary, target)
    except BaseException:
        with suppress(FileNotFoundError):
            os.unlink(temporary)
        raise


def _mode(target: Path) -> int:
    """Permissions of the file that is replaced, or those a new file gets: mkstemp's own are for secrets."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
