"""Work that takes its time, of which Ctrl-C or a termination asks for the best so far."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

from fixture_design.cli.exit_codes import ExitCode

#: What asks for the end, as far as the system knows it: Ctrl-C, the system, a terminal that is closed.
_CODES = {
    getattr(signal, name): code
    for name, code in (
        ("SIGINT", ExitCode.INTERRUPTED),
        ("SIGTERM", ExitCode.TERMINATED),
        ("SIGHUP", ExitCode.HUNG_UP),
    )
    if hasattr(signal, name)
}


class Ending:
    """Whether the program was asked to end, and by what."""

    def __init__(self) -> None:
        self._by: int | None = None

    def __call__(self) -> bool:
        return self._by is not None

    def ask(self, number: int) -> None:
        if self._by is None:
            self._by = number

    @property
    def code(self) -> ExitCode:
        """What the program ends with then; as after Ctrl-C where it was stopped without a signal."""
        return ExitCode.INTERRUPTED if self._by is None else _CODES[signal.Signals(self._by)]


@contextmanager
def interruptible(*, patient: bool = False, raising: bool = False) -> Iterator[Ending]:
    """Ctrl-C, a termination, or a closed terminal, once asks for the best so far; twice ends the program as ever.

    Args:
        patient: twice is as once, where the end itself saves something.
        raising: KeyboardInterrupt is raised besides, for work that does not ask.
    """
    ending = Ending()
    if threading.current_thread() is not threading.main_thread():
        yield ending
        return
    terminals = [stream for stream in (sys.stdout, sys.stderr) if stream.isatty()]
    # what is ignored stays so, as `nohup` wants it
    handlers = {number: signal.getsignal(number) for number in _CODES}
    before = {number: handler for number, handler in handlers.items() if handler not in (None, signal.SIG_IGN)}

    def ask(number: int, frame: object) -> None:
        ending.ask(number)
        if not patient:
            signal.signal(number, before[signal.Signals(number)])
        if _CODES[signal.Signals(number)] is ExitCode.HUNG_UP:
            _to_nowhere(terminals)
        if raising:
            raise KeyboardInterrupt

    for number in before:
        signal.signal(number, ask)
    try:
        yield ending
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _to_nowhere(streams: list[TextIO]) -> None:
    """What is still said after the terminal was closed is read by nobody, and must not end the program."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in streams:
        os.dup2(nowhere, stream.fileno())
    os.close(nowhere)
