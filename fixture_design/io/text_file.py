"""Writing a file at once, so that a crash, a full disk or a reader in between never meets half a file."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from fixture_design.errors import FileFormatError


def write_text(path: Path, text: str) -> None:
    """Replaces the file by ``text`` (UTF-8, line ends as they are), see `write_pieces`.

    Raises:
        FileFormatError: as there.
    """
    write_pieces(path, [text])


def write_new_text(path: Path, text: str) -> None:
    """Makes the file with ``text`` in it, and replaces none; a file that cannot be filled is taken away again.

    Raises:
        FileExistsError: there is one by now, be it a link to nowhere.
        FileFormatError: the file cannot be written.
    """
    with _translated(path):
        handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
        try:
            _fill(handle, [text.encode("utf-8")])
        except BaseException:
            os.unlink(path)
            raise


def write_bytes(path: Path, content: bytes) -> None:
    """Replaces the file by ``content``, see `write_pieces`.

    Raises:
        FileFormatError: as there.
    """
    _write(path, [content])


def write_pieces(path: Path, pieces: Iterable[str]) -> None:
    """Replaces the file by pieces of text one after the other, which are not held together; what was there stays if
    that fails. A link's target is replaced.

    Raises:
        FileFormatError: the folder is not there, not permitted, the disk is full, or ``path`` is a folder.
    """
    _write(path, (piece.encode("utf-8") for piece in pieces))


def _write(path: Path, pieces: Iterable[bytes]) -> None:
    target = Path(os.path.realpath(path))
    with _translated(path):
        if target.is_dir():
            raise IsADirectoryError(f"{path} is a folder")
        _replace(target, pieces)


@contextmanager
def _translated(path: Path) -> Iterator[None]:
    try:
        yield
    except FileExistsError:
        raise
    except OSError as cause:
        raise FileFormatError(f"the file cannot be written: {cause.strerror or cause}", source=path) from cause


def _replace(target: Path, pieces: Iterable[bytes]) -> None:
    handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".new")
    try:
        _fill(handle, pieces)
        os.chmod(temporary, _mode(target))
        os.replace(temporary, target)
    except BaseException:
        with suppress(FileNotFoundError):
            os.unlink(temporary)
        raise


def _fill(handle: int, pieces: Iterable[bytes]) -> None:
    """Writes and closes a file, whose contents are on the disk then."""
    with open(handle, "wb") as file:
        file.writelines(pieces)
        file.flush()
        os.fsync(file.fileno())


def _mode(target: Path) -> int:
    """Permissions of the file that is replaced, or those a new file gets: mkstemp's own are for secrets."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
