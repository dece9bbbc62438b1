"""One worker process: takes chunks of items, gives back their lines."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection

from fixture_design.batch.item import Entry, Item
from fixture_design.batch.records import Detail

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
    from fixture_design.batch.records import entry_of  # noqa: PLC0415

    parts, alike = PartCache(), Alike(detail)

    def look(items: Sequence[Item]) -> Iterator[Known]:
        together = alike.entries(items)
        if together:
            yield together
        done = {place for place, _ in together}
        for place, item in enumerate(items):
            if place not in done:
                yield [(place, entry_of(item, parts, detail, alike.entry_of_found))]

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
