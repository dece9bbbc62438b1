"""The same work on a Dask cluster: chunks of items go to its workers, results come back in order.

Workers need this package, the same version, and the files that layouts name under the same paths. Whoever lost a
worker is looked at again by Dask; an item on which workers die alone has the error as its record, as on one machine.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from itertools import islice
from threading import Lock
from time import perf_counter
from typing import Any

from fixture_design.batch.crew import CHUNK_SECONDS, FIRST_CHUNK, LARGEST_CHUNK
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.records import Detail, WorkerError, given_up
from fixture_design.batch.worker import Look, verifying
from fixture_design.errors import InputError
from fixture_design.version import VERSION

#: Chunks under way for each thread of the cluster.
_AHEAD = 3
#: Seconds for the scheduler to answer, and between two looks at whether to stop.
_ANSWER, _TICK = 20.0, 0.25
#: A protocol with a host, or a host with a port; and one to show.
_ADDRESS, _LIKE = re.compile(r"[a-z]+://[^/\s]+|[^/\s:]+:\d+$"), "an address such as tcp://10.0.0.1:8786"

#: A worker with several threads looks at one chunk at a time: what it remembers is not made for more.
_ONE_AT_A_TIME = Lock()


class Cluster:
    """Looks at items on the cluster whose scheduler is at an address."""

    def __init__(self, address: str, detail: Detail, look: Callable[[Detail], Look] = verifying) -> None:
        """Connects.

        Raises:
            InputError: dask.distributed is not installed, nobody answers, there are no workers, or they have another
                version of this package.
        """
        try:
            from distributed import Client  # noqa: PLC0415  # pyright: ignore[reportMissingImports]
        except ImportError as cause:
            raise InputError(
                "a cluster needs dask.distributed", expected="pip install 'fixture-design[cluster]'"
            ) from cause
        if not _ADDRESS.match(address):  # Dask would look for a host of that name, for long
            raise InputError(f"no Dask scheduler answers at {address!r}", expected=_LIKE)
        try:
            self._client: Any = Client(address, timeout=_ANSWER, set_as_default=False)
        except (OSError, ValueError, TypeError) as cause:
            raise InputError(f"no Dask scheduler answers at {address!r}", expected=_LIKE) from cause
        self._detail, self._look = detail, look
        try:
            self._threads = self._checked(address)
        except BaseException:
            self.close()
            raise

    def entries(
        self, items: Iterator[Item], stop: Callable[[], bool] = lambda: False
    ) -> Iterator[list[tuple[Item, Entry]]]:
        """Each item with its entry, in order, a chunk at a time; ends early if ``stop`` says so.

        Raises:
            WorkerError: the cluster is gone.
        """
        under_way: deque[tuple[list[Item], Any]] = deque()
        size = FIRST_CHUNK
        while not stop():
            while len(under_way) < _AHEAD * self._threads and (chunk := list(islice(items, size))):
                under_way.append((chunk, self._submit(chunk)))
            if not under_way:
                return
            chunk, future = under_way[0]
            outcome = self._outcome(future, stop)
            if outcome is None:
                return
            under_way.popleft()
            if isinstance(outcome, BaseException):
                yield from self._one_by_one(chunk, outcome, stop)
                continue
            entries, seconds = outcome
            fitting = int(len(chunk) * CHUNK_SECONDS / max(seconds, CHUNK_SECONDS / LARGEST_CHUNK))
            size = max(1, min(fitting, 8 * size, LARGEST_CHUNK))
            yield list(zip(chunk, entries, strict=True))

    def close(self) -> None:
        """Leaves the cluster, which gives up what is under way."""
        self._client.close()

    def _submit(self, chunk: list[Item]) -> Any:
        return self._client.submit(look_at, self._look, self._detail, chunk, pure=False)

    def _outcome(self, future: Any, stop: Callable[[], bool]) -> tuple[list[Entry], float] | BaseException | None:
        """What a chunk came to: its entries, or why there are none; None if it is not waited for any longer."""
        from distributed import TimeoutError as NotYet  # noqa: PLC0415  # pyright: ignore[reportMissingImports]

        while not stop():
            try:
                return future.result(timeout=_TICK)
            except Exception as error:
                if future.status == "error":  # workers died on it, or looking at it went wrong
                    return error
                if not isinstance(error, NotYet) or self._client.status != "running":
                    raise WorkerError("the cluster is gone; what it had found is saved") from error
        return None

    def _one_by_one(
        self, chunk: list[Item], why: BaseException, stop: Callable[[], bool]
    ) -> Iterator[list[tuple[Item, Entry]]]:
        """The items of a chunk on which workers die or looking goes wrong, each alone.

        One after the other: Dask blames whatever waits on a worker for its death.
        """
        if len(chunk) == 1:
            yield [(chunk[0], given_up(chunk[0], _in_words(why)))]
            return
        for item in chunk:
            outcome = self._outcome(self._submit([item]), stop)
            if outcome is None:
                return
            if isinstance(outcome, BaseException):
                yield from self._one_by_one([item], outcome, stop)
            else:
                yield [(item, outcome[0][0])]

    def _checked(self, address: str) -> int:
        """How many threads there are, after all workers have said that they have the same version."""
        try:
            threads = sum(self._client.nthreads().values())
        except OSError as cause:  # also that time is over
            raise InputError(f"no Dask scheduler answers at {address!r}", expected=_LIKE) from cause
        if not threads:
            raise InputError(f"the cluster at {address!r} has no workers", expected="at least one `dask worker`")
        try:
            versions = set(self._client.run(_version).values())
        except ImportError as cause:
            raise InputError(f"workers of the cluster at {address!r} do not have this package: {cause}") from cause
        if versions != {VERSION}:
            other = ", ".join(sorted(versions - {VERSION}))
            raise InputError(f"workers of the cluster at {address!r} have version {other}; this is {VERSION}")
        return threads


def _in_words(why: BaseException) -> WorkerError:
    """What a single item's task came to; `KilledWorker` by its name, since the package may not be there."""
    if type(why).__name__ == "KilledWorker":
        return WorkerError("the processes that looked at it died, on one worker of the cluster after the other")
    return WorkerError(f"looking at it went wrong on the cluster: {type(why).__name__}: {why}")


def look_at(look: Callable[[Detail], Look], detail: Detail, chunk: Sequence[Item]) -> tuple[list[Entry], float]:
    """The entries of a chunk and how long they took, on a worker of the cluster."""
    with _ONE_AT_A_TIME:
        start = perf_counter()
        entries = dict(pair for known in _kept(look, detail)(chunk) for pair in known)
        return [entries[place] for place in range(len(chunk))], perf_counter() - start


@cache
def _kept(look: Callable[[Detail], Look], detail: Detail) -> Look:
    """What looks at items, with the parts that it has loaded."""
    return look(detail)


def _version() -> str:
    return VERSION
