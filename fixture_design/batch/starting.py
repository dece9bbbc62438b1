"""How a worker process begins: it hears no Ctrl-C, does not import the script that runs, and uses one thread."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import get_context, resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from types import ModuleType

from fixture_design.batch.worker import LookAt, work

#: Libraries that would otherwise start a thread a processor in each worker.
_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


def started(look_at: LookAt) -> tuple[BaseProcess, Connection]:
    """A process that takes chunks of items, and our end of the pipe to it."""
    context = get_context("spawn")
    # when it starts the tracker lets interrupts through again, also to the process that is started next
    resource_tracker.ensure_running()
    ours, theirs = context.Pipe()
    process = context.Process(target=work, args=(theirs, look_at), daemon=True)
    with _one_thread(), _without_interrupts(), _without_main():
        process.start()
    theirs.close()  # so that the end of the process is the end of the pipe
    return process, ours


@contextmanager
def _one_thread() -> Iterator[None]:
    """Processes started in here use one thread each, unless the user decided otherwise."""
    added = [name for name in _ONE_THREAD if name not in os.environ]
    os.environ.update(dict.fromkeys(added, "1"))
    try:
        yield
    finally:
        for name in added:
            del os.environ[name]


@contextmanager
def _without_main() -> Iterator[None]:
    """Processes started in here do not import the script that runs: workers have no use for it, and it may be one that
    cannot be imported (from a pipe), or that would start all over (without `if __name__ == "__main__"`).
    """
    script = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = script


@contextmanager
def _without_interrupts() -> Iterator[None]:
    """Processes started in here never hear of Ctrl-C, not even while they begin; this one hears of it afterwards."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
