"""Progress on stderr."""

from __future__ import annotations

import sys
import time

from fixture_design.cli.messages import say

#: A file is told no more often than this [s].
_QUIET = 20.0


class _Progress:
    """On a terminal one line that the next one replaces; in a file a line every now and then."""

    def __init__(self) -> None:
        self._told: float | None = None
        self._terminal: bool | None = None

    def __call__(self, words: str, part: float | None = None) -> None:
        """Tell how far the work is, in words, and which part of it is done; no words take the line away."""
        if self._terminal is None:  # once: a terminal that is closed is none any more, and no file either
            self._terminal = sys.stderr.isatty()
        line = words if part is None or not words else f"{words} ({part:.0%})"
        if self._terminal:
            sys.stderr.write(f"\r\033[K{line}")
            sys.stderr.flush()
        elif not line or self._told is None:  # the work begins, or ends
            self._told = time.monotonic() if line else None
        elif time.monotonic() - self._told > _QUIET:
            self._told = time.monotonic()
            say(line)


#: The program's.
shown = _Progress()
