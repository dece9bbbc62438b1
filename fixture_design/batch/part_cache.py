"""Geometry of parts, kept from layout to layout: a library names one part in thousands of layouts."""

from __future__ import annotations

from collections import OrderedDict
from typing import TYPE_CHECKING

from fixture_design.batch.digest import file_hash
from fixture_design.errors import looking_at
from fixture_design.layout import Layout

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry

#: Parts kept at a time.
MOST_PARTS = 16


class PartCache:
    """Loads each part once, by the hash of its files and what scales or names its surface."""

    def __init__(self, most: int = MOST_PARTS) -> None:
        self._most = most
        self._loaded: OrderedDict[tuple[object, ...], PartGeometry] = OrderedDict()

    def geometry_of(self, layout: Layout) -> PartGeometry | None:
        """The geometry of a layout's part; None where `verify` reads it, or needs none.

        Raises:
            InputError: the part cannot be used.
        """
        part = layout.part
        if part is None or part.file is None or not (layout.elements or layout.bodies) or layout.space == "planar":
            return None
        key = (part.kind, part.name, file_hash(part.file), part.scale, part.faceted)
        if key not in self._loaded:
            from fixture_design.geometry import load_part  # noqa: PLC0415 - only where there is geometry

            with looking_at(layout.source, layout.places.get(("part",))):
                self._loaded[key] = load_part(part)
            if len(self._loaded) > self._most:
                self._loaded.popitem(last=False)
        self._loaded.move_to_end(key)
        return self._loaded[key]
