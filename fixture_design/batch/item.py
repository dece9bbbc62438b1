"""One layout of a batch before it is read: where it came from, and its text."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple


class Item(NamedTuple):
    """A layout that waits for its verdict. A tuple, since thousands a second go to other processes.

    Attributes:
        source: what its record names: a file, or a line of a .jsonl as "lib.jsonl:12".
        text: the bytes of that file or line; None if the file could not be read, and reading it again says why.
        line: number of the line, counted from 1; None for a file of one layout.
        variant: which variant of the layout's sweep, counted from 0; None for the layout itself.
        sampled: whether variants are samples drawn at random, rather than a grid.
        share: its part of all the work there is, in bytes of the input files.
    """

    source: str
    text: bytes | None
    line: int | None = None
    variant: int | None = None
    sampled: bool = False
    share: float = 0.0

    @property
    def default_name(self) -> str:
        """What it is called where its text does not say: the file's stem, with the line's number."""
        if self.line is None:
            return Path(self.source).stem
        return f"{Path(self.source.rpartition(':')[0]).stem}:{self.line}"

    def named(self, name: str) -> str:
        """The record's name for a layout of this name: variants are numbered."""
        return name if self.variant is None else f"{name}[{self.variant}]"


class Entry(NamedTuple):
    """What became of an item.

    Attributes:
        line: its record as it stands in the output, with the line's end.
        outcome: one of `summary.OUTCOMES`.
        margin: the smallest one of the findings that are required; None where none is known.
    """

    line: bytes
    outcome: str
    margin: float | None = None
