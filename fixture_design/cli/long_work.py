"""Work that takes its time: progress on stderr, and Ctrl-C or a termination that asks for the best so far."""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from fixture_design.cli.exit_codes import ExitCode
from fixture_design.cli.messages import say

#: A file is told no more often than this [s].
_QUIET = 20.0


class Ending:
    """Whether the program was asked to end, and by what."""

    def __init__(self) -> None:
        self._by: int | None = None

    def __call__(self) -> bool:
        return self._by is not None

    def ask(self, number: int) -> None:
        self._by = number

    @property
    def code(self) -> ExitCode:
        """What the program ends with then."""
        return _CODES[signal.Signals(self._by)] if self._by is not None else ExitCode.HOLDS


_CODES = {
    signal.SIGINT: ExitCode.INTERRUPTED,
    signal.SIGTERM: ExitCode.TERMINATED,
    signal.SIGHUP: ExitCode.HUNG_UP,
}


@contextmanager
def interruptible() -> Iterator[Ending]:
    """Ctrl-C, a termination, or a closed terminal, once asks for the best so far; twice ends the program as ever."""
    ending = Ending()
    if threading.current_thread() is not threading.main_thread():
        yield ending
        return
    before = {number: signal.getsignal(number) for number in _CODES}

    def ask(number: int, frame: object) -> None:
        ending.ask(number)
        signal.signal(number, before[signal.Signals(number)])

    for number in before:
        signal.signal(number, ask)
    try:
        yield ending
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


class _Progress:
    """Progress on stderr: on a terminal one line that the next one replaces, in a file a line every 20 seconds."""

    def __init__(self) -> None:
        self._told = time.monotonic()

    def __call__(self, words: str, part: float | None = None) -> None:
        """Tell how far the work is, in words, and which part of it is done; no words take the line away."""
        line = words if part is None or not words else f"{words} ({part:.0%})"
        if sys.stderr.isatty():
            sys.stderr.write(f"\r\033[K{line}")
            sys.stderr.flush()
        elif line and time.monotonic() - self._told > _QUIET:
            self._told = time.monotonic()
            say(line)


#: The program's.
shown = _Progress()
