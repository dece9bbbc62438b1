"""A batch from its paths to its records: `verify_batch` for programs, `run_batch` for a file that is gone on with."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from math import inf
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

from fixture_design.batch.crew import Crew
from fixture_design.batch.inputs import input_files
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.items import items_of
from fixture_design.batch.output import Output
from fixture_design.batch.records import Detail, record_of
from fixture_design.batch.retry import look_again
from fixture_design.batch.summary import Summary
from fixture_design.batch.worker import LookAt, verifying
from fixture_design.errors import InputError

#: Worker processes for each processor, at most: more only wait for each other, and each needs its memory.
MOST_A_PROCESSOR = 8
#: Told of items whose records are new or were there already.
Watcher = Callable[[Sequence[tuple[Item, Entry]]], None]


@runtime_checkable
class Workers(Protocol):
    """What looks at items: processes of this machine, or a cluster."""

    def entries(self, items: Iterator[Item], stop: Callable[[], bool] = ...) -> Iterator[list[tuple[Item, Entry]]]:
        """Each item with its entry, in order, some at a time; ends early if ``stop`` says so."""
        ...

    def close(self) -> None:
        """Ends what was begun."""
        ...


def processors() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def local_workers(detail: Detail = "full", jobs: int | None = None, limit: float | None = None) -> Workers:
    """Worker processes of this machine, by default one a processor, at most `MOST_A_PROCESSOR` times as many.

    Args:
        limit: seconds for one layout; None for any.

    Raises:
        InputError: numbers that cannot be.
    """
    check_numbers(jobs, limit)
    most = MOST_A_PROCESSOR * processors()
    return Crew(LookAt(verifying, detail), min(jobs or processors(), most), limit)


def check_numbers(jobs: Any, limit: Any) -> None:
    """Raises:
    InputError: no number of processes, or no limit in seconds.
    """
    if jobs is not None and (not isinstance(jobs, int) or isinstance(jobs, bool) or jobs < 1):
        raise InputError("the number of worker processes cannot be", found=repr(jobs), expected="1 or more, or None")
    if limit is not None and not (isinstance(limit, int | float) and 0 < limit < inf):
        raise InputError("the limit of time cannot be", found=repr(limit), expected="seconds, more than 0, or None")


def detail_wanted(brief: bool, sets: bool) -> Detail:
    """How much records say.

    Raises:
        InputError: both together.
    """
    if brief and sets:
        raise InputError("brief records have no sets", expected="one of brief and sets")
    return "brief" if brief else "sets" if sets else "full"


def verify_batch(
    paths: str | Path | Iterable[str | Path],
    *,
    brief: bool = False,
    sets: bool = False,
    jobs: int | None = None,
    limit: float | None = None,
) -> Iterator[dict[str, Any]]:
    """The records of many layouts in input order, made in worker processes, as they become known.

    Args:
        paths: layout files, .jsonl of layouts, folders of both, globs.
        brief: without witnesses, margins and contacts.
        sets: with the admissible sets, as `verify` lists them: some hundred layouts a second at best.
        jobs: processes, by default one a processor.
        limit: seconds that one layout may take, by default any.

    Yields:
        `fixture_design/verdict/1` as plain values; a layout that has no verdict gives a record with the error.

    Raises:
        FileFormatError: a path that is not there, a glob without matches, a folder without layouts.
        InputError: jobs or a limit that cannot be; brief and sets together.
    """
    files = input_files([paths] if isinstance(paths, str | Path) else list(paths))
    return _records(files, local_workers(detail_wanted(brief, sets), jobs, limit))


def _records(files: Sequence[Path], workers: Workers) -> Iterator[dict[str, Any]]:
    with closing(workers):
        for some in workers.entries(items_of(files)):
            for _, entry in some:
                yield record_of(entry.line)


def run_batch(
    files: Sequence[Path],
    output: Path,
    workers: Workers,
    *,
    detail: Detail = "full",
    watch: Watcher = lambda some: None,
    ready: Callable[[], None] = lambda: None,
    retry: bool = False,
    stop: Callable[[], bool] = lambda: False,
) -> Summary:
    """Appends the records of all layouts that have none yet to a file.

    Args:
        files: as `input_files` gives them.  workers: are closed at the end.
        watch: told of every record, those that were there first.
        ready: called between those and the new ones.
        retry: look again at layouts whose records are errors; their records are replaced.
        stop: asked again and again whether to end here; what is known by then is written.

    Raises:
        FileFormatError: the output cannot be written, or holds the results of something else.
    """
    summary = Summary()

    def add(some: Sequence[tuple[Item, Entry]]) -> None:
        for item, entry in some:
            summary.add(item, entry)
        watch(some)

    with closing(workers), closing(Output(output, files)) as out:
        if retry:
            summary.retried = look_again(out, files, detail, workers, stop)
        items = items_of(files)
        for done in out.done(items, detail, mended=retry and stop()):
            add([done])
        summary.resumed = summary.count
        ready()
        for some in workers.entries(items, stop):
            out.append([entry.line for _, entry in some])
            add(some)
        summary.interrupted = stop()
    return summary
