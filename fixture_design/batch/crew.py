"""Worker processes that look at items: results in order, whatever dies or hangs.

A chunk of items goes to an idle worker, which sends back entries as they become known. If the worker dies, what it sent
counts, and the rest is looked at again item by item; an item on which a worker dies twice, alone, has the error as its
record. A worker that says nothing for longer than one item may take is killed; what it had left is looked at again
likewise, and an item that takes too long alone has the error as its record.
"""

from __future__ import annotations

import signal
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import islice
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from time import monotonic

from fixture_design.batch.item import Entry, Item
from fixture_design.batch.records import TimeLimitError, WorkerError, given_up
from fixture_design.batch.starting import started
from fixture_design.batch.worker import Known, LookAt
from fixture_design.errors import FixtureDesignError

#: A chunk should take a worker about so long [s]: long enough that handing it over costs nothing.
CHUNK_SECONDS = 0.3
#: Items in a worker's first chunk, and in the largest.
FIRST_CHUNK, LARGEST_CHUNK = 8, 2000
#: Chunks that may be finished or under way beyond the first one that is not.
WINDOW = 8
#: Deaths of a worker on one item alone before it is given up.
DEATHS = 2
#: Processes that may end before they begin to work, one after the other, before that is an error.
_FAILED_STARTS = 3
#: Longest time between two looks at whether to stop [s].
_TICK = 0.25
#: Processes that begin at a time: each takes seconds of a processor to load what it needs.
MOST_STARTING = 2


@dataclass
class _Task:
    """Items with their numbers in the batch; ``deaths``: of workers, on it alone."""

    numbered: list[tuple[int, Item]]
    deaths: int = 0


@dataclass
class _Worker:
    """A process, and what it is doing.

    Attributes:
        task: None while it is idle; ``left``: the places in it that have no entry yet.
        heard: when it last said something, or was given something [s].
    """

    process: BaseProcess
    connection: Connection
    task: _Task | None = None
    left: dict[int, None] = field(default_factory=dict)
    started: bool = False
    heard: float = field(default_factory=monotonic)
    given: float = 0.0


