"""Something that takes seconds, done in a thread of its own while the session goes on answering."""

from __future__ import annotations

import threading
from collections.abc import Callable

#: What is done: with a place to tell of progress, (words, part that is done), and whether it has been given up.
Work = Callable[[Callable[[str, float], None], Callable[[], bool]], object]


class Errand:
    """One such thing; it is begun where it is made.

    Attributes:
        about: what it does, in words.
        cancelled: somebody gave it up; what it finds does not count.
    """

    def __init__(self, about: str, work: Work, progress: Callable[[str, float], None]) -> None:
        self.about, self.cancelled = about, False
        self._found: object = None
        self._thread = threading.Thread(target=self._run, args=(work, progress), daemon=True)
        self._thread.start()

    @property
    def done(self) -> bool:
        return not self._thread.is_alive()

    @property
    def found(self) -> object:
        """What was found, or the exception that ended it."""
        return self._found

    def cancel(self) -> None:
        self.cancelled = True

    def wait(self) -> None:
        """Until it is done."""
        self._thread.join()

    def _run(self, work: Work, progress: Callable[[str, float], None]) -> None:
        try:
            self._found = work(progress, lambda: self.cancelled)
        except Exception as error:  # noqa: BLE001 - told or raised again by who asks, in the thread that asks
            self._found = error
