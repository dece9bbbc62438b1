"""What is said on the way: counts, rate, share, time left; nothing of it on a pipe too often."""

import io

import pytest

from fixture_design.batch import progress as progress_module
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.progress import Progress

DONE = [(Item("x", b"", share=1.0), Entry(b"", "yes"))]


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """A clock that stands still unless it is set."""
    now = [100.0]
    monkeypatch.setattr(progress_module, "monotonic", lambda: now[0])
    return now


def test_rate_share_and_time_left(clock: list[float]) -> None:
    stream = io.StringIO()
    progress = Progress(1000.0, stream)
    for _ in range(100):
        clock[0] += 0.2
        progress.add(DONE)
    last = stream.getvalue().splitlines()[-1]
    assert last == "fixture-design: 100 layouts, 5/s, 10 %, 3 min 00 s left"
    assert len(stream.getvalue().splitlines()) == 2  # every ten seconds


def test_what_was_there_before_is_no_part_of_the_rate(clock: list[float]) -> None:
    stream = io.StringIO()
    progress = Progress(1000.0, stream)
    progress.add(DONE * 500)
    progress.resumed()
    for _ in range(50):
        clock[0] += 0.2
        progress.add(DONE)
    assert "550 layouts, 5/s, 55 %, 1 min 30 s left" in stream.getvalue()


def test_the_rate_follows_a_change(clock: list[float]) -> None:
    stream = io.StringIO()
    progress = Progress(0.0, stream)
    for step in (1.0, 0.1):
        for _ in range(600):
            clock[0] += step
            progress.add(DONE)
    assert "1200 layouts, 10/s" in stream.getvalue()


def test_a_terminal_has_one_line(clock: list[float]) -> None:
    stream = Terminal()
    progress = Progress(10.0, stream)
    for _ in range(5):
        clock[0] += 1.0
        progress.add(DONE)
    progress.close()
    assert "\n" not in stream.getvalue()
    assert stream.getvalue().endswith("\r\x1b[K")
