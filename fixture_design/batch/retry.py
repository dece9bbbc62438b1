"""Errors looked at again: a worker that died, a time limit, a file that has been mended since.

The new records take the places of the old ones in a new file, which then takes the place of the old file: whenever
that is cut short, each layout still has exactly one record.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from fixture_design.batch.items import items_of
from fixture_design.batch.outcome import FAILURES
from fixture_design.batch.output import Output
from fixture_design.batch.records import Detail

if TYPE_CHECKING:
    from fixture_design.batch.job import Workers


def look_again(
    out: Output, files: Sequence[Path], detail: Detail, workers: Workers, stop: Callable[[], bool] = lambda: False
) -> int:
    """Looks once more at the layouts whose records are errors, and replaces what became of them.

    Memory grows with the number of errors.

    Returns:
        How many were looked at; fewer than there are errors if ``stop`` said so.

    Raises:
        FileFormatError: as `Output.done`, but for errors whose layout has changed; the file cannot be written.
    """
    records = enumerate(out.done(items_of(files), detail, mended=True))
    failed = [(place, item) for place, (item, entry) in records if entry.outcome in FAILURES]
    places = iter([place for place, _ in failed])
    lines: dict[int, bytes] = {}
    for some in workers.entries(iter([item for _, item in failed]), stop) if failed else ():
        lines |= {next(places): entry.line for _, entry in some}
    if lines:
        out.replace(lines)
    return len(lines)
