"""One worker process: takes chunks of items, gives back their lines."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection
from time import perf_counter
from typing import TYPE_CHECKING

from fixture_design.batch.item import Entry, Item
from fixture_design.batch.records import Detail

if TYPE_CHECKING:
    from fixture_design.batch.records import Looked

#: Layouts on parts are looked at for so long [s] before they are decided together: many at once cost little each.
PILE_SECONDS = 0.1

#: Entries of some items of a chunk, by their places in it.
Known = list[tuple[int, Entry]]
#: What looks at a chunk: gives the entries of its items as they become known, each place once.
Look = Callable[[Sequence[Item]], Iterator[Known]]


@dataclass(frozen=True)
class LookAt:
    """What a worker makes with the items it gets; it keeps parts from chunk to chunk.

    Attributes:
        make: makes the `Look`, in the worker: what it holds need not travel.
        detail: its argument.
    """

    make: Callable[[Detail], Look]
    detail: Detail

    def __call__(self) -> Look:
        return self.make(self.detail)


def verifying(detail: Detail) -> Look:
    """Looks at items with `verify`: those that can be looked at together first, then one after the other."""
    from fixture_design.batch.alike import Alike  # noqa: PLC0415 - slow imports belong to the worker
    from fixture_design.batch.part_cache import PartCache  # noqa: PLC0415
    from fixture_design.batch.records import entry_of_looked, look_at  # noqa: PLC0415

    parts, alike = PartCache(), Alike(detail)

    def look(items: Sequence[Item]) -> Iterator[Known]:
        together = alike.entries(items)
        if together:
            yield together
        done = {place for place, _ in together}
        waiting: dict[int, Looked] = {}
        since = perf_counter()
        for place, item in enumerate(items):
            if place in done:
                continue
            looked = look_at(item, parts)
            if isinstance(looked, Entry):
                yield [(place, looked)]
            else:
                waiting[place] = looked
            if perf_counter() - since > PILE_SECONDS:
                yield from settled(waiting, items)
                waiting, since = {}, perf_counter()
        yield from settled(waiting, items)

    def settled(waiting: dict[int, Looked], items: Sequence[Item]) -> Iterator[Known]:
        together = alike.entries_of_found(waiting, items) if waiting else []
        if together:
            yield together
        done = {place for place, _ in together}
        for place, looked in waiting.items():
            if place not in done:
                yield [(place, entry_of_looked(looked, parts, detail))]

    return look


def work(connection: Connection, look_at: LookAt) -> None:
    """Answers chunks until the other side is gone. A chunk's answers end with an empty list.

    Ctrl-C is for the process that started this one.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    look = look_at()
    with suppress(EOFError, BrokenPipeError, ConnectionResetError):  # whoever asked is gone, and so is the work
        connection.send([])
        while True:
            for known in look(connection.recv()):
                connection.send(known)
            connection.send([])
    os._exit(0)  # not the clean-up of libraries, which may hang where their threads were stopped
