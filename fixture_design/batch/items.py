"""The layouts of a batch one after the other, read when they are needed: memory does not grow with their number."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from fixture_design.batch.inputs import is_lines
from fixture_design.batch.item import Item
from fixture_design.batch.reading import layout_of
from fixture_design.batch.sweep import is_sampled, variant_count
from fixture_design.errors import FileFormatError, InputError
from fixture_design.io import read_bytes

#: Texts without this word have no sweep, and need not be read to know it; unless it is written with escapes.
_SWEEP, _ESCAPE = b"sweep", b"\\"


def items_of(files: Sequence[Path]) -> Iterator[Item]:
    """The layouts of some files in order, those with a sweep as all their variants."""
    for file in files:
        for item in _lines(file) if is_lines(file) else [_whole(file)]:
            yield from _variants(item)


def total_share(files: Sequence[Path]) -> float:
    """The sum of all items' shares [bytes]."""
    return float(sum(file.stat().st_size for file in files if file.is_file()))


def _whole(file: Path) -> Item:
    try:
        text = read_bytes(file)
    except FileFormatError:  # its record will say so: whoever looks at the item reads the file again
        return Item(str(file), None)
    return Item(str(file), text, share=float(len(text)))


def _lines(file: Path) -> Iterator[Item]:
    """One item a line; empty lines are none, and a file that cannot be read is one."""
    if not file.is_file():
        yield Item(str(file), None)
        return
    try:
        opened = file.open("rb")
    except OSError:
        yield Item(str(file), None)
        return
    empty = True
    with opened:
        for number, line in enumerate(opened, start=1):
            text = line.strip()
            if text:
                empty = False
                yield Item(f"{file}:{number}", text, number, share=float(len(line)))
    if empty:  # whoever reads it as a layout will say so
        yield Item(str(file), b"")


def _variants(item: Item) -> Iterator[Item]:
    if item.text is None or not (_SWEEP in item.text or _ESCAPE in item.text):
        yield item
        return
    try:
        layout = layout_of(item)
        count = None if layout.sweep is None else variant_count(layout)
    except InputError:  # its record will say so
        count, layout = None, None
    if count is None or layout is None:
        yield item
        return
    one = item._replace(sampled=is_sampled(layout), share=item.share / count)
    for variant in range(count):
        yield one._replace(variant=variant)
