"""Answers that are certain by counting, whatever the normals are: for contacts whose normals may be off.

Contacts on one plane facet have one normal n between them, known or not, so their rows [n; x X n] lie in a space of
1 + the dimension of {(x - x0) X n}: at most 1 if the points coincide, 2 if they are on a line, 3 otherwise (2 in the
plane). Every clause of another contact has one row a branch. With these counts, of all contacts together:

* fewer than d rows     the rank is short: not deterministic;
* d rows or fewer       not closed. Closed rows have rank d and balance with weights that are all positive. Of rank d
                        their spans are independent, so that each facet or contact balances by itself; but on a facet
                        sum w_i n is not o, and the rows of other contacts are as independent as they are many.
* p normals or fewer    not closed either (p = 3 in space, 2 in the plane; one normal a facet, one a clause elsewhere):
                        the force parts would have to span R^p and balance, and p vectors that span R^p do not.

With friction neither count says anything of force closure.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.contacts import Contact, unit_normal
from fixture_design.layout import Counted, Rule
from fixture_design.tolerances import DEFAULT


def too_few_to_locate(contacts: Sequence[Contact]) -> Rule | None:
    """The rule that makes `deterministic` certainly no, if there is one: fewer than d rows."""
    return _few_rows(contacts, contacts[0].dimension - 1)


def too_few_to_close(contacts: Sequence[Contact]) -> Rule | None:
    """The rule that makes form closure certainly no, if there is one: d rows, or p normals, or fewer."""
    return _few_rows(contacts, contacts[0].dimension) or _few_normals(contacts)


def _few_rows(contacts: Sequence[Contact], most: int) -> Rule | None:
    counted = tuple(
        Counted(_names(block), _facet_rank(block) if _on_facet(block[0]) else len(block[0].clauses))
        for block in facet_blocks(contacts)
    )
    return Rule("few rows", counted) if sum(block.count for block in counted) <= most else None


def _few_normals(contacts: Sequence[Contact]) -> Rule | None:
    counted = tuple(Counted(_names(block), len(block[0].clauses)) for block in facet_blocks(contacts))
    few = sum(block.count for block in counted) <= len(contacts[0].point)
    return Rule("few normals", counted) if few else None


def facet_blocks(contacts: Sequence[Contact]) -> list[list[Contact]]:
    """Contacts in groups that share one plane facet; all others by themselves."""
    blocks: list[list[Contact]] = []
    for contact in contacts:
        shared = next((block for block in blocks if _share_facet(block[0], contact)), None)
        if shared is None:
            blocks.append([contact])
        else:
            shared.append(contact)
    return blocks


def _on_facet(contact: Contact) -> bool:
    return contact.feature is not None and contact.provenance.kind == "exact" and len(contact.normals) == 1


def _share_facet(first: Contact, second: Contact) -> bool:
    if not (_on_facet(first) and _on_facet(second) and first.feature == second.feature):
        return False
    return bool(np.linalg.norm(unit_normal(first.normals[0]) - unit_normal(second.normals[0])) <= DEFAULT.zero)


def _facet_rank(block: Sequence[Contact]) -> int:
    """1 + the dimension of the points' affine hull, which is in a plane."""
    points = np.array([contact.point for contact in block])
    sizes = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    limit = DEFAULT.zero * float(sizes[0]) + 4 * np.finfo(float).eps * float(np.linalg.norm(points))
    return 1 + min(int(np.sum(sizes > limit)), points.shape[1] - 1)


def _names(block: Sequence[Contact]) -> tuple[str, ...]:
    return tuple(contact.name for contact in block)
