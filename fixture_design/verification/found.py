"""What a layout's contacts are, before any question is asked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fixture_design.contacts import Contact, Scale

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry, Polygon


@dataclass(frozen=True, eq=False)
class FoundContacts:
    """All contacts of a layout, the scale its margins are measured in, and what there is to say about them.

    Attributes:
        geometry: the part's, where it was loaded to find them.
    """

    contacts: tuple[Contact, ...]
    report: Scale
    notes: tuple[str, ...]
    geometry: PartGeometry | Polygon | None = None
