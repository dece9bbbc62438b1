"""What a layout's contacts are, before any question is asked."""

from __future__ import annotations

from dataclasses import dataclass

from fixture_design.contacts import Contact, Scale


@dataclass(frozen=True, eq=False)
class FoundContacts:
    """All contacts of a layout, the scale its margins are measured in, and what there is to say about them."""

    contacts: tuple[Contact, ...]
    report: Scale
    notes: tuple[str, ...]
