"""Previews of the worst layouts: they are looked at once more, and drawn, with the evidence in words."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fixture_design.batch.item import Item
from fixture_design.batch.items import items_of
from fixture_design.batch.part_cache import PartCache
from fixture_design.batch.reading import layout_of, nominal_of
from fixture_design.batch.sweep import Deviations, deviations_of
from fixture_design.errors import InputError
from fixture_design.layout import Layout, Verdict
from fixture_design.verification import contacts_of, verify
from fixture_design.verification.found import FoundContacts
from fixture_design.viewing.card import card
from fixture_design.viewing.markup import Markup, joined, tag

#: Letters of a name that a page shows.
MOST_LETTERS = 200
#: Draws one layout with its contacts and verdict.
Draw = Callable[[Layout, FoundContacts, Verdict], Markup]


def previews(numbers: Sequence[int], files: Sequence[Path], draw: Draw = card) -> Markup | None:
    """Some layouts of a batch, drawn; None where there are none.

    Args:
        numbers: their places in the batch, as `Worst` has them.  files: of the batch, as `input_files` gives them.
        draw: what a layout looks like; by default the part from three sides, its contacts, and the requirements.
    """
    items = dict(_numbered(items_of(files), set(numbers)))
    parts = PartCache()
    drawn = [_drawn(items[number], number, parts, draw) for number in numbers if number in items]
    return joined(drawn) if drawn else None


def _numbered(items: Iterator[Item], wanted: set[int]) -> Iterator[tuple[int, Item]]:
    for number, item in enumerate(items if wanted else ()):
        if number in wanted:
            yield number, item
        if number >= max(wanted):
            return


def _drawn(item: Item, number: int, parts: PartCache, draw: Draw) -> Markup:
    try:
        layout = layout_of(item)
        found = contacts_of(layout, parts.geometry_of(layout))
        name, content = layout.name, draw(layout, found, verify(layout, found=found, sets=False))
    except InputError as error:  # a file is another one since the batch looked at it
        name, content = item.named(item.default_name), tag("p", str(error))
    heading = tag("h3", short(name), " ", tag("small", f"#{number + 1}, {short(item.source)}"))
    return tag("article", heading, _off(item) or "", content)


def short(text: str, times: int = 1) -> str:
    """A text as people want to read it: nobody is kept from calling a layout by a whole file."""
    most = times * MOST_LETTERS
    return text if len(text) <= most else f"{text[: most // 2]} ... {text[-most // 2 :]}"


def _off(item: Item) -> Markup | None:
    """How far a variant is off, in words."""
    if item.variant is None:
        return None
    off = deviations_in_words(deviations_of(nominal_of(item), item.variant))
    return tag("p", f"Off what the layout says: {off or 'nothing'}.")


def deviations_in_words(off: Deviations) -> str:
    """ "the part by (0.1, 0, 0) mm; the part turned by (0, 0, 0.5) degrees; L1 by (0, 0.02, 0) mm; friction 0.21"."""
    plane = 2 if len(off.pose) == 3 else 3
    said = []
    if off.pose[:plane].any():
        said.append(f"the part by {_millimetres(off.pose[:plane])}")
    if off.pose[plane:].any():
        turn = ", ".join(f"{angle:.3g}" for angle in np.rad2deg(off.pose[plane:]).tolist())
        said.append(f"the part turned by ({turn}) degrees")
    said += [f"{name} by {_millimetres(way)}" for name, way in off.at.items() if way.any()]
    return "; ".join([*said, *([] if off.friction is None else [f"friction {off.friction:.3g}"])])


def _millimetres(way: Any) -> str:
    return f"({', '.join(f'{1e3 * length:.3g}' for length in way)}) mm"
