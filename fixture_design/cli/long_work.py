"""Work that takes its time: progress on stderr, and Ctrl-C or a termination that asks for the best so far."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def interruptible() -> Iterator[Callable[[], bool]]:
    """Ctrl-C, or a termination, once asks for the best so far; twice ends the program as ever."""
    asked = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield asked.is_set
        return
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}

    def ask(number: int, frame: object) -> None:
        asked.set()
        signal.signal(number, before[signal.Signals(number)])

    for number in before:
        signal.signal(number, ask)
    try:
        yield asked.is_set
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def shown(words: str, part: float) -> None:
    """Progress on stderr, in one line that the next one replaces; nothing where stderr is a file."""
    if sys.stderr.isatty():
        sys.stderr.write(f"\r\033[K{words}" + (f" ({part:.0%})" if words else ""))
        sys.stderr.flush()
