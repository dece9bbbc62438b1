"""The output of a batch: one record a line, appended to, so that what was done stays done.

A run that was killed leaves at most a last line that is cut short: that one is removed. Every line that is there must
be the record of the layout that now is in its place, of the same text and files, version and tolerances; if one is not,
the file holds the results of something else, and is left alone.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, BinaryIO

from fixture_design.batch.digest import input_hash, text_hash
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.outcome import outcome_of, smallest_margin
from fixture_design.batch.records import Detail, detail_of, record_of, was_given_up
from fixture_design.errors import FileFormatError
from fixture_design.io.verdict_record import VERDICT_SCHEMA
from fixture_design.tolerances import DEFAULT
from fixture_design.version import VERSION

#: What every line of ours begins with.
_BEGINNING = b'{"schema": "' + VERDICT_SCHEMA.encode() + b'"'
#: What records are called by how much they say.
_WORDS: dict[Detail, str] = {"brief": "brief", "full": "full", "sets": "full with sets"}
#: Said wherever a file cannot be gone on with.
_ELSEWHERE = "another output, or that file moved away"


class Output:
    """An output file that is open for appending; `close` makes sure that it is on disk."""

    def __init__(self, path: Path, inputs: Sequence[Path]) -> None:
        """Opens the file, or creates it.

        Raises:
            FileFormatError: it is one of the inputs, is a folder or something else that is no file, cannot be written,
                is being written by another batch, or holds no records.
        """
        self.path = path
        if path.exists() and any(path.samefile(file) for file in inputs if file.exists()):
            raise FileFormatError("the output is one of the inputs", source=path, expected="another name")
        if path.exists() and not path.is_file():
            raise FileFormatError("the output is no regular file", source=path, expected="a file, such as out.jsonl")
        try:
            self._file: BinaryIO = path.open("a+b")
        except OSError as cause:
            raise FileFormatError(f"the output cannot be written: {cause.strerror or cause}", source=path) from cause
        try:
            _lock(self._file, path)
            self._cut()
        except BaseException:
            self._file.close()
            raise

    def done(self, items: Iterator[Item], detail: Detail, mended: bool = False) -> Iterator[tuple[Item, Entry]]:
        """The items whose records are there, with these; ``items`` goes on behind them.

        Args:
            mended: whether a layout whose record is an error may be another one by now.

        Raises:
            FileFormatError: a record is that of something else.
        """
        self._file.seek(0)
        for number, line in enumerate(self._file, start=1):
            place = f"line {number}"
            try:
                record = record_of(line)
            except ValueError as cause:
                raise FileFormatError("the output has a line that is no record", source=self.path, place=place,
                                      expected=_ELSEWHERE) from cause  # fmt: skip
            item = next(items, None)
            problem = (
                "there are more records than layouts" if item is None else _difference(record, item, detail, mended)
            )
            if item is None or problem is not None:
                raise FileFormatError(f"the output holds results of something else: {problem}", source=self.path,
                                      place=place, expected=_ELSEWHERE)  # fmt: skip
            yield item, Entry(line, outcome_of(record), smallest_margin(record))

    def append(self, lines: Sequence[bytes]) -> None:
        """Adds lines; they survive the death of this process.

        Raises:
            FileFormatError: the disk is full, or gone.
        """
        try:
            self._file.write(b"".join(lines))
            self._file.flush()
        except OSError as cause:
            problem = f"the output cannot be written: {cause.strerror or cause}"
            raise FileFormatError(problem, source=self.path) from cause

    def replace(self, lines: Mapping[int, bytes]) -> None:
        """Puts lines in the places of others, counted from 0: in a new file, which takes this one's place at once.

        Raises:
            FileFormatError: the disk is full, or the folder is not permitted.
        """
        target = Path(os.path.realpath(self.path))
        new = target.with_name(f".{target.name}.{os.getpid()}.new")
        try:
            with ExitStack() as undo:
                new.unlink(missing_ok=True)
                file = new.open("a+b")
                undo.callback(new.unlink, missing_ok=True)
                undo.callback(file.close)
                _lock(file, self.path)
                self._file.seek(0)
                file.writelines(lines.get(place, line) for place, line in enumerate(self._file))
                file.flush()
                os.fsync(file.fileno())
                os.chmod(new, target.stat().st_mode & 0o777)
                os.replace(new, target)
                undo.pop_all()
        except OSError as cause:
            problem = f"the output cannot be replaced: {cause.strerror or cause}"
            raise FileFormatError(problem, source=self.path) from cause
        self._file.close()
        self._file = file

    def close(self) -> None:
        """Everything is on disk then, where the file is on one."""
        if not self._file.closed:
            self._file.flush()
            os.fsync(self._file.fileno())
            self._file.close()

    def _cut(self) -> None:
        """Removes the last line if it is cut short, and looks whether the file can be one of ours."""
        self._file.seek(0)
        beginning = self._file.read(len(_BEGINNING))
        if not _BEGINNING.startswith(beginning):
            raise FileFormatError("the output exists and holds something else", source=self.path, expected=_ELSEWHERE)
        end = _end_of_last_line(self._file)
        if end < self._file.seek(0, os.SEEK_END):
            self._file.truncate(end)


def _lock(file: BinaryIO, path: Path) -> None:
    """Two batches that append to one file would spoil it; the lock goes with the process."""
    try:
        import fcntl  # noqa: PLC0415 - not on Windows, whose files are not locked
    except ImportError:
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as cause:
        raise FileFormatError("another batch is writing this output", source=path) from cause
    except OSError as cause:  # as on some network drives
        problem = f"the output cannot be locked against other batches: {cause.strerror or cause}"
        raise FileFormatError(problem, source=path, expected="an output on another drive") from cause


def _end_of_last_line(file: BinaryIO, step: int = 1 << 20) -> int:
    """Where the last complete line ends."""
    position = file.seek(0, os.SEEK_END)
    while position > 0:
        start = max(0, position - step)
        file.seek(start)
        found = file.read(position - start).rfind(b"\n")
        if found >= 0:
            return start + found + 1
        position = start
    return 0


def _difference(record: dict[str, Any], item: Item, detail: Detail, mended: bool) -> str | None:
    """Why a record is not that of an item as it is now; None if it is."""
    if record.get("source") != item.source:
        return f"of {record.get('source')!r}, where {item.source!r} would be"
    if mended and "error" in record:
        return None
    run, failed = record.get("run"), "error" in record
    if not isinstance(run, dict):
        return "it has no `run`"
    if run.get("version") != VERSION:
        return f"of version {run.get('version')}; this is {VERSION}"
    if not failed and run.get("tolerances") != DEFAULT.as_dict():
        return "it was computed with other tolerances"
    if not failed and detail_of(record) != detail:
        return f"records are {_WORDS[detail_of(record)]}, and those wanted are {_WORDS[detail]}"
    if run.get("input") != (text_hash(item) if was_given_up(record) else input_hash(item)):
        changed = f"{item.source!r}, or a file it names, has changed since"
        return f"{changed} it was an error, and --retry looks at errors again" if failed else changed
    return None
