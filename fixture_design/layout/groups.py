"""Groups: the sets of contacts that requirements are asked of. A form-closed fixture cannot be loaded, so no
requirement is asked of "the layout" as such.

`locators` are the contacts of role locator, `all` is every contact; each stage is a group of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fixture_design.contacts import ROLES, Contact
from fixture_design.errors import UnknownNameError
from fixture_design.layout.layout import Layout, Requirement


@dataclass(frozen=True, eq=False)
class Group:
    """Contacts that are looked at together, and what acts on the part meanwhile.

    Attributes:
        contacts: in layout order, possibly none.  require: what is required of them.
        gravity: whether the layout's gravity acts.  loads: names of the loads that act, one at a time.
    """

    name: str
    contacts: tuple[Contact, ...]
    require: tuple[Requirement, ...]
    gravity: bool = True
    loads: tuple[str, ...] = ()


def groups_of(layout: Layout, contacts: Sequence[Contact]) -> tuple[Group, ...]:
    """The groups of a layout whose contacts have been found: locators, all, then the stages in file order.

    Gravity acts on both, and all loads on the second.

    A stage's ``active`` takes roles, contact names and element names (for an element that gave several contacts).

    Raises:
        UnknownNameError: ``active`` names no role and no contact.
    """
    everything = tuple(contacts)
    groups = [
        Group("locators", tuple(c for c in contacts if c.role == "locator"), layout.require.get("locators", ())),
        Group("all", everything, layout.require.get("all", ()), loads=tuple(load.name for load in layout.loads)),
    ]
    owners = {contact.name: element_name(contact.name) for contact in contacts}
    for stage in layout.stages:
        names = {*ROLES, *owners, *owners.values()}
        for active in stage.active:
            if active not in names:
                place = layout.places.get(("stages", stage.name)) or f"stage {stage.name!r}"
                raise UnknownNameError("role, element or contact", active, names, source=layout.source, place=place)
        chosen = tuple(c for c in contacts if {c.role, c.name, owners[c.name]} & set(stage.active))
        groups.append(Group(stage.name, chosen, stage.require, stage.gravity, stage.loads))
    return tuple(groups)


def element_name(contact_name: str) -> str:
    """The element a contact came from: K1#2 belongs to K1."""
    return contact_name.split("#", 1)[0]