class Crew:
    """Looks at items in several processes; `close` ends them."""

    def __init__(self, look_at: LookAt, jobs: int, limit: float | None = None) -> None:
        """``limit``: seconds that one layout may take; None for any."""
        self._look_at, self._jobs, self._limit = look_at, jobs, limit
        self._workers: list[_Worker] = []
        self._again: deque[_Task] = deque()
        self._drawn: deque[_Task] = deque()
        self._waiting: deque[tuple[int, Item]] = deque()  # drawn, and not given back in order
        self._exhausted = False
        self._known: dict[int, Entry] = {}
        self._chunk = FIRST_CHUNK
        self._failed_starts = 0

    def entries(
        self, items: Iterator[Item], stop: Callable[[], bool] = lambda: False
    ) -> Iterator[list[tuple[Item, Entry]]]:
        """Each item with its entry, in order, some at a time; ends early if ``stop`` says so.

        Raises:
            WorkerError: processes end before they begin to work.
        """
        numbered = enumerate(items)
        self._exhausted = False
        while not stop():
            self._give(numbered)
            if ready := self._ready():
                yield ready
            if self._exhausted and not self._waiting:
                return
            try:
                self._hear()
            except WorkerError:
                if not stop():  # what ends this process may have ended those before it
                    raise
            self._end_late()
        if ready := self._ready():  # heard in the meantime
            yield ready

    def close(self) -> None:
        """Ends all workers, at once."""
        for worker in self._workers:
            self._kill(worker)
        self._workers.clear()

    def _ready(self) -> list[tuple[Item, Entry]]:
        """Items from the first one on whose entries are known, each once."""
        ready: list[tuple[Item, Entry]] = []
        while self._waiting and self._waiting[0][0] in self._known:
            number, item = self._waiting.popleft()
            ready.append((item, self._known.pop(number)))
        return ready

    def _give(self, numbered: Iterator[tuple[int, Item]]) -> None:
        """Something to do for every idle worker; another worker where there is more to do than those can take."""
        for worker in list(self._workers):
            if worker.task is None and worker.started:
                self._draw(numbered, 1)
                if not (self._again or self._drawn):
                    return
                self._hand(worker, (self._again or self._drawn).popleft())
        beginning = sum(not worker.started for worker in self._workers)
        while len(self._workers) < self._jobs and beginning < MOST_STARTING:
            self._draw(numbered, beginning + 1)
            if len(self._again) + len(self._drawn) <= beginning:
                return
            self._workers.append(_Worker(*started(self._look_at)))
            beginning += 1

    def _draw(self, numbered: Iterator[tuple[int, Item]], wanted: int) -> None:
        """Makes chunks until there are so many to hand out, the items end, or there are enough under way."""
        while len(self._again) + len(self._drawn) < wanted and not self._exhausted:
            if len(self._waiting) >= WINDOW * max(len(self._workers), 1) * self._chunk:
                return
            chunk = list(islice(numbered, self._chunk))
            self._exhausted = not chunk
            self._waiting.extend(chunk)
            if chunk:
                self._drawn.append(_Task(chunk))

    def _hand(self, worker: _Worker, task: _Task) -> None:
        worker.task, worker.left = task, dict.fromkeys(range(len(task.numbered)))
        worker.given = worker.heard = monotonic()
        try:
            worker.connection.send([item for _, item in task.numbered])
        except (BrokenPipeError, ConnectionResetError):
            self._bury(worker)

    def _hear(self) -> None:
        """What workers say; of those that say nothing any more, the end."""
        by_connection = {worker.connection: worker for worker in self._workers}
        for connection in wait(list(by_connection), timeout=_TICK):
            worker = by_connection[connection]  # type: ignore[index]
            try:
                while worker.connection.poll():
                    self._take(worker, worker.connection.recv())
            except (EOFError, OSError):
                self._bury(worker)

    def _take(self, worker: _Worker, known: Known) -> None:
        worker.heard, worker.started, self._failed_starts = monotonic(), True, 0
        for place, entry in known:
            if worker.task is not None and place in worker.left:
                del worker.left[place]
                self._known[worker.task.numbered[place][0]] = entry
        if not known and worker.task is not None:
            self._fit_chunk(len(worker.task.numbered), worker.heard - worker.given)
            worker.task = None

    def _fit_chunk(self, count: int, seconds: float) -> None:
        """The next chunks' size, from what the last one took; never more than eight times as many at once."""
        fitting = int(count * CHUNK_SECONDS / max(seconds, CHUNK_SECONDS / LARGEST_CHUNK))
        self._chunk = max(1, min(fitting, 8 * self._chunk, LARGEST_CHUNK))

    def _bury(self, worker: _Worker) -> None:
        """A worker has died: what it had left is looked at again, one by one."""
        if worker not in self._workers:
            return
        worker.process.join(_TICK)
        how = _end_of(worker.process.exitcode)
        self._kill(worker)
        self._workers.remove(worker)
        task, left = worker.task, worker.left
        if task is None:
            self._failed_starts += not worker.started
            if self._failed_starts >= _FAILED_STARTS:
                raise WorkerError(f"worker processes end before they begin to work ({how})")
        elif len(task.numbered) == 1 and left:
            number, item = task.numbered[0]
            task.deaths += 1
            if task.deaths >= DEATHS:
                times = "twice" if DEATHS == 2 else f"{DEATHS} times"
                self._fail(number, item, WorkerError(f"the process that looked at it died {times} ({how})"))
            else:
                self._again.append(_Task(task.numbered, task.deaths))
        else:
            self._again.extend(_Task([task.numbered[place]]) for place in left)

    def _end_late(self) -> None:
        """Kills workers that have said nothing for longer than one layout may take."""
        if self._limit is None:
            return
        for worker in list(self._workers):
            task = worker.task
            if task is None or not worker.left or monotonic() - worker.heard <= self._limit:
                continue
            if len(task.numbered) == 1:
                number, item = task.numbered[0]
                self._fail(number, item, TimeLimitError(f"it took longer than the {self._limit:g} s it was given"))
            else:  # which of them it is nobody knows: some are decided together
                self._again.extend(_Task([task.numbered[place]]) for place in worker.left)
            self._kill(worker)
            self._workers.remove(worker)

    def _fail(self, number: int, item: Item, error: FixtureDesignError) -> None:
        self._known[number] = given_up(item, error)

    @staticmethod
    def _kill(worker: _Worker) -> None:
        worker.process.kill()
        worker.process.join()
        worker.connection.close()


def _end_of(code: int | None) -> str:
    """How a process ended, in words."""
    if code is None or code >= 0:
        return f"exit code {code}"
    try:
        return f"signal {signal.Signals(-code).name}"
    except ValueError:
        return f"signal {-code}"
