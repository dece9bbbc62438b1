"""The way in: what must be in order before anything slow is imported."""

from __future__ import annotations

import os
import signal
import sys
import threading

#: As shells have it: 128 and the number of SIGINT. Not from `exit_codes`, whose import takes time.
_INTERRUPTED = 130


def main() -> None:
    """Run the command line. Ctrl-C ends it at any moment, and characters the terminal lacks are escaped.

    An exception would not do for Ctrl-C: compiled modules that are just being imported turn it into an ImportError, or
    swallow it. Nothing here has to be cleaned up: files are replaced at once.
    """
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, _interrupted)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    from fixture_design.cli.program import run

    run()


def _interrupted(number: int, frame: object) -> None:
    os.write(2, b"fixture-design: interrupted\n")
    os._exit(_INTERRUPTED)
