"""A layout on a card: where its contacts are on the part, and what became of its requirements."""

from __future__ import annotations

import numpy as np

from fixture_design.layout import Layout, Verdict
from fixture_design.verification.found import FoundContacts
from fixture_design.viewing.markup import Markup, joined
from fixture_design.viewing.part_drawing import edges_of
from fixture_design.viewing.sheet import requirements
from fixture_design.viewing.three_views import three_views

#: What a card needs of the page's style.
CARD_STYLE = """
.views { display: flex; flex-wrap: wrap; } .views figcaption { text-align: center; }
.answer { font-weight: 600; }
"""


def card(layout: Layout, found: FoundContacts, verdict: Verdict) -> Markup:
    """Drawing and words; the part's geometry is that with which the contacts were found."""
    edges = edges_of(layout, found.geometry)
    plane = 2 if layout.space == "planar" else 3
    drawing = three_views(np.zeros((0, 2, plane)) if edges is None else edges, found.contacts) if found.contacts else ""
    return joined([drawing, requirements(verdict)])
