"""How far a batch is, how fast it goes, and how long it will take: on stderr, so that results stay alone on stdout."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from time import monotonic
from typing import Any

from fixture_design.batch.item import Entry, Item

#: Time between two messages [s]: on a terminal, where they replace each other, and elsewhere.
_ON_TERMINAL, _ELSEWHERE = 0.5, 10.0
#: Layouts from which the time that is left can be told: the first ones wait for processes and parts.
_ENOUGH = 20
#: The rate is that of about so long a time [s].
_MEMORY = 10.0


class Progress:
    """Told of what is done, says so now and then. What was done before the start has no part in the rate."""

    def __init__(self, total_share: float, stream: Any = None) -> None:
        """Starts the clock.

        Args:
            total_share: sum of the items' shares, which tells what part is done without counting all items.
            stream: a text file, by default stderr.
        """
        self._total, self._stream = total_share, stream or sys.stderr
        self._terminal = self._stream.isatty()
        self._count, self._share, self._told = 0, 0.0, 0
        self._before = self._said = self._marked = monotonic()
        self._at_mark = (0, 0.0)

    def add(self, some: Sequence[tuple[Item, Entry]]) -> None:
        """Some more items are done."""
        self._count += len(some)
        self._share += sum(item.share for item, _ in some)
        now = monotonic()
        if now - self._said >= (_ON_TERMINAL if self._terminal else _ELSEWHERE):
            self._said = now
            self._say(now)

    def resumed(self) -> None:
        """All that was told so far was done before: the rate counts from here."""
        self._at_mark, self._marked = (self._count, self._share), monotonic()

    def close(self) -> None:
        """Clears the line on a terminal; elsewhere the last count is the true one, where any was told."""
        if self._terminal:
            self._stream.write("\r\x1b[K")
            self._stream.flush()
        elif self._told not in (0, self._count):
            self._say(monotonic())

    def _say(self, now: float) -> None:
        count, share = self._at_mark
        passed = max(now - self._marked, 1e-9)
        rate, pace = (self._count - count) / passed, (self._share - share) / passed
        if passed > _MEMORY:
            weight = _MEMORY / 2 / passed  # keep the newer part of what the rate is taken from
            self._at_mark = (round(self._count - rate * passed * weight), self._share - pace * passed * weight)
            self._marked = now - passed * weight
        self._told = self._count
        text = f"{self._count} layout{'' if self._count == 1 else 's'}, {rate:.3g}/s"
        if self._total > 0:
            text += f", {100 * min(self._share / self._total, 1.0):.0f} %"
            if pace > 0 and self._count - count >= _ENOUGH:
                text += f", {_duration(max(self._total - self._share, 0.0) / pace)} left"
        self._stream.write(f"\r\x1b[K{text}" if self._terminal else f"fixture-design: {text}\n")
        self._stream.flush()


def _duration(seconds: float) -> str:
    """ "2 h 05 min", "3 min 20 s", "12 s"."""
    whole = round(seconds)
    hours, minutes, rest = whole // 3600, whole // 60 % 60, whole % 60
    if hours:
        return f"{hours} h {minutes:02d} min"
    return f"{minutes} min {rest:02d} s" if minutes else f"{rest} s"
